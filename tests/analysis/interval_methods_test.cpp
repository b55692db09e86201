#include "analysis/interval_methods.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace halfslope {
namespace {

std::vector<double> squared_normals(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(count);
  for (double& value : values) value = std::pow(normal(random), 2);
  return values;
}

TEST(IntervalMethods, NamesAreReadBackAndBootstrapTIsTheDefault) {
  for (const IntervalMethodInfo& info : interval_methods()) {
    EXPECT_EQ(parse_interval_method(info.name), info.method);
    EXPECT_EQ(to_string(info.method), info.name);
  }
  EXPECT_EQ(interval_methods().front().method, IntervalMethod::kBootstrapT);
  EXPECT_EQ(to_string(IntervalMethod{}), "bootstrap-t");
  EXPECT_FALSE(parse_interval_method("student"));
  EXPECT_FALSE(parse_interval_method(""));
}

TEST(IntervalMethods, EachIsOfTheLogarithmAndMovesWithTheScale) {
  std::vector<double> values = squared_normals(40, 3);
  for (const IntervalMethodInfo& info : interval_methods()) {
    const auto interval = log_mean_interval(info.method, values, 5);
    std::vector<double> scaled = values;
    for (double& value : scaled) value *= 0x1p-300;
    const auto moved = log_mean_interval(info.method, scaled, 5);
    ASSERT_TRUE(interval && moved) << info.name;
    EXPECT_NEAR(moved->lo, interval->lo - 300 * std::log(2.0), 1e-9) << info.name;
    EXPECT_NEAR(moved->hi, interval->hi - 300 * std::log(2.0), 1e-9) << info.name;
    EXPECT_LT(interval->lo, interval->hi) << info.name;
  }
}

TEST(IntervalMethods, SeveralFromOneSetOfResamplesAreThoseOfEach) {
  const std::vector<double> values = squared_normals(33, 4);
  std::vector<IntervalMethod> all;
  for (const IntervalMethodInfo& info : interval_methods()) all.push_back(info.method);
  const auto together = log_mean_intervals(all, values, 9);
  ASSERT_EQ(together.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto alone = log_mean_interval(all[i], values, 9);
    ASSERT_TRUE(alone && together[i]);
    EXPECT_EQ(alone->lo, together[i]->lo);
    EXPECT_EQ(alone->hi, together[i]->hi);
  }
}

TEST(IntervalMethods, AreEmptyWhereNothingIsKnown) {
  std::vector<double> negative = squared_normals(20, 1), infinite = negative;
  negative[4] = -1;
  infinite[4] = INFINITY;
  for (const IntervalMethodInfo& info : interval_methods()) {
    for (const auto& values : {std::vector<double>{},
                               {1.0},
                               std::vector<double>(20, 0.7),
                               std::vector<double>(20, 0.0),
                               negative,
                               infinite}) {
      EXPECT_FALSE(log_mean_interval(info.method, values, 1)) << info.name << " of " << values.size();
    }
  }
}

// ν = 2 n m²/s². With m = 1 and s²/n = 0.2, ν = 10, whose quantiles tables have as 3.246973 and 20.483177.
TEST(Chi2Interval, IsTheTextbookIntervalOfAVariance) {
  const auto interval = log_mean_chi2({5, 1, 4, 0, 0});  // variance 4/4, over 5
  ASSERT_TRUE(interval);
  EXPECT_NEAR(std::exp(interval->lo), 10 / 20.483177, 1e-7);
  EXPECT_NEAR(std::exp(interval->hi), 10 / 3.246973, 1e-6);
}

TEST(Chi2Interval, TendsToTheDeltaMethodsAsTheSpreadFalls) {
  for (const double central2 : {1e-6, 1e-12, 1e-20}) {
    const Moments moments = {100000, 1, central2, 0, 0};
    const auto chi2 = log_mean_chi2(moments), delta = log_mean_t(moments);
    ASSERT_TRUE(chi2 && delta) << central2;
    EXPECT_NEAR((chi2->hi - chi2->lo) / (delta->hi - delta->lo), 1, 1e-3) << central2;
  }
}

TEST(BcaInterval, MatchesThePercentilesOfTheMeansExactDistribution) {
  // Values 0 or 2, half each: symmetric, so no correction, and the mean of n is 2/n times a binomial count.
  std::vector<double> values(400);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 2 == 0 ? 0 : 2;
  const auto interval = log_mean_interval(IntervalMethod::kBca, values, 3);
  ASSERT_TRUE(interval);
  // Mean 1, standard error 0.05: 1 ± 1.96 · 0.05. A quantile of 999 resamples has the standard error √(0.025 · 0.975 /
  // 999) / 0.0584 = 0.085 of those; five of it and of the bias correction's own 0.04, doubled.
  EXPECT_NEAR(std::exp(interval->lo), 1 - 0.098, 0.05 * 5 * 0.12);
  EXPECT_NEAR(std::exp(interval->hi), 1 + 0.098, 0.05 * 5 * 0.12);
}

TEST(ReciprocalTInterval, HasAnUpperEndThatMayBeUnbounded) {
  // One value holds nearly all: the mean could be anything above.
  std::vector<double> values = squared_normals(16, 1);
  values[0] = 1e4;
  bool unbounded = false;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto interval = log_mean_interval(IntervalMethod::kReciprocalT, values, seed);
    ASSERT_TRUE(interval);
    EXPECT_TRUE(std::isfinite(interval->lo));
    EXPECT_FALSE(std::isnan(interval->hi));
    unbounded |= std::isinf(interval->hi);
  }
  EXPECT_TRUE(unbounded);
}

}  // namespace
}  // namespace halfslope
