#include "analysis/power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "analysis/normal.h"

namespace halfslope {
namespace {

TEST(InfluenceSpread, IsTheDeviationAndItsOwnError) {
  const std::vector<double> values = {-1, 1, -1, 1, -1, 1, -1, 1};  // kurtosis 1: the deviation is certain
  EXPECT_NEAR(influence_spread(values).deviation, std::sqrt(8.0 / 7), 1e-14);
  EXPECT_NEAR(influence_spread(values).log_error, 0, 1e-14);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> normals(100000);
  for (double& value : normals) value = normal(random);
  // ½ √((3 − 1)/n), the textbook's 1/√(2n); the sample kurtosis has a standard error of √(24/n) = 0.0155.
  EXPECT_NEAR(influence_spread(normals).log_error * std::sqrt(2.0 * 100000), 1, 5 * 0.0155 / 4);
}

TEST(PredictedPower, IsTheTextbooksWhereTheDeviationIsCertain) {
  // The test of a mean at 5 %: δ = z_0.975 + z_0.8 gives 80 % (and 1e-6 on the wrong side), δ = 0 the level itself.
  const InfluenceSpread spread = {2, 0};
  const double critical = normal_quantile(0.975);
  const double replicates = std::pow(2 * (critical + normal_quantile(0.8)) / 0.1, 2);
  EXPECT_NEAR(predicted_power(spread, 0.1, critical, replicates).value, 0.8, 2e-6);
  EXPECT_NEAR(predicted_power(spread, 0, critical, 50).value, 0.05, 1e-12);
  EXPECT_NEAR(predicted_replicates(spread, 0.1, critical, 0.8).value, replicates, 1e-9 * replicates);
  EXPECT_EQ(predicted_power(spread, -0.1, critical, 100).value, predicted_power(spread, 0.1, critical, 100).value);
}

TEST(PredictedPower, IsThatOfTheTruthOnAverageOverPilots) {
  // Deviations of pilots whose log has a standard error of 0.15 about a true 2 (their mean square is the true one). The
  // mean of 20 000 has a standard error below 0.002; without the correction the second is 0.02 too large.
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const double replicates : {500.0, 2000.0, 5000.0}) {
    double corrected = 0;
    for (int i = 0; i < 20000; ++i) {
      const double log_error = 0.15, deviation = 2 * std::exp(log_error * normal(random) - log_error * log_error);
      corrected += predicted_power({deviation, log_error}, std::log(1.1), 1.96, replicates).value / 20000;
    }
    EXPECT_NEAR(corrected, predicted_power({2, 0}, std::log(1.1), 1.96, replicates).value, 0.005);
  }
}

TEST(PredictedPower, TheRangeIsThatOfTheDeviation) {
  constexpr double kReach = 0.1 * kNormal975;
  const InfluenceSpread spread = {2, 0.1}, low = {2 * std::exp(-kReach), 0}, high = {2 * std::exp(kReach), 0};
  const Prediction power = predicted_power(spread, 0.1, 1.96, 2000), least = predicted_power(high, 0.1, 1.96, 2000);
  EXPECT_NEAR(power.lo, least.value, 1e-12);
  EXPECT_LT(power.lo, power.value);
  EXPECT_LT(power.value, power.hi);
  const Prediction needed = predicted_replicates(spread, 0.1, 1.96, 0.8);
  EXPECT_NEAR(needed.lo, predicted_replicates(low, 0.1, 1.96, 0.8).value, 1e-9 * needed.lo);
  EXPECT_NEAR(needed.hi / needed.lo, std::exp(4 * kReach), 1e-9);
}

}  // namespace
}  // namespace halfslope
