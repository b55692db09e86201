#include "analysis/rates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace halfslope {
namespace {

const std::vector<double> kSamples = {4, 8, 16, 32, 64, 128, 256};

/// Squared errors of the running means of independent N(0, 1) numbers: the RMSE is N^−½ exactly, and errors at
/// different N share their first samples. A prefix of N' more samples adds a normal number of variance N'.
std::vector<std::vector<double>> walks(std::size_t replicates, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<std::vector<double>> mse(kSamples.size(), std::vector<double>(replicates));
  for (std::size_t r = 0; r < replicates; ++r) {
    double sum = 0, samples = 0;
    for (std::size_t j = 0; j < kSamples.size(); ++j) {
      sum += std::sqrt(kSamples[j] - samples) * normal(random);
      samples = kSamples[j];
      mse[j][r] = std::pow(sum / samples, 2);
    }
  }
  return mse;
}

/// mse[j][r] = a_r · N_j^(2 rate), plus an offset.
std::vector<std::vector<double>> power_law(double rate, std::size_t replicates, double offset = 0) {
  std::vector<std::vector<double>> mse(kSamples.size(), std::vector<double>(replicates));
  for (std::size_t j = 0; j < kSamples.size(); ++j) {
    for (std::size_t r = 0; r < replicates; ++r) {
      mse[j][r] = (0.5 + 0.1 * static_cast<double>(r % 11)) * std::pow(kSamples[j], 2 * rate) + offset;
    }
  }
  return mse;
}

TEST(FitRate, APowerLawIsFoundExactly) {
  for (const double rate : {-0.5, -0.75, -1.0, -1.5, 0.25}) {
    const RateFit fit = fit_rate({kSamples, power_law(rate, 22)}, 1);
    ASSERT_TRUE(fit.rate);
    EXPECT_NEAR(*fit.rate, rate, 1e-14);
    EXPECT_EQ(fit.status, "ok");
    EXPECT_EQ(fit.samples_lo, 4);
    EXPECT_EQ(fit.samples_hi, 256);
  }
}

TEST(FitRate, IsOrdinaryLeastSquares) {
  // log2 RMSE is y = 0, −1, −3, −3 at log2 N = 1, 2, 3, 4, that is x = −1.5, −0.5, 0.5, 1.5 about its mean:
  // Σ x y = 0.5 − 1.5 − 4.5 = −5.5, Σ x² = 5, slope −1.1.
  const std::vector<double> samples = {2, 4, 8, 16};
  const std::vector<std::vector<double>> mse = {{1}, {0.25}, {0x1p-6}, {0x1p-6}};
  const RateFit fit = fit_rate({samples, mse}, 1);
  ASSERT_TRUE(fit.rate);
  EXPECT_NEAR(*fit.rate, -1.1, 1e-14);
  EXPECT_FALSE(fit.interval);
  EXPECT_EQ(fit.status, "deterministic");
}

TEST(FitRate, TheReferencesVarianceIsSubtracted) {
  const double reference_mse = 1e-5;  // 4 % of the smallest measured mean
  const RateFit fit = fit_rate({kSamples, power_law(-0.75, 20, reference_mse), {reference_mse, 0}}, 1);
  ASSERT_TRUE(fit.rate);
  EXPECT_NEAR(*fit.rate, -0.75, 1e-12);
}

TEST(FitRate, TheIntervalHoldsTheTruthAsOftenAsItSays) {
  // 4000 experiments of 64 prefix-dependent walks: at a coverage of 95 % outside [92.5 %, 97.5 %] in 1e-12 of all
  // seeds.
  constexpr int kExperiments = 4000;
  std::mt19937_64 random(17);
  int covered = 0;
  for (std::uint64_t i = 0; i < kExperiments; ++i) {
    const RateFit fit = fit_rate({kSamples, walks(64, random)}, i);
    covered += fit.interval && fit.interval->lo <= -0.5 && -0.5 <= fit.interval->hi;
  }
  RecordProperty("coverage", std::to_string(covered / double{kExperiments}));
  EXPECT_GE(covered, 3700);
  EXPECT_LE(covered, 3900);
}

TEST(FitRate, TheIntervalIsAFunctionOfErrorsAndSeed) {
  std::mt19937_64 random(1);
  const auto mse = walks(20, random);
  const RateFit a = fit_rate({kSamples, mse}, 5), b = fit_rate({kSamples, mse}, 5);
  ASSERT_TRUE(a.interval && b.interval && a.rate);
  EXPECT_EQ(a.interval->lo, b.interval->lo);
  EXPECT_EQ(a.interval->hi, b.interval->hi);
  EXPECT_LT(a.interval->lo, *a.rate);
  EXPECT_GT(a.interval->hi, *a.rate);
  EXPECT_NE(fit_rate({kSamples, mse}, 6).interval->lo, a.interval->lo);
}

TEST(FitRate, RefusesWhatHasNoRateAndSaysWhy) {
  const auto refusal = [](const RateData& data) {
    const RateFit fit = fit_rate(data, 1);
    EXPECT_FALSE(fit.rate || fit.interval);
    return fit.status;
  };
  EXPECT_EQ(refusal({}), "too-few-points");
  EXPECT_EQ(refusal({{16}, {{1, 2}}}), "too-few-points");

  RateData data{kSamples, power_law(-0.5, 20)};
  data.rounding_mse = 1e-3;
  EXPECT_EQ(refusal(data), "rounding-limited");
  data.rounding_mse = 0;
  data.mse[2].assign(20, 0.0);
  EXPECT_EQ(refusal(data), "exact");
  data.mse[2][4] = NAN;
  EXPECT_EQ(refusal(data), "invalid");
}

TEST(FitRate, WhatTheReferenceReachesIsRefused) {
  RateData data{kSamples, power_law(-0.5, 20)};
  double least = 0;
  for (const double mse : data.mse.back()) least += mse / 20;
  data.reference = {0.31 * least, 0};
  EXPECT_EQ(fit_rate(data, 1).status, "reference-limited");
  data.reference = {0.29 * least, 0};
  EXPECT_EQ(fit_rate(data, 1).status, "ok");
  // A single integral's reference may err by far more than its variance, and then the mean squared error is mostly
  // that: the sample variance shows it.
  data.reference = {0.1 * least, 2 * 0.01 * least * least};
  data.variance.assign(kSamples.size(), 0.2 * least);
  EXPECT_EQ(fit_rate(data, 1).status, "reference-limited");
  data.variance.assign(kSamples.size(), 0.3 * least);
  EXPECT_EQ(fit_rate(data, 1).status, "ok");
}

TEST(FitRate, ErrorsWithoutSpreadHaveNoRate) {
  const std::vector<double> samples = {4, 16, 64};
  std::vector<std::vector<double>> mse(3, std::vector<double>(64, 0.3));
  const RateFit fit = fit_rate({samples, mse}, 1);
  EXPECT_EQ(fit.status, "no-spread");
  EXPECT_FALSE(fit.rate || fit.interval);
  mse[2][5] = mse[0][7] = 0.2;
  EXPECT_EQ(fit_rate({samples, mse}, 1).status, "no-spread");  // of one N is enough
  mse[1][9] = 0.1;
  EXPECT_EQ(fit_rate({samples, mse}, 1).status, "ok");
}

TEST(FitRate, FewReplicatesAreMarkedNotRefused) {
  std::mt19937_64 random(1);
  const RateFit few = fit_rate({kSamples, walks(15, random)}, 1);
  EXPECT_EQ(few.status, "few-replicates");
  EXPECT_TRUE(few.rate && few.interval);
  EXPECT_EQ(fit_rate({kSamples, walks(16, random)}, 1).status, "ok");
}

TEST(FitRate, ARateThatRestsOnOneReplicateHasNoInterval) {
  std::vector<std::vector<double>> mse(kSamples.size(), std::vector<double>(64, 0.0));
  for (std::size_t j = 0; j < kSamples.size(); ++j) mse[j][7] = 1 / kSamples[j];
  const RateFit fit = fit_rate({kSamples, mse}, 1);
  ASSERT_TRUE(fit.rate);
  EXPECT_NEAR(*fit.rate, -0.5, 1e-14);
  EXPECT_FALSE(fit.interval);
}

TEST(FitRateDeathTest, ShapesThatDisagreeAbort) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(fit_rate({{4, 8}, power_law(-0.5, 3)}, 1), "found 7, promised 2");
  EXPECT_DEATH(fit_rate({{8, 4}, {{1, 2}, {1, 2}}}, 1), "sample counts that rise");
  auto ragged = power_law(-0.5, 3);
  ragged[5].pop_back();
  EXPECT_DEATH(fit_rate({kSamples, ragged}, 1), "found 2, promised 3");
}

}  // namespace
}  // namespace halfslope
