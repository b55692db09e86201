#include "analysis/stopping.h"

#include <gmock/gmock.h>

#include <cmath>

#include "analysis/coverage_stopping.h"
#include "analysis/status.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;

TEST(ReplicateSchedule, DoublesFrom64ToTheMost) {
  EXPECT_THAT(replicate_schedule(1024), ElementsAre(64, 128, 256, 512, 1024));
  EXPECT_THAT(replicate_schedule(1000), ElementsAre(64, 128, 256, 512, 1000));
  EXPECT_THAT(replicate_schedule(65), ElementsAre(64, 65));
  EXPECT_THAT(replicate_schedule(64), ElementsAre(64));
  EXPECT_THAT(replicate_schedule(1), ElementsAre(1));
  EXPECT_EQ(replicate_schedule(std::int64_t{1} << 31).size(), 26u);
}

TEST(ReplicateSchedule, CutsADoublingIntoEqualPartsThatKernelsFill) {
  EXPECT_THAT(replicate_schedule(1100, 4),
              ElementsAre(64, 128, 192, 256, 320, 384, 448, 512, 640, 768, 896, 1024, 1100));
  // A longer schedule begins as a shorter one does, so a larger maximum takes the same steps.
  const auto few = replicate_schedule(512, 4), many = replicate_schedule(std::int64_t{1} << 20, 4);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
  for (std::size_t i = 1; i < many.size(); ++i) EXPECT_EQ((many[i] - many[i - 1]) % 64, 0);
}

TEST(Status, HasWholeMarksOnly) {
  EXPECT_TRUE(has_mark("heavy-tailed", "heavy-tailed"));
  EXPECT_TRUE(has_mark("few-replicates;heavy-tailed;invalid", "heavy-tailed"));
  EXPECT_TRUE(has_mark("few-replicates;invalid", "invalid"));
  EXPECT_FALSE(has_mark("few-replicates;invalid", "replicates"));
  EXPECT_FALSE(has_mark("ok", "invalid"));
  EXPECT_FALSE(has_mark("", "invalid"));
}

CellStatistics cell(double lo, double rmse, double hi, const char* status = "ok") {
  CellStatistics statistics;
  statistics.rmse_lo = lo;
  statistics.rmse = rmse;
  statistics.rmse_hi = hi;
  statistics.status = status;
  return statistics;
}

TEST(TargetState, IsReachedWhereBothEndsAreNear) {
  EXPECT_EQ(target_state(cell(1.92, 2, 2.099), 0.05), TargetState::kReached);
  EXPECT_EQ(target_state(cell(1.92, 2, 2.101), 0.05), TargetState::kOpen);
  EXPECT_EQ(target_state(cell(2 / 1.0501, 2, 2.05), 0.05), TargetState::kOpen);
  EXPECT_EQ(target_state(cell(1.9, 2, 2.1, "reference-limited"), 0.1), TargetState::kReached);
  EXPECT_DOUBLE_EQ(*log_half_width(cell(1, 2, 3)), std::log(2));
  EXPECT_DOUBLE_EQ(*log_half_width(cell(1.5, 2, 3)), std::log(1.5));
}

TEST(TargetState, IsNeverReachedWhereTheIntervalIsNotCertifiedOrMissing) {
  for (const char* status : {"heavy-tailed", "few-replicates", "heavy-tailed;reference-limited"})
    EXPECT_EQ(target_state(cell(1.99, 2, 2.01, status), 0.05), TargetState::kOpen) << status;
  CellStatistics without = cell(1.99, 2, 2.01, "reference-limited");
  without.rmse_lo.reset();
  EXPECT_EQ(target_state(without, 0.05), TargetState::kOpen);
  EXPECT_EQ(log_half_width(without), std::nullopt);
}

TEST(TargetState, IsNoneWhereNoReplicateCouldNarrowAnything) {
  for (const char* status : {"exact", "deterministic", "infinite-variance;heavy-tailed"})
    EXPECT_EQ(target_state(cell(1.99, 2, 2.01, status), 0.05), TargetState::kNone) << status;
  CellStatistics invalid = cell(1, 2, 3, "invalid");
  invalid.invalid = true;
  EXPECT_EQ(target_state(invalid, 0.05), TargetState::kNone);
}

// z²/(2 log²1.05) by hand: 3.8415 / (2 · 0.0023805) = 806.9; and back: what that many leave is the target.
TEST(GaussianReplicates, AreThoseOfTheNormalApproximation) {
  EXPECT_NEAR(gaussian_replicates(0.05), 806.9, 0.1);
  EXPECT_NEAR(gaussian_replicates(0.10), 211.4, 0.1);
  EXPECT_NEAR(expected_replicates(64, std::log(1.2), 0.05), 64 * std::pow(std::log(1.2) / std::log(1.05), 2), 1e-9);
  EXPECT_NEAR(expected_replicates(200, std::log(1.05), 0.05), 200, 1e-9);
}

// 93 to 96 % where runs of Gaussian errors stop themselves; a share of 2000 runs (600 of images) is within five
// standard errors of its expectation but with probability 6e-7. What stops is near what one integral needs, 211 of 256
// at ±10 %, and an image of 16 independent pixels needs a sixteenth.
TEST(StoppingCoverage, OfGaussianErrorsIsThatOfTheInterval) {
  const CoverageRow one = stopping_coverage(gaussian_errors(), 1, 0.10, {.runs = 2000});
  EXPECT_EQ(one.runs, 2000);
  EXPECT_GT(one.coverage(), 0.93 - 5 * std::sqrt(0.93 * 0.07 / 2000));
  EXPECT_LT(one.coverage(), 0.96 + 5 * std::sqrt(0.96 * 0.04 / 2000));
  EXPECT_GE(one.replicates, 211);
  EXPECT_LE(one.replicates, 2 * 256);
  EXPECT_EQ(one.marked, 0);
  EXPECT_LE(one.width, 2 * std::log(1.1));

  const CoverageRow image = stopping_coverage(gaussian_errors(), 16, 0.05, {.runs = 600});
  EXPECT_GT(image.coverage(), 0.93 - 5 * std::sqrt(0.93 * 0.07 / 600));
  EXPECT_LT(image.coverage(), 0.96 + 5 * std::sqrt(0.96 * 0.04 / 600));
  EXPECT_GE(image.replicates, kFirstStage);
  EXPECT_LE(image.replicates, 2 * 64);
}

TEST(StoppingCoverage, DoesNotDependOnThreads) {
  const CoverageRow one = stopping_coverage(gaussian_errors(), 2, 0.15, {.runs = 60, .seed = 5, .threads = 1});
  const CoverageRow many = stopping_coverage(gaussian_errors(), 2, 0.15, {.runs = 60, .seed = 5, .threads = 3});
  EXPECT_EQ(one.covered, many.covered);
  EXPECT_EQ(one.replicates, many.replicates);
  EXPECT_EQ(one.width, many.width);
}

// Errors of a lognormal integrand have a kurtosis of 10^4: hardly any run of them may pass for certified at ±20 %, for
// which Gaussian ones need 58 replicates. (At 4096 replicates the mark asks for a kurtosis above 102.)
TEST(StoppingCoverage, HeavyTailsDoNotStopEarly) {
  const CoverageRow row = stopping_coverage(lognormal_errors(1.5), 1, 0.2, {.runs = 50});
  EXPECT_GT(row.replicates, 3000);
  EXPECT_GT(row.marked, 0.5);
}

}  // namespace
}  // namespace halfslope
