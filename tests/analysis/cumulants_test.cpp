// Cumulants of laws whose every cumulant is known.
#include "analysis/cumulants.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfslope {
namespace {

// Of U on [0, 1]: κ_n = B_n / n, the Bernoulli numbers; its central moments are 2^−n / (n + 1).
TEST(Cumulants, OfUniformNumbers) {
  const std::array<double, 9> moments = {1, 0, 1.0 / 12, 0, 1.0 / 80, 0, 1.0 / 448, 0, 1.0 / 2304};
  const Cumulants uniform = cumulants_from_central_moments(0.5, moments);
  const std::array<double, 9> expected = {0, 0.5, 1.0 / 12, 0, -1.0 / 120, 0, 1.0 / 252, 0, -1.0 / 240};
  for (std::size_t j = 1; j <= 8; ++j) EXPECT_NEAR(uniform[j], expected[j], 1e-15) << j;
  EXPECT_NEAR(uniform.kurtosis(), 1.8, 1e-13);
  EXPECT_EQ(uniform.skewness(), 0);
}

// Of the exponential law: κ_n = (n − 1)!; its central moments count the permutations without a fixed point.
TEST(Cumulants, OfExponentialNumbers) {
  const std::array<double, 9> derangements = {1, 0, 1, 2, 9, 44, 265, 1854, 14833};
  const Cumulants exponential = cumulants_from_central_moments(1, derangements);
  for (std::size_t j = 1; j <= 8; ++j) EXPECT_NEAR(exponential[j], std::tgamma(j), 1e-9) << j;
  EXPECT_NEAR(exponential.skewness(), 2, 1e-15);
  EXPECT_NEAR(exponential.kurtosis(), 9, 1e-14);
  // A mean of k is Γ(k) / k: skewness 2/√k, K = 3 + 6/k.
  const Cumulants mean = exponential.of_mean(16);
  EXPECT_NEAR(mean[1], 1, 1e-15);
  EXPECT_NEAR(mean[2], 1.0 / 16, 1e-15);
  EXPECT_NEAR(mean.skewness(), 0.5, 1e-14);
  EXPECT_NEAR(mean.kurtosis(), 3.375, 1e-14);
}

TEST(Cumulants, OfSumsAdd) {
  const std::array<double, 9> derangements = {1, 0, 1, 2, 9, 44, 265, 1854, 14833};
  const Cumulants exponential = cumulants_from_central_moments(1, derangements);
  // E₁ − E₂ is Laplace's: K = 6, no odd ones.
  Cumulants laplace = exponential;
  laplace.add(exponential, 1, -1);
  EXPECT_EQ(laplace[1], 0);
  EXPECT_EQ(laplace[2], 2);
  EXPECT_EQ(laplace[3], 0);
  EXPECT_EQ(laplace.kurtosis(), 6);
  EXPECT_EQ(laplace[7], 0);
  // 3 of E/2.
  Cumulants halves;
  halves.add(exponential, 3, 0.5);
  EXPECT_EQ(halves[1], 1.5);
  EXPECT_EQ(halves[2], 0.75);
  EXPECT_EQ(halves[4], 3 * 6.0 / 16);
}

}  // namespace
}  // namespace halfslope
