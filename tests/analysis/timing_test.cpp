#include "analysis/timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace halfslope {
namespace {

/// 0, 1, … n − 1 out of order, so that an interval's ends are its ranks.
std::vector<double> ranks(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 0.0);
  std::shuffle(values.begin(), values.end(), std::mt19937_64(1));
  return values;
}

// Sums of binomial coefficients over 2^n, by hand.
TEST(MedianEstimate, HasTheRanksThatTheBinomialGives) {
  struct Case {
    std::size_t n, k;
    double coverage;
  };
  for (const auto& [n, k, coverage] :
       {Case{6, 1, 1 - 2 * 1.0 / 64}, Case{8, 1, 1 - 2 * 1.0 / 256}, Case{9, 2, 1 - 2 * 10.0 / 512},
        Case{10, 2, 1 - 2 * 11.0 / 1024}, Case{15, 4, 1 - 2 * 576.0 / 32768}, Case{20, 6, 1 - 2 * 21700.0 / 1048576}}) {
    const MedianEstimate estimate = median_estimate(ranks(n));
    EXPECT_EQ(estimate.interval.lo, static_cast<double>(k - 1)) << n;
    EXPECT_EQ(estimate.interval.hi, static_cast<double>(n - k)) << n;
    EXPECT_NEAR(estimate.coverage, coverage, 1e-14) << n;
    EXPECT_EQ(estimate.median, static_cast<double>(n - 1) / 2) << n;
  }
}

// The normal approximation of the binomial is good there: k = n/2 − 0.98 √n, and a rank further in is too few.
TEST(MedianEstimate, HasTheRanksOfManyValuesToo) {
  const MedianEstimate estimate = median_estimate(ranks(10000));
  EXPECT_NEAR(estimate.interval.lo, 5000 - 98, 2);
  EXPECT_GE(estimate.coverage, 0.95);
  EXPECT_LT(estimate.coverage, 0.952);
}

TEST(MedianEstimate, OfFewValuesIsTheirRangeAndSaysWhatThatIsWorth) {
  const MedianEstimate three = median_estimate(std::vector<double>{5, 1, 2});
  EXPECT_EQ(three.median, 2);
  EXPECT_EQ(three.interval.lo, 1);
  EXPECT_EQ(three.interval.hi, 5);
  EXPECT_DOUBLE_EQ(three.coverage, 0.75);
  const MedianEstimate one = median_estimate(std::vector<double>{7});
  EXPECT_EQ(one.interval.lo, 7);
  EXPECT_EQ(one.interval.hi, 7);
  EXPECT_EQ(one.coverage, 0);
}

// Times with a long tail, as of a machine that others use: an exponential law, median log 2. The count of runs that
// hold it is binomial; five standard deviations to either side are a false alarm in 6e-7.
TEST(MedianEstimate, CoversTheMedianOfASkewedLaw) {
  constexpr int kRuns = 4000;
  std::mt19937_64 random(3);
  std::exponential_distribution<double> law;
  const double share = 1 - 2 * 576.0 / 32768;
  int covered = 0;
  std::vector<double> values(15);
  for (int run = 0; run < kRuns; ++run) {
    for (double& value : values) value = law(random);
    const Interval interval = median_estimate(values).interval;
    covered += interval.lo <= std::log(2) && std::log(2) <= interval.hi;
  }
  EXPECT_NEAR(covered, share * kRuns, 5 * std::sqrt(kRuns * share * (1 - share)));
}

TEST(MedianEstimateDeathTest, RefusesNothingAndWhatIsNotFinite) {
  EXPECT_DEATH(median_estimate({}), "there is no value");
  EXPECT_DEATH(median_estimate(std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}), "finite");
}

TEST(Efficiency, JoinsHalfWidthsInQuadratureOnTheLog) {
  // An rmse within a factor e^0.15 and a time within e^0.4: hypot(2 · 0.15, 0.4) = 0.5.
  const PositiveEstimate rmse = {0.1, 0.1 * std::exp(-0.15), 0.1 * std::exp(0.15)};
  const PositiveEstimate seconds = {4, 4 * std::exp(-0.4), 4 * std::exp(0.4)};
  const PositiveEstimate result = efficiency(rmse, seconds);
  EXPECT_DOUBLE_EQ(result.value, 25);
  EXPECT_NEAR(*result.lo, 25 * std::exp(-0.5), 1e-12);
  EXPECT_NEAR(*result.hi, 25 * std::exp(0.5), 1e-12);
}

TEST(Efficiency, TurnsSidesRound) {
  // What may be much larger is the error, so what may be much smaller is the efficiency.
  const PositiveEstimate result = efficiency({1, 1, 2}, {1, 1, 1});
  EXPECT_DOUBLE_EQ(*result.lo, 0.25);
  EXPECT_DOUBLE_EQ(*result.hi, 1);
}

TEST(Efficiency, HasNoEndWhereTheErrorHasNone) {
  EXPECT_FALSE(efficiency({1}, {1, 0.9, 1.1}).lo);
  EXPECT_FALSE(efficiency({1}, {1, 0.9, 1.1}).hi);
  const PositiveEstimate half = efficiency({1, std::nullopt, 2}, {1, 0.9, 1.1});
  EXPECT_TRUE(half.lo);
  EXPECT_FALSE(half.hi);
}

TEST(Places, AreRangesWhereIntervalsOverlap) {
  // A and B overlap, B and C overlap, A and C do not, D is worse than all.
  const std::vector<PositiveEstimate> estimates = {{10, 9, 11}, {9, 8, 10}, {8, 7.5, 8.5}, {1, 0.5, 2}, {100}};
  const auto larger = places(estimates, true);
  EXPECT_EQ(larger[0]->text(), "1-2");
  EXPECT_EQ(larger[1]->text(), "1-3");
  EXPECT_EQ(larger[2]->text(), "2-3");
  EXPECT_EQ(larger[3]->text(), "4");
  EXPECT_FALSE(larger[4]);  // without an interval nothing is known
  const auto smaller = places(estimates, false);
  EXPECT_EQ(smaller[0]->text(), "3-4");
  EXPECT_EQ(smaller[3]->text(), "1");
}

}  // namespace
}  // namespace halfslope
