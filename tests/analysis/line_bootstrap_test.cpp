#include "analysis/line_bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfslope {
namespace {

const std::vector<std::vector<double>> kErrors = {{1, 2, 3, 6}, {0.5, 0.5, 1, 2}, {0.1, 0.3, 0.2, 0.2}};

TEST(LineBootstrap, StandardErrorsAreThoseOfTheMeanInfluence) {
  // u_r = ½ Σ c_j (mse_rj − M_j) / (M_j − V̄), its standard error √(Σ u² / (R (R − 1))).
  const std::vector<double> c = {-1, 0.25, 0.75}, means = {3, 1, 0.2};
  const LineBootstrap line(kErrors, {0.1, 0}, 1);
  double squares = 0, value = 0;
  for (std::size_t r = 0; r < 4; ++r) {
    double u = 0;
    for (std::size_t j = 0; j < 3; ++j) u += 0.5 * c[j] * (kErrors[j][r] - means[j]) / (means[j] - 0.1);
    squares += u * u;
  }
  for (std::size_t j = 0; j < 3; ++j) value += c[j] * 0.5 * std::log(means[j] - 0.1);
  EXPECT_NEAR(line.standard_error(c), std::sqrt(squares / 12), 1e-14);
  EXPECT_NEAR(line.value(c), value, 1e-14);
}

TEST(LineBootstrap, ErrorsThatMoveTogetherHaveNoSpreadInTheirSlope) {
  std::vector<std::vector<double>> mse(2, std::vector<double>(32));
  for (std::size_t r = 0; r < 32; ++r) mse[0][r] = 3 * (mse[1][r] = 1 + 0.37 * static_cast<double>(r));
  const LineBootstrap line(mse, {}, 1);
  EXPECT_EQ(line.standard_error(std::vector<double>{-1, 1}), 0);
  EXPECT_FALSE(line.interval(std::vector<double>{-1, 1}));
  EXPECT_TRUE(line.interval(std::vector<double>{0, 1}));
}

TEST(LineBootstrap, TheReferencesErrorWidensAndSkewsTheInterval) {
  std::vector<std::vector<double>> mse(2, std::vector<double>(256));
  for (std::size_t r = 0; r < 256; ++r) {
    mse[0][r] = 1 + 0.1 * static_cast<double>(r % 7);
    mse[1][r] = 0.1 + 0.01 * static_cast<double>(r % 11);
  }
  const std::vector<double> c = {-1, 1};
  const LineBootstrap exact(mse, {0.02, 0}, 1), single(mse, {0.02, 2 * 0.02 * 0.02}, 1);
  const Interval narrow = *exact.interval(c), wide = *single.interval(c);
  const double at = single.value(c);
  EXPECT_EQ(at, exact.value(c));
  EXPECT_LT(wide.lo, narrow.lo);
  EXPECT_GT(wide.hi, narrow.hi);
  // δ² is mostly below its mean V̄ and rarely far above it: then the corrected error is too large, and the truth is far
  // below.
  EXPECT_GT((at - wide.lo) - (at - narrow.lo), 2 * ((wide.hi - at) - (narrow.hi - at)));
  // With next to no noise of the replicates: ½ log(1 + V̄ (χ²_q − 1)/corrected) at the quantiles of χ²₁, which are
  // 5.0239 at 97.5 % and 0.00098 at 2.5 %, plus what the replicates add.
  const double corrected = 0.1 + 0.01 * 4.98828125 - 0.02, below = 0.5 * std::log(1 + 0.02 * 4.0239 / corrected),
               above = -0.5 * std::log(1 - 0.02 * 0.99902 / corrected), noise = narrow.hi - narrow.lo;
  EXPECT_NEAR(at - wide.lo, below, noise);
  EXPECT_NEAR(wide.hi - at, above, noise);
}

TEST(LineBootstrap, ManyNGiveTheIntervalsOfFew) {
  // Those of three N, whatever others stand beside them, and however their covariances are kept.
  std::vector<std::vector<double>> mse(LineBootstrap::kMostPaired + 7, std::vector<double>(40));
  for (std::size_t j = 0; j < mse.size(); ++j) {
    for (std::size_t r = 0; r < 40; ++r)
      mse[j][r] = (1 + static_cast<double>((r * (j + 3)) % 11)) / (1.0 + static_cast<double>(j));
  }
  const std::vector<std::vector<double>> few(mse.begin(), mse.begin() + 3);
  std::vector<double> c = {-1, 0.25, 0.75};
  const ReferenceNoise reference = {0.02, 2 * 0.02 * 0.02};
  const Interval of_few = *LineBootstrap(few, reference, 5).interval(c);
  c.resize(mse.size());
  const Interval of_many = *LineBootstrap(mse, reference, 5).interval(c);
  EXPECT_NEAR(of_many.lo, of_few.lo, 1e-12);
  EXPECT_NEAR(of_many.hi, of_few.hi, 1e-12);
}

TEST(LineBootstrap, WhatNoReplicateMovesIsZeroOrNot) {
  const std::vector<std::vector<double>> alike(3, {1, 1, 1, 1});
  const LineBootstrap line(alike, {}, 1);
  const std::vector<double> c = {1, -2, 1};
  EXPECT_FALSE(line.differ_from_zero(std::vector<Combination>{{c, 0.0}}, 0.01));
  const std::vector<std::vector<double>> bent = {{1, 1, 1, 1}, {0.5, 0.5, 0.5, 0.5}, {0.3, 0.3, 0.3, 0.3}};
  const LineBootstrap other(bent, {}, 1);
  EXPECT_TRUE(other.differ_from_zero(std::vector<Combination>{{c, other.value(c)}}, 0.01));
}

}  // namespace
}  // namespace halfslope
