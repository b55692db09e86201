#include "analysis/reference_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "analysis/half_buffers.h"
#include "analysis/moments.h"
#include "tests/analysis/noisy_reference.h"

namespace halfslope {
namespace {

TEST(MeanSquareNoise, IsTheDefinition) {
  EXPECT_EQ(mean_square_noise({}, 1), 0);
  EXPECT_DOUBLE_EQ(mean_square_noise(std::vector<double>{3}, 1), 2 * 9);
  EXPECT_DOUBLE_EQ(mean_square_noise(std::vector<double>{1, 2, 3, 4}, 1), 2.0 * (1 + 4 + 9 + 16) / 16);
  EXPECT_DOUBLE_EQ(mean_square_noise(std::vector<double>{1, 2, 3, 4}, 2), 2.0 * (9 + 49) / 16);
  EXPECT_DOUBLE_EQ(mean_square_noise(std::vector<double>{1, 2}, 1, std::vector<double>{10, 0.5}), 2.0 * (100 + 1) / 4);
}

// The variance of mean δ², of normal δ: each estimate of a variance from 40 000 values with kurtosis κ ≤ 15 has the
// relative standard error √((κ − 1)/40 000) ≤ 1.9 %; 0.1 is more than five of them.
TEST(MeanSquareNoise, IsTheVarianceOfTheMeanSquareOfNormalErrors) {
  constexpr std::size_t kRuns = 40000;
  const std::vector<double> variances = {1, 1, 1, 4, 4, 4, 0.25, 0.25, 0.25};
  for (const bool channels_go_together : {false, true}) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    Moments mean_squares;
    for (std::size_t run = 0; run < kRuns; ++run) {
      double sum = 0, draw = 0;
      for (std::size_t i = 0; i < variances.size(); ++i) {
        if (!channels_go_together || i % 3 == 0) draw = normal(random);
        sum += variances[i] * draw * draw;
      }
      mean_squares.add(sum / static_cast<double>(variances.size()));
    }
    const std::size_t channels = channels_go_together ? 3 : 1;
    EXPECT_NEAR(mean_squares.variance() / mean_square_noise(variances, channels), 1, 0.1);
  }
}

TEST(WidenedForReference, AddsInQuadratureOnEachSide) {
  const double mean = 5, centre = std::log(mean);
  const Interval own = {centre - 0.3, centre + 0.4};
  const Interval same = widened_for_reference(own, mean, 0);
  EXPECT_EQ(same.lo, own.lo);
  EXPECT_EQ(same.hi, own.hi);
  const double noise = std::pow(0.4 * mean / 1.959963984540054, 2);  // reaches 0.4 on the logarithm
  const Interval wide = widened_for_reference(own, mean, noise);
  EXPECT_NEAR(centre - wide.lo, 0.5, 1e-12);
  EXPECT_NEAR(wide.hi - centre, 0.4 * std::sqrt(2.0), 1e-12);
}

// The ends of a mean's interval may be a factor 10¹² off: 10⁶ of its root.
TEST(CorrectedMean, EndsThatSayNothingAreEmpty) {
  const double mean = 0.04, far = std::log(1e12);
  const auto near = corrected_mean(mean, Interval{std::log(mean) - 0.99 * far, std::log(mean) + 0.99 * far}, {});
  EXPECT_TRUE(near.lo && near.hi);
  const auto beyond = corrected_mean(mean, Interval{std::log(mean) - 1, std::log(mean) + 1.01 * far}, {});
  EXPECT_TRUE(beyond.value && beyond.lo);
  EXPECT_FALSE(beyond.hi);
  const auto below = corrected_mean(mean, Interval{std::log(mean) - 1.01 * far, std::log(mean) + 1}, {});
  EXPECT_TRUE(below.value && below.hi);
  EXPECT_FALSE(below.lo);
  const auto overflowing = corrected_mean(1e-300, Interval{-1000.0, 700.0}, {});
  EXPECT_TRUE(overflowing.value);
  EXPECT_FALSE(overflowing.lo || overflowing.hi);
}

// With the noisiest reference that a plan accepts, min(1 %, 0.25/√R) of the mean squared error, intervals still cover:
// of 4000 runs that cover 95 %, fewer than 93 % or more than 97 % do with a probability below 1e-7.
void expect_coverage(std::size_t pixels, std::int64_t replicates) {
  const double share = std::min(0.01, 0.25 / std::sqrt(static_cast<double>(replicates)));
  const NoisyCoverage coverage = noisy_coverage(pixels, replicates, share, true, 4000, 11);
  for (const double covered : {coverage.rmse, coverage.halves}) {
    EXPECT_GT(covered, 0.93) << pixels << " pixels, R = " << replicates;
    EXPECT_LT(covered, 0.97) << pixels << " pixels, R = " << replicates;
  }
}
TEST(NoisyReference, AtItsLargestShareIntervalsOfScalarsCover) { expect_coverage(1, 64); }
TEST(NoisyReference, AtItsLargestShareIntervalsOfImagesCover) { expect_coverage(32, 64); }
TEST(LongNoisyReference, AtItsLargestShareIntervalsCover) {
  for (const std::size_t pixels : {1u, 32u}) {
    for (const std::int64_t replicates : {256, 1024}) expect_coverage(pixels, replicates);
  }
}

// A reference as noisy as the error itself, far beyond what a plan accepts: the replicates' spread alone misses what
// all of them have in common. (Bounds: 4000 runs, as above.)
TEST(NoisyReference, FarBeyondItsShareOnlyTheWidenedIntervalCovers) {
  const NoisyCoverage coverage = noisy_coverage(32, 256, 1.0, false, 4000, 12);
  EXPECT_LT(coverage.not_widened, 0.6);
  EXPECT_GT(coverage.rmse, 0.93);
  EXPECT_LT(coverage.rmse, 0.97);
}

}  // namespace
}  // namespace halfslope
