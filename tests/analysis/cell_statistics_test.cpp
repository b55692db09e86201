#include "analysis/cell_statistics.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/analysis/cell_data_builder.h"

namespace halfslope {
namespace {

using Matrix = std::vector<std::vector<double>>;

/// Estimates that are normal about reference[p] + bias, with a standard deviation of 0.1 (p + 1).
Matrix normal_estimates(std::size_t replicates, const std::vector<double>& reference, double bias, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Matrix estimates(replicates, reference);
  for (std::vector<double>& image : estimates) {
    for (std::size_t p = 0; p < image.size(); ++p) {
      image[p] += bias + 0.1 * static_cast<double>(p + 1) * normal(random);
    }
  }
  return estimates;
}

const std::vector<double> kReference = {0.5, 1.0, 2.0, 0.25, 4.0};
const std::vector<double> kExact(5, 0.0);

TEST(Summarise, ASmallCellByHand) {
  // Two replicates of two integrals, errors (1, −2) and (3, 2).
  const CellStatistics row = summarise(build_cell({{2, 0}, {4, 4}}, {1, 2}, {0, 0}));
  EXPECT_DOUBLE_EQ(row.mean.value(), 2.5);
  EXPECT_DOUBLE_EQ(row.reference, 1.5);
  EXPECT_DOUBLE_EQ(row.bias.value(), 1);
  EXPECT_DOUBLE_EQ(row.bias_se.value(), 1.5);          // ē = −½ and 2½, sd²/2 = 4.5/2
  EXPECT_DOUBLE_EQ(row.variance.value(), 5);           // (2 + 8)/2
  EXPECT_DOUBLE_EQ(row.rmse.value(), std::sqrt(4.5));  // (1 + 4 + 9 + 4)/4
  EXPECT_DOUBLE_EQ(row.mae.value(), 2);
  EXPECT_DOUBLE_EQ(row.relmse.value(), ((1 + 9) / 1.01 + (4 + 4) / 4.01) / 4);
  EXPECT_DOUBLE_EQ(row.kurtosis.value(), (1 + 256.0 / 16 * 1) / (1 + 16));  // m2 = 1 and 4, m4 = 1 and 16
  EXPECT_NEAR(row.median_abs_error.value(), 2, 0.011);
  EXPECT_EQ(row.status, "few-replicates");
}

TEST(Summarise, MeanSquaredErrorIsVariancePlusSquaredBias) {
  const Matrix estimates = normal_estimates(37, kReference, 0.3, 1);
  const CellStatistics row = summarise(build_cell(estimates, kReference, kExact));
  double squared_bias = 0;
  for (std::size_t p = 0; p < 5; ++p) {
    double mean_error = 0;
    for (const auto& image : estimates) mean_error += (image[p] - kReference[p]) / 37;
    squared_bias += mean_error * mean_error / 5;
  }
  EXPECT_NEAR(std::pow(row.rmse.value(), 2), 36.0 / 37 * row.variance.value() + squared_bias, 1e-14);
}

TEST(Summarise, NumbersAreThoseOfTheDistribution) {
  // 4000 replicates; each tolerance is five standard errors of its number.
  const CellStatistics row = summarise(build_cell(normal_estimates(4000, kReference, 0.02, 2), kReference, kExact));
  const double variance = 0.01 * (1 + 4 + 9 + 16 + 25) / 5;
  EXPECT_NEAR(row.bias.value(), 0.02, 5 * row.bias_se.value());
  EXPECT_NEAR(row.bias_se.value() / std::sqrt(0.55 / 25 / 4000), 1, 0.056);
  EXPECT_NEAR(row.variance.value() / variance, 1, 5 * std::sqrt(2.0 * 979 / (55 * 55) / 4000));
  EXPECT_NEAR(std::pow(row.rmse.value(), 2) / (variance + 0.0004), 1, 0.065);
  EXPECT_NEAR(row.kurtosis.value(), 3, 0.4);
  EXPECT_LT(row.rmse_lo.value(), row.rmse.value());
  EXPECT_GT(row.rmse_hi.value(), row.rmse.value());
  EXPECT_LT(row.relmse_lo.value(), row.relmse.value());
  EXPECT_GT(row.relmse_hi.value(), row.relmse.value());
  EXPECT_EQ(row.status, "ok");
}

TEST(Summarise, AboveTheKeptReplicatesTheIntervalIsTOnTheLogarithm) {
  CellData data = build_cell(normal_estimates(2000, kReference, 0, 3), kReference, kExact);
  const CellStatistics bootstrap = summarise(data);
  data.per_replicate.clear();
  const CellStatistics t = summarise(data);
  // Both estimate the same interval, and with 2000 replicates agree in the second digit of its width.
  EXPECT_NEAR((t.rmse_hi.value() - t.rmse_lo.value()) / (bootstrap.rmse_hi.value() - bootstrap.rmse_lo.value()), 1,
              0.15);
  EXPECT_DOUBLE_EQ(t.rmse_hi.value() * t.rmse_lo.value(), std::pow(t.rmse.value(), 2));
}

TEST(Summarise, TheReferencesVarianceIsCarriedAndSubtracted) {
  const CellData exact = build_cell(normal_estimates(64, kReference, 0, 4), kReference, kExact);
  CellData noisy = exact;
  noisy.reference_mse = 0.005;
  noisy.reference_relmse = 0.01;
  noisy.reference_se = 0.03;
  const CellStatistics a = summarise(exact), b = summarise(noisy);
  EXPECT_DOUBLE_EQ(std::pow(b.rmse.value(), 2), std::pow(a.rmse.value(), 2) - 0.005);
  EXPECT_DOUBLE_EQ(std::pow(b.rmse_lo.value(), 2), std::pow(a.rmse_lo.value(), 2) - 0.005);
  EXPECT_DOUBLE_EQ(std::pow(b.rmse_hi.value(), 2), std::pow(a.rmse_hi.value(), 2) - 0.005);
  EXPECT_DOUBLE_EQ(b.relmse.value(), a.relmse.value() - 0.01);
  EXPECT_DOUBLE_EQ(b.relmse_hi.value(), a.relmse_hi.value() - 0.01);
  EXPECT_DOUBLE_EQ(b.bias_se.value(), std::hypot(a.bias_se.value(), 0.03));
  EXPECT_EQ(b.mae, a.mae);
  EXPECT_EQ(b.status, "ok");
}

TEST(Summarise, AReferenceThatLimitsIsMarkedAndItsRootNeverClamped) {
  CellData data = build_cell(normal_estimates(64, kReference, 0, 5), kReference, kExact);
  const double mse = data.mse.mean;
  data.reference_mse = 0.09 * mse;
  EXPECT_EQ(summarise(data).status, "ok");
  data.reference_mse = 0.11 * mse;
  EXPECT_EQ(summarise(data).status, "reference-limited");
  EXPECT_TRUE(summarise(data).rmse);
  data.reference_mse = 0.95 * mse;  // within the interval: the upper end alone is known
  EXPECT_TRUE(summarise(data).rmse_hi);
  EXPECT_FALSE(summarise(data).rmse_lo);
  for (const double share : {1.0, 1.5}) {
    data.reference_mse = share * mse;
    const CellStatistics row = summarise(data);
    EXPECT_FALSE(row.rmse || row.rmse_lo || row.rmse_hi);
    EXPECT_EQ(row.status, "reference-limited");
  }
}

TEST(Summarise, ADeterministicCellHasNoSpread) {
  CellData data = build_cell({{0.6, 1, 2, 0.25, 4}}, kReference, kExact);
  data.reference_se = 0.01;
  CellStatistics row = summarise(data);
  EXPECT_NEAR(row.rmse.value(), std::sqrt(0.01 / 5), 1e-15);
  EXPECT_FALSE(row.variance || row.kurtosis || row.rmse_lo || row.rmse_hi || row.relmse_lo || row.relmse_hi);
  EXPECT_FALSE(row.bias_se);  // one replicate of a randomised sampler says nothing about the others
  EXPECT_EQ(row.status, "deterministic");
  data.deterministic = true;
  row = summarise(data);
  EXPECT_EQ(row.bias_se.value(), 0.01);
  EXPECT_EQ(row.status, "deterministic");
}

TEST(Summarise, ExactEstimatesHaveErrorZeroAndNoInterval) {
  const CellStatistics row = summarise(build_cell(Matrix(32, kReference), kReference, kExact));
  EXPECT_EQ(row.rmse.value(), 0);
  EXPECT_EQ(row.relmse.value(), 0);
  EXPECT_EQ(row.median_abs_error.value(), 0);
  EXPECT_NEAR(row.variance.value(), 0, 1e-30);
  EXPECT_FALSE(row.rmse_lo || row.rmse_hi);
  EXPECT_EQ(row.status, "exact");
}

TEST(Summarise, ReplicatesThatAllErrAlikeAreMarked) {
  // A light that no sample met: every estimate is 0, and the error is the whole value.
  const CellStatistics unseen =
      summarise(build_cell(std::vector<std::vector<double>>(64, {0, 0}), {0.25, 0.5}, {0, 0}));
  EXPECT_EQ(unseen.status, "no-spread");
  EXPECT_DOUBLE_EQ(*unseen.rmse, std::sqrt((0.0625 + 0.25) / 2));
  EXPECT_FALSE(unseen.rmse_lo || unseen.rmse_hi);
  std::vector<std::vector<double>> once(64, {0, 0});
  once[7][0] = 30;
  EXPECT_EQ(summarise(build_cell(once, {0.25, 0.5}, {0, 0})).status.find("no-spread"), std::string::npos);
}

TEST(Summarise, HeavyTailsAndFewReplicatesAreMarked) {
  // One replicate in 200 errs by 1: the kurtosis of such a two-point distribution is 1/(q(1 − q)) − 3, q = 1/200.
  Matrix estimates(200, kReference);
  for (double& value : estimates[17]) value += 1;
  CellStatistics row = summarise(build_cell(estimates, kReference, kExact));
  EXPECT_NEAR(row.kurtosis.value(), 200.0 * 200 / 199 - 3, 1e-9);
  EXPECT_EQ(row.status, "heavy-tailed");
  EXPECT_FALSE(row.rmse_hi);  // 37 % of the resamples have no error at all
  row = summarise(build_cell(normal_estimates(15, kReference, 0, 6), kReference, kExact));
  EXPECT_EQ(row.status, "few-replicates");
  EXPECT_TRUE(row.rmse_hi);
}

TEST(Summarise, NonFiniteEstimatesMakeTheCellInvalidAndItsNumbersEmpty) {
  for (const double bad : {NAN, INFINITY}) {
    Matrix estimates = normal_estimates(20, kReference, 0, 7);
    estimates[3][2] = bad;
    const CellStatistics row = summarise(build_cell(estimates, kReference, kExact));
    EXPECT_EQ(row.status, "invalid");
    EXPECT_EQ(row.nonfinite, 1);
    EXPECT_FALSE(row.mean || row.bias || row.bias_se || row.variance || row.rmse || row.rmse_lo || row.rmse_hi ||
                 row.mae || row.relmse || row.kurtosis);
    EXPECT_TRUE(row.median_abs_error);  // of the others, the bad one counted as the largest
  }
}

// Squared errors without an expectation are not reported; what has one is.
TEST(CellStatistics, InfiniteVarianceLeavesOnlyWhatExists) {
  CellData data = build_cell(normal_estimates(64, kReference, 0.1, 8), kReference, kExact);
  const CellStatistics before = summarise(data);
  data.infinite_variance = true;
  CellStatistics row = summarise(data);
  EXPECT_EQ(row.status, "infinite-variance");
  for (const auto& number : {row.variance, row.rmse, row.rmse_lo, row.rmse_hi, row.relmse, row.relmse_lo, row.relmse_hi,
                             row.kurtosis, row.bias_se})
    EXPECT_FALSE(number);
  EXPECT_EQ(row.mean, before.mean);
  EXPECT_EQ(row.bias, before.bias);
  EXPECT_EQ(row.mae, before.mae);
  EXPECT_EQ(row.median_abs_error, before.median_abs_error);
  EXPECT_FALSE(row.invalid);
  data.deterministic = true;
  row = summarise(data);
  EXPECT_EQ(row.status, "infinite-variance;deterministic");
  EXPECT_EQ(row.bias_se, 0.0);
  data.nonfinite = 1;
  EXPECT_EQ(summarise(data).status, "invalid;infinite-variance;deterministic");
}

}  // namespace
}  // namespace halfslope
