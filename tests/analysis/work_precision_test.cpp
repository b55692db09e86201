#include "analysis/work_precision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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
  EXPECT_EQ(WorkCurve({}).error_after(1).reach, Reach::kUnknown);
  EXPECT_EQ(WorkCurve({}).time_until(1).reach, Reach::kUnknown);
}

/// A line of falling errors, not on any law.
std::vector<WorkPoint> falling_line(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.1, 1);
  std::vector<WorkPoint> points;
  double seconds = 1e-6 * uniform(random), rmse = uniform(random);
  for (double n = 4; n <= 1024; n *= 2) {
    points.push_back({n, within(seconds, uniform(random)), within(rmse, uniform(random))});
    seconds *= 1 + uniform(random), rmse *= uniform(random) * 0.999;
  }
  return points;
}

// A line reaches its own errors in its own times, to the last bit: exp(log x) is not x.
TEST(WorkCurve, MeetsEachOfItsPointsExactly) {
  std::mt19937_64 random(1);
  for (int line = 0; line < 100; ++line) {
    const std::vector<WorkPoint> points = falling_line(random);
    const WorkCurve curve(points);
    for (const WorkPoint& point : points) {
      const WorkAnswer error = curve.error_after(point.seconds.value), time = curve.time_until(point.rmse.value);
      ASSERT_EQ(error.reach, Reach::kInside);
      ASSERT_EQ(time.reach, Reach::kInside);
      EXPECT_EQ(error.value.value, point.rmse.value);
      EXPECT_EQ(time.value.value, point.seconds.value);
      EXPECT_EQ(error.samples, point.samples);
      EXPECT_EQ(time.samples, point.samples);
    }
  }
}

// However near to a point, what is read off does not leave the neighbours, so it is reached where it was read.
TEST(WorkCurve, ReadsNothingOffBeyondTheNeighbours) {
  std::mt19937_64 random(2);
  for (int line = 0; line < 100; ++line) {
    const std::vector<WorkPoint> points = falling_line(random);
    const WorkCurve curve(points);
    for (std::size_t k = 1; k < points.size(); ++k) {
      const double a = points[k - 1].seconds.value, b = points[k].seconds.value;
      for (const double seconds : {std::nextafter(a, b), std::sqrt(a * b), std::nextafter(b, a)}) {
        const WorkAnswer error = curve.error_after(seconds);
        EXPECT_LE(error.value.value, points[k - 1].rmse.value);
        EXPECT_GE(error.value.value, points[k].rmse.value);
        EXPECT_GE(error.samples, points[k - 1].samples);
        EXPECT_LE(error.samples, points[k].samples);
        EXPECT_EQ(curve.time_until(error.value.value).reach, Reach::kInside);
      }
    }
  }
}

TEST(WorkCurve, NoErrorIsReachedAsSoonAsItIsMeasured) {
  const WorkCurve exact({{4, {4}, {0}}, {16, {16}, {0}}});
  EXPECT_EQ(exact.error_after(3).reach, Reach::kBelow);  // its smallest N takes longer
  for (const double seconds : {4, 9, 16, 99}) EXPECT_EQ(exact.error_after(seconds).reach, Reach::kExact);
  for (const double rmse : {1e-300, 1.0}) EXPECT_EQ(exact.time_until(rmse).reach, Reach::kExact);
  const WorkCurve later({{4, within(4, 0.2), within(2, 0.1)}, {16, within(16, 0.2), within(1, 0.1)}, {64, {64}, {0}}});
  EXPECT_EQ(later.error_after(8).reach, Reach::kInside);
  EXPECT_EQ(later.error_after(16).value.value, 1);
  EXPECT_EQ(later.error_after(17).reach, Reach::kExact);
  EXPECT_EQ(later.time_until(1).value.value, 16);
  EXPECT_EQ(later.time_until(0.9).reach, Reach::kExact);
  const WorkCurve at_once({{4, within(4, 0.2), within(2, 0.1)}, {16, {16}, {0}}});
  EXPECT_NEAR(*at_once.error_after(4).value.log_above(), 0.1, 1e-12);  // no slope is known
  EXPECT_NEAR(*at_once.time_until(2).value.log_above(), 0.2, 1e-12);
}

// The errors of a flat line hardly say when they are reached: an end a million times off says nothing.
TEST(WorkCurve, EndsThatSayNothingAreEmpty) {
  const WorkCurve flat({{4, within(4, 0.1), within(1, 0.5)}, {16, within(16, 0.1), within(0.99, 0.5)}});
  const WorkAnswer answer = flat.time_until(0.995);
  ASSERT_EQ(answer.reach, Reach::kInside);
  EXPECT_FALSE(answer.value.lo || answer.value.hi);  // 0.5 · log 4/log(1/0.99) = 69, and log 10⁶ = 13.8
  const WorkCurve level({{4, within(4, 0.1), within(1, 0.5)}, {16, within(16, 0.1), within(1, 0.5)}});
  EXPECT_EQ(level.time_until(1).value.value, 4);
  EXPECT_FALSE(level.time_until(1).value.lo || level.time_until(1).value.hi);
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
  const WorkCurve few({{1, {1}, {8}}, {4, {4}, {2}, true, false}});
  EXPECT_TRUE(few.error_after(1).covered);
  EXPECT_FALSE(few.error_after(2).covered || few.time_until(2).covered);
  EXPECT_NEAR(*curve.error_after(4).value.log_above(), std::hypot(0.1, 0.1), 1e-12);  // slope −1
}

}  // namespace
}  // namespace halfslope
