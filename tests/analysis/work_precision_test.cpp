#include "analysis/work_precision.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfslope {
namespace {

/// A value whose interval reaches a factor e^±h.
PositiveEstimate within(double value, double h) { return {value, value * std::exp(-h), value * std::exp(h)}; }

/// rmse = N^−½ at N = 4, 16, 64 of a microsecond each: halved errors for four times the time.
std::vector<WorkPoint> monte_carlo(double h_error, double h_time) {
  std::vector<WorkPoint> points;
  for (const double n : {64, 4, 16}) points.push_back({n, within(n * 1e-6, h_time), within(1 / std::sqrt(n), h_error)});
  return points;
}

TEST(WorkCurve, IsExactOnAPowerLaw) {
  const WorkCurve curve(monte_carlo(0.1, 0.02));
  EXPECT_EQ(curve.points().front().samples, 4);  // in order of time
  for (const double n : {4.0, 5.0, 16.0, 33.0, 64.0}) {
    const WorkAnswer error = curve.error_after(n * 1e-6);
    ASSERT_EQ(error.reach, Reach::kInside) << n;
    EXPECT_NEAR(error.value.value, 1 / std::sqrt(n), 1e-12);
    EXPECT_NEAR(error.samples, n, 1e-9);
    const WorkAnswer time = curve.time_until(1 / std::sqrt(n));
    ASSERT_EQ(time.reach, Reach::kInside) << n;
    EXPECT_NEAR(time.value.value, n * 1e-6, 1e-15);
  }
}

// One relation between error and time, so the same doubt seen from two sides: with slope −½ twice as wide in time.
TEST(WorkCurve, CarriesBothHalfWidths) {
  const WorkCurve curve(monte_carlo(0.3, 0.8));
  const double width = std::hypot(0.3, 0.5 * 0.8);  // 0.5
  const PositiveEstimate error = curve.error_after(8e-6).value;
  EXPECT_NEAR(*error.log_below(), width, 1e-12);
  EXPECT_NEAR(*error.log_above(), width, 1e-12);
  const PositiveEstimate time = curve.time_until(1 / std::sqrt(8)).value;
  EXPECT_NEAR(*time.log_below(), 2 * width, 1e-12);
  EXPECT_NEAR(*time.log_above(), 2 * width, 1e-12);
}

TEST(WorkCurve, SaysNothingBeyondWhatWasMeasured) {
  const WorkCurve curve(monte_carlo(0.1, 0.1));
  EXPECT_EQ(curve.error_after(3.9e-6).reach, Reach::kBelow);
  EXPECT_EQ(curve.error_after(64.1e-6).reach, Reach::kBeyond);
  EXPECT_EQ(curve.time_until(0.51).reach, Reach::kBelow);
  EXPECT_EQ(curve.time_until(0.124).reach, Reach::kBeyond);
  EXPECT_EQ(WorkCurve({}).error_after(1).reach, Reach::kBeyond);
  EXPECT_EQ(WorkCurve({}).time_until(1).reach, Reach::kBeyond);
}

TEST(WorkCurve, ALonePointAnswersForItself) {
  const WorkCurve curve({{4, within(2, 0.1), within(0.5, 0.3)}});
  EXPECT_EQ(curve.error_after(2).value.value, 0.5);
  EXPECT_NEAR(*curve.error_after(2).value.log_above(), 0.3, 1e-12);
  EXPECT_EQ(curve.time_until(0.5).value.value, 2);
  EXPECT_EQ(curve.error_after(1.9).reach, Reach::kBelow);
  EXPECT_EQ(curve.time_until(0.6).reach, Reach::kBelow);
}

// An error that falls, rises and falls again is small enough for good only after the second fall.
TEST(WorkCurve, TimeUntilIsThatOfTheLastFall) {
  const WorkCurve curve({{1, {1}, {8}}, {2, {2}, {2}}, {4, {4}, {4}}, {8, {8}, {1}}});
  const WorkAnswer answer = curve.time_until(2);
  ASSERT_EQ(answer.reach, Reach::kInside);
  EXPECT_NEAR(answer.value.value, 4 * std::sqrt(2), 1e-12);  // half way down from 4 to 1 on the log
}

TEST(WorkCurve, MissingEndsStayMissingAndMarksAreKept) {
  const WorkCurve curve({{1, within(1, 0.1), {8}}, {4, within(4, 0.1), within(2, 0.1), false}, {16, {16}, {1}}});
  const WorkAnswer answer = curve.error_after(2);
  EXPECT_FALSE(answer.value.lo || answer.value.hi);
  EXPECT_FALSE(answer.certified);
  EXPECT_TRUE(curve.error_after(1).certified);  // nothing of its neighbour is in it
  EXPECT_NEAR(*curve.error_after(4).value.log_above(), std::hypot(0.1, 0.1), 1e-12);  // slope −1
}

}  // namespace
}  // namespace halfslope
