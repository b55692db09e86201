#include "analysis/coverage.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "analysis/coverage_intervals.h"

namespace halfslope {
namespace {

CoverageRow row_with(std::int64_t runs, double coverage, double least, double most) {
  CoverageRow row;
  row.runs = runs;
  row.covered = std::llround(coverage * static_cast<double>(runs));
  row.coverage_least = least;
  row.coverage_most = most;
  return row;
}

TEST(Promise, IsStrictAtTwentyThousandRunsAndWiderWithFewer) {
  EXPECT_TRUE(keeps_promise(row_with(20000, 0.9351, 0.935, 0.965)));
  EXPECT_FALSE(keeps_promise(row_with(20000, 0.9349, 0.935, 0.965)));
  EXPECT_FALSE(keeps_promise(row_with(20000, 0.9651, 0.935, 0.965)));
  // 5 · √(0.935 · 0.065) · (1/√4000 − 1/√20000) = 0.0108
  EXPECT_TRUE(keeps_promise(row_with(4000, 0.925, 0.935, 0.965)));
  EXPECT_FALSE(keeps_promise(row_with(4000, 0.923, 0.935, 0.965)));
  EXPECT_FALSE(keeps_promise(row_with(1000000, 0.934, 0.935, 0.965)));
  EXPECT_TRUE(keeps_promise(row_with(4000, 0.1, 0, 1)));
  CoverageRow marked = row_with(20000, 0.95, 0, 1);
  marked.marked = 0.03;
  EXPECT_FALSE(marked.promises());
  marked.marked_most = 0.02;
  EXPECT_TRUE(marked.promises());
  EXPECT_FALSE(keeps_promise(marked));
}

// The short form of what `selfcheck coverage` measures with 20 000 runs. Where the coverage is 95 % a share of 4000
// runs is outside [92.5 %, 97.5 %] with a probability of 1e-12.
class GaussianCoverage : public testing::TestWithParam<std::int64_t> {};
TEST_P(GaussianCoverage, OfTheDefaultAndOfTheMean) {
  const IntervalMethod methods[] = {IntervalMethod::kBootstrapT, IntervalMethod::kReciprocalT};
  for (const CoverageRow& row : measure_intervals({"Gaussian", gaussian_errors()}, GetParam(), methods, {4000, 2})) {
    EXPECT_GE(row.coverage(), 0.925) << row.number << " " << row.method;
    EXPECT_LE(row.coverage(), 0.975) << row.number << " " << row.method;
  }
}
INSTANTIATE_TEST_SUITE_P(Replicates, GaussianCoverage, testing::Values(16, 64, 256));

TEST(Coverage, TheDegreesOfFreedomOfAnImageAreItsPixelsToo) {
  // 64 normal pixels by 64 replicates: 4096 degrees of freedom, so log MSE has the standard error √(2/4096), and the
  // interval of the RMSE the width 1.96 times that. Measured to 1 % by 500 runs; the plain 64 would give 8 times it.
  const IntervalMethod methods[] = {IntervalMethod::kChi2};
  const auto rows =
      measure_intervals({"image", gaussian_errors(), std::vector<double>(64, 1.0)}, 64, methods, {500, 3});
  EXPECT_NEAR(rows[0].width / (1.96 * std::sqrt(2.0 / 4096)), 1, 0.05);
}

TEST(Coverage, DependsOnTheSeedAndNotOnThreads) {
  const IntervalMethod methods[] = {IntervalMethod::kBca};
  const ErrorImages images = {"Laplace", laplace_errors()};
  const auto one = measure_intervals(images, 16, methods, {300, 5, 1}),
             three = measure_intervals(images, 16, methods, {300, 5, 3}),
             other = measure_intervals(images, 16, methods, {300, 6, 1});
  EXPECT_EQ(one[0].covered, three[0].covered);
  EXPECT_EQ(one[0].width, three[0].width);
  EXPECT_EQ(one[0].marked, three[0].marked);
  EXPECT_NE(one[0].width, other[0].width);
}

TEST(Coverage, IsStoppedByItsProgress) {
  std::atomic<double> told = 0;
  CoverageRequest request = {1000, 1, 2, [&](double share) { return (told += share) < 0.1; }};
  std::atomic<int> runs = 0;
  EXPECT_FALSE(for_each_run(request, 1, [&](std::int64_t) { ++runs; }));
  EXPECT_LT(runs, 1000);
  request.progress = [&](double share) { return told += share, true; };
  told = 0;
  runs = 0;
  EXPECT_TRUE(for_each_run(request, 0.5, [&](std::int64_t) { ++runs; }));
  EXPECT_EQ(runs, 1000);
  EXPECT_NEAR(told, 0.5, 1e-12);
}

TEST(ErrorLaws, HaveTheMomentsTheyState) {
  for (const ErrorLaw& law : {gaussian_errors(), uniform_errors(), laplace_errors(), lognormal_errors(0.5),
                              mean_errors(lognormal_errors(0.5), 16)}) {
    RunRandom random(3, 1, 2);
    double sum = 0, squares = 0, fourths = 0;
    constexpr int kDraws = 200000;
    for (int i = 0; i < kDraws; ++i) {
      const double square = std::pow(law.draw(random), 2);
      squares += square;
      fourths += square * square;
    }
    RunRandom again(4, 1, 2);
    for (int i = 0; i < kDraws; ++i) sum += law.draw(again);
    EXPECT_NEAR(sum / kDraws, 0, 5.5 * std::sqrt(law.variance / kDraws)) << law.name;
    const double spread = std::sqrt(fourths / kDraws - std::pow(squares / kDraws, 2));
    EXPECT_NEAR(squares / kDraws, law.variance, 5.5 * spread / std::sqrt(kDraws)) << law.name;
  }
}

}  // namespace
}  // namespace halfslope
