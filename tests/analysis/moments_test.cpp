#include "analysis/moments.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/analysis/nist_univariate.h"

namespace halfslope {
namespace {

Moments moments_of(std::span<const double> values) {
  Moments moments;
  moments.add(values);
  return moments;
}

/// −log10 of the relative error: the correct digits.
double correct_digits(double found, double exact) {
  return found == exact ? 17.0 : -std::log10(std::abs(found - exact) / std::abs(exact));
}

/// NumAcc2 to NumAcc4 are c + 0.2, then c + 0.1 and c + 0.3 in turns, 1001 values; the spread is 0.1 exactly.
std::vector<double> accuracy_set(const char* first, const char* low, const char* high) {
  std::vector<double> values = {std::stod(first)};
  for (int i = 0; i < 500; ++i) values.insert(values.end(), {std::stod(low), std::stod(high)});
  return values;
}

TEST(Moments, StandardDeviationsOfNistReferenceData) {
  const auto digits = [](const std::vector<double>& values, double sd) {
    return correct_digits(std::sqrt(moments_of(values).variance()), sd);
  };
  EXPECT_GE(digits(nist::kLottery.values, nist::kLottery.standard_deviation), 15);
  EXPECT_GE(digits(nist::kLew.values, nist::kLew.standard_deviation), 15);
  EXPECT_GE(digits(nist::kMavro.values, nist::kMavro.standard_deviation), 13);
  EXPECT_GE(digits(nist::kMichelson.values, nist::kMichelson.standard_deviation), 13);
  EXPECT_GE(digits({10000001, 10000003, 10000002}, 1), 15);
  EXPECT_GE(digits(accuracy_set("1.2", "1.1", "1.3"), 0.1), 15);
  // The decimals are 1e-17 of 1e6 and 1e7 off when they become binary64: more digits are not in the data.
  EXPECT_GE(digits(accuracy_set("1000000.2", "1000000.1", "1000000.3"), 0.1), 9);
  EXPECT_GE(digits(accuracy_set("10000000.2", "10000000.1", "10000000.3"), 0.1), 8);
}

TEST(Moments, MeansOfNistReferenceData) {
  for (const nist::Dataset& data : {nist::kLottery, nist::kLew, nist::kMavro, nist::kMichelson}) {
    EXPECT_GE(correct_digits(moments_of(data.values).mean, data.mean), 15.5);
  }
}

TEST(Moments, SmallIntegersAreExact) {
  // 1, 2, 3, 10: mean 4, deviations −3, −2, −1, 6.
  const Moments moments = moments_of(std::vector<double>{1, 2, 3, 10});
  EXPECT_EQ(moments.count, 4);
  EXPECT_EQ(moments.mean, 4);
  EXPECT_EQ(moments.central2, 9 + 4 + 1 + 36);
  EXPECT_EQ(moments.central3, -27 - 8 - 1 + 216);
  EXPECT_EQ(moments.central4, 81 + 16 + 1 + 1296);
  EXPECT_EQ(moments.variance(), 50.0 / 3);
  EXPECT_EQ(moments.m2(), 12.5);
  EXPECT_EQ(moments.m3(), 45);
  EXPECT_EQ(moments.m4(), 348.5);
  EXPECT_DOUBLE_EQ(moments.standard_error(), std::sqrt(50.0 / 12));
}

TEST(Moments, AnyGroupingGivesTheMomentsOfTheWhole) {
  std::mt19937_64 random(3);
  std::lognormal_distribution<double> skewed(0, 1);
  std::vector<double> values(1000);
  for (double& value : values) value = skewed(random);
  // The definition, in extended precision.
  long double mean = 0, sums[5] = {};
  for (const double x : values) mean += x;
  mean /= 1000;
  for (const double x : values) {
    long double power = 1;
    for (int k = 0; k < 5; ++k, power *= x - mean) sums[k] += power;
  }
  for (const std::size_t group : {1u, 2u, 7u, 333u, 999u, 1000u}) {
    Moments whole;
    for (std::size_t i = 0; i < values.size(); i += group) {
      const std::span<const double> part = std::span(values).subspan(i, std::min(group, values.size() - i));
      if (group == 1) {
        whole.add(part[0]);
      } else {
        whole.merge(moments_of(part));
      }
    }
    EXPECT_EQ(whole.count, 1000);
    EXPECT_NEAR(whole.mean / static_cast<double>(mean), 1, 1e-14) << group;
    EXPECT_NEAR(whole.central2 / static_cast<double>(sums[2]), 1, 1e-13) << group;
    EXPECT_NEAR(whole.central3 / static_cast<double>(sums[3]), 1, 1e-12) << group;
    EXPECT_NEAR(whole.central4 / static_cast<double>(sums[4]), 1, 1e-12) << group;
  }
}

TEST(Moments, MergingUnequalSamplesIsSymmetric) {
  const Moments a = moments_of(std::vector<double>{1e3, 1.5e3, 7e3}), b = moments_of(std::vector<double>{-2, 4});
  Moments ab = a, ba = b;
  ab.merge(b);
  ba.merge(a);
  EXPECT_DOUBLE_EQ(ab.mean, ba.mean);
  EXPECT_DOUBLE_EQ(ab.central2, ba.central2);
  EXPECT_DOUBLE_EQ(ab.central3, ba.central3);
  EXPECT_DOUBLE_EQ(ab.central4, ba.central4);
}

TEST(Moments, NothingAddedChangesNothing) {
  const Moments some = moments_of(std::vector<double>{0.1, 0.7, 0.4});
  Moments merged = some;
  merged.merge({});
  merged.add(std::span<const double>());
  Moments into_empty;
  into_empty.merge(some);
  for (const Moments& same : {merged, into_empty}) {
    EXPECT_EQ(same.count, some.count);
    EXPECT_EQ(same.mean, some.mean);
    EXPECT_EQ(same.central4, some.central4);
  }
}

TEST(Moments, ANonFiniteValueIsNeverHidden) {
  for (const double bad : {NAN, INFINITY, -INFINITY}) {
    Moments moments = moments_of(std::vector<double>{1, bad, 2});
    moments.merge(moments_of(std::vector<double>{1, 2}));
    EXPECT_FALSE(std::isfinite(moments.mean));
    EXPECT_FALSE(std::isfinite(moments.central2));
  }
}

}  // namespace
}  // namespace halfslope
