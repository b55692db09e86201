#include "analysis/half_buffers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "analysis/moments.h"

namespace halfslope {
namespace {

TEST(HalfBuffers, AreTheDefinitions) {
  const std::vector<double> a = {1, 2}, b = {2, 6}, estimate = {4, 3};
  EXPECT_DOUBLE_EQ(half_buffer_mse(estimate, a, b), (3 * 2 + 1 * -3) / 2.0);
  const HalfBuffers halves = compare_halves(a, b, 1);
  EXPECT_DOUBLE_EQ(halves.mean_square, (0.25 + 4) / 2);
  EXPECT_DOUBLE_EQ(halves.noise, 4.0 / 3 * (0.0625 + 16) / 4);
  EXPECT_DOUBLE_EQ(compare_halves(a, b, 2).noise, 4.0 / 3 * (4.25 * 4.25) / 4);
  // (Î − A)(Î − B) = (Î − W)² − D²
  EXPECT_DOUBLE_EQ(half_buffer_mse(estimate, a, b), (2.5 * 2.5 + 1) / 2 - halves.mean_square);
}

TEST(HalfBuffers, EqualHalvesAreAnExactReference) {
  const std::vector<double> truth = {1, 2, 3}, estimate = {2, 2, 1};
  EXPECT_DOUBLE_EQ(half_buffer_mse(estimate, truth, truth), (1 + 0 + 4) / 3.0);
  const HalfBuffers halves = compare_halves(truth, truth, 1);
  EXPECT_EQ(halves.mean_square, 0);
  EXPECT_EQ(halves.noise, 0);
  const std::vector<double> values = {1, 2, 4, 3, 2, 5, 1, 3, 2, 2, 4, 3, 1, 2, 3, 2};
  const HalfBufferMse mse = half_buffer_interval(values, halves, 5);
  EXPECT_DOUBLE_EQ(mse.mse, 2.5);
  EXPECT_LT(mse.lo.value(), 2.5);
  EXPECT_GT(mse.hi.value(), 2.5);
}

// Halves whose laws differ from one another, from pixel to pixel, and from a normal one (exponential, less its mean):
// no variance of theirs is known or estimated. Over 20 000 runs the mean of the half-buffer form is the true mean
// squared error, 1, to within five standard errors; that of e² is off by the variance of the halves' mean.
TEST(HalfBuffers, AreUnbiasedWhereSquaresAreNot) {
  constexpr int kRuns = 20000;
  constexpr std::size_t kPixels = 8;
  std::mt19937_64 random(21);
  std::normal_distribution<double> normal;
  std::exponential_distribution<double> exponential;
  Moments products, squares;
  double whole_variance = 0;
  for (std::size_t p = 0; p < kPixels; ++p) {
    const double scale = 0.2 * static_cast<double>(1 + p);
    whole_variance += (scale * scale + 0.25) / 4 / kPixels;  // Var (A + B)/2
  }
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> a(kPixels), b(kPixels), estimate(kPixels);
    double square = 0;
    for (std::size_t p = 0; p < kPixels; ++p) {
      const double truth = 3.0 + static_cast<double>(p);
      a[p] = truth + 0.2 * static_cast<double>(1 + p) * (exponential(random) - 1);
      b[p] = truth + 0.5 * normal(random);
      estimate[p] = truth + normal(random);
      square += std::pow(estimate[p] - 0.5 * (a[p] + b[p]), 2) / kPixels;
    }
    products.add(half_buffer_mse(estimate, a, b));
    squares.add(square);
  }
  EXPECT_NEAR(products.mean, 1, 5 * products.standard_error());
  EXPECT_NEAR(squares.mean, 1 + whole_variance, 5 * squares.standard_error());
  EXPECT_GT(squares.mean, 1 + 20 * squares.standard_error());
}

TEST(HalfBuffers, WhatCannotBeToldIsEmptyAndNothingIsClamped) {
  const HalfBufferMse none = half_buffer_interval({}, {}, 1);
  EXPECT_TRUE(std::isnan(none.mse));
  EXPECT_FALSE(none.lo || none.hi);
  const std::vector<double> negative = {-0.5, -0.7, -0.4, -0.6, -0.5, -0.45, -0.55, -0.65,
                                        -0.5, -0.7, -0.4, -0.6, -0.5, -0.45, -0.55, -0.65};
  const HalfBufferMse limited = half_buffer_interval(negative, {1.0, 0.01}, 1);
  EXPECT_LT(limited.mse, 0);
  EXPECT_FALSE(limited.lo || limited.hi);
}

// Above 4096 replicates the interval is Student's t on the logarithm, without a bootstrap's random numbers.
TEST(HalfBuffers, ManyReplicatesNeedNoBootstrap) {
  std::mt19937_64 random(3);
  std::exponential_distribution<double> exponential;
  std::vector<double> values(5000);
  for (double& value : values) value = exponential(random);
  const HalfBufferMse one = half_buffer_interval(values, {}, 1), other = half_buffer_interval(values, {}, 2);
  EXPECT_EQ(one.lo, other.lo);
  EXPECT_DOUBLE_EQ(one.lo.value() * one.hi.value(), one.mse * one.mse);
}

}  // namespace
}  // namespace halfslope
