#include "analysis/intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "analysis/bootstrap.h"

namespace halfslope {
namespace {

std::vector<double> squared_normals(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(count);
  for (double& value : values) value = std::pow(normal(random), 2);
  return values;
}

TEST(TQuantile, IsTheInverseIncompleteBetaAndTheClosedForms) {
  // The root of the regularised incomplete beta function, to 30 digits.
  EXPECT_NEAR(t_quantile(0.975, 10), 2.2281388519862747, 1e-12);
  EXPECT_NEAR(t_quantile(0.975, 30), 2.0422724563012383, 1e-12);
  for (const double p : {0.6, 0.95, 0.999999}) {
    EXPECT_NEAR(t_quantile(p, 1) / std::tan(std::numbers::pi * (p - 0.5)), 1, 1e-9);  // Cauchy
    EXPECT_NEAR(t_quantile(p, 2) / ((2 * p - 1) / std::sqrt(2 * p * (1 - p))), 1, 1e-9);
    EXPECT_NEAR(t_quantile(1 - p, 5), -t_quantile(p, 5), 1e-9 * t_quantile(p, 5));
  }
}

TEST(TInterval, IsMeanPlusMinusTTimesStandardError) {
  Moments moments;
  moments.add(std::vector<double>{1, 2, 3});
  const std::optional<Interval> interval = t_interval(moments);
  ASSERT_TRUE(interval);
  const double half_width = 0.95 / std::sqrt(2 * 0.975 * 0.025) / std::sqrt(3.0);  // t with 2 degrees of freedom, s = 1
  EXPECT_NEAR(interval->lo, 2 - half_width, 1e-12);
  EXPECT_NEAR(interval->hi, 2 + half_width, 1e-12);
  EXPECT_FALSE(t_interval(Moments{}));
  Moments one;
  one.add(5.0);
  EXPECT_FALSE(t_interval(one));
}

TEST(Resample, IndicesAreUniformAndDifferBetweenResamplesAndSeeds) {
  constexpr std::uint32_t kCount = 7;
  std::vector<std::uint32_t> indices(1001), others(1001), again(1001);
  std::vector<double> hits(kCount);
  for (std::uint32_t resample = 0; resample < 100; ++resample) {
    draw_resample(1, resample, kCount, indices);
    for (const std::uint32_t index : indices) {
      ASSERT_LT(index, kCount);
      ++hits[index];
    }
  }
  // χ² with 6 degrees of freedom exceeds 38.3 with probability 1e-6.
  double chi2 = 0;
  for (const double hit : hits) chi2 += std::pow(hit - 100100.0 / kCount, 2) / (100100.0 / kCount);
  EXPECT_LT(chi2, 38.3);
  draw_resample(1, 99, kCount, again);
  EXPECT_EQ(again, indices);
  draw_resample(1, 98, kCount, others);
  EXPECT_NE(others, indices);
  draw_resample(2, 99, kCount, others);
  EXPECT_NE(others, indices);
}

TEST(BootstrapTInterval, EndsAreTheRightRanksTheRightWayRound) {
  std::vector<double> t(999);
  for (std::size_t i = 0; i < 999; ++i) t[i] = static_cast<double>(i) - 400;  // sorted ranks 25 and 975: −376 and 574
  std::ranges::shuffle(t, std::mt19937(4));
  const std::optional<Interval> interval = bootstrap_t_interval(1, 0.5, 2, t, 0.95);
  ASSERT_TRUE(interval);
  EXPECT_EQ(interval->lo, 1 - 574.0);
  EXPECT_EQ(interval->hi, 1 + 376.0);
}

TEST(BootstrapTInterval, MissingResamplesMoveBothEndsOutwards) {
  std::vector<double> t(999 - 24);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = static_cast<double>(i);
  const std::optional<Interval> interval = bootstrap_t_interval(0, 1, 1, t, 0.95);
  ASSERT_TRUE(interval);
  EXPECT_EQ(interval->lo, -974);
  EXPECT_EQ(interval->hi, 0);
  t.pop_back();
  EXPECT_FALSE(bootstrap_t_interval(0, 1, 1, t, 0.95));
}

/// Share of 4000 experiments whose interval holds log E[e²] = 0 for e ~ N(0, 1).
double coverage_of_squared_normals(std::size_t count) {
  constexpr int kExperiments = 4000;
  int covered = 0;
  for (std::uint64_t i = 0; i < kExperiments; ++i) {
    const std::optional<Interval> interval = log_mean_bootstrap_t(squared_normals(count, 1000 + i), i);
    covered += interval && interval->lo <= 0 && 0 <= interval->hi;
  }
  return static_cast<double>(covered) / kExperiments;
}

// Where the coverage is 95 % the share of 4000 lies in [92.5 %, 97.5 %] but for 1e-12.
class CoverageTest : public testing::TestWithParam<std::size_t> {};
TEST_P(CoverageTest, BootstrapTHoldsTheTruthAsOftenAsItSays) {
  const double coverage = coverage_of_squared_normals(GetParam());
  RecordProperty("coverage", std::to_string(coverage));
  EXPECT_GE(coverage, 0.925);
  EXPECT_LE(coverage, 0.975);
}
INSTANTIATE_TEST_SUITE_P(SquaredNormals, CoverageTest, testing::Values(16, 64, 256));

TEST(LogMeanBootstrapT, ScaleMovesTheIntervalAndNothingElse) {
  std::vector<double> values = squared_normals(50, 1);
  const std::optional<Interval> interval = log_mean_bootstrap_t(values, 9);
  for (double& value : values) value *= 0x1p-200;
  const std::optional<Interval> scaled = log_mean_bootstrap_t(values, 9);
  ASSERT_TRUE(interval && scaled);
  EXPECT_NEAR(scaled->lo, interval->lo - 200 * std::numbers::ln2, 1e-10);
  EXPECT_NEAR(scaled->hi, interval->hi - 200 * std::numbers::ln2, 1e-10);
}

TEST(LogMeanBootstrapT, TheUpperEndIsTheFartherOneForSkewedValues) {
  const std::vector<double> values = squared_normals(64, 5);
  Moments moments;
  moments.add(values);
  const std::optional<Interval> interval = log_mean_bootstrap_t(values, 1);
  ASSERT_TRUE(interval);
  EXPECT_GT(interval->hi - std::log(moments.mean), std::log(moments.mean) - interval->lo);
}

TEST(LogMeanBootstrapT, IsAFunctionOfValuesAndSeed) {
  const std::vector<double> values = squared_normals(33, 5);
  const auto a = log_mean_bootstrap_t(values, 1), b = log_mean_bootstrap_t(values, 1),
             c = log_mean_bootstrap_t(values, 2);
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->lo, b->lo);
  EXPECT_EQ(a->hi, b->hi);
  EXPECT_NE(a->lo, c->lo);
}

TEST(LogMeanBootstrapT, IsEmptyWhereNothingIsKnown) {
  std::vector<double> rare(64, 0.0);
  rare[3] = 1;  // 36 % of the resamples are all zeros
  EXPECT_FALSE(log_mean_bootstrap_t(rare, 1));
  EXPECT_FALSE(log_mean_bootstrap_t(std::vector<double>{1, 2}, 1));
  EXPECT_FALSE(log_mean_bootstrap_t(std::vector<double>{1}, 1));
  EXPECT_FALSE(log_mean_bootstrap_t(std::vector<double>(), 1));
  EXPECT_FALSE(log_mean_bootstrap_t(std::vector<double>(64, 0.0), 1));
  EXPECT_FALSE(log_mean_bootstrap_t(std::vector<double>(64, 0.7), 1));
  std::vector<double> values = squared_normals(64, 1);
  for (const double bad : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    values[10] = bad;
    EXPECT_FALSE(log_mean_bootstrap_t(values, 1)) << bad;
  }
}

TEST(LogMeanT, HoldsTheTruthAsOftenAsItSaysWithManyValues) {
  // 2000 experiments at 95 %: 92.5 % or less with probability below 1e-6.
  int covered = 0;
  std::mt19937_64 random(8);
  std::exponential_distribution<double> exponential;
  std::vector<double> values(5000);
  for (int i = 0; i < 2000; ++i) {
    for (double& value : values) value = exponential(random);
    Moments moments;
    moments.add(values);
    const std::optional<Interval> interval = log_mean_t(moments);
    covered += interval && interval->lo <= 0 && 0 <= interval->hi;
  }
  EXPECT_GE(covered, 1850);
  EXPECT_LE(covered, 1950);
  EXPECT_FALSE(log_mean_t(Moments{5, 0, 0, 0, 0}));
  EXPECT_FALSE(log_mean_t(Moments{5, 1, 0, 0, 0}));
  EXPECT_FALSE(log_mean_t(Moments{1, 1, 0, 0, 0}));
}

}  // namespace
}  // namespace halfslope
