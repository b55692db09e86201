#include "analysis/line_chart.h"

#include <gmock/gmock.h>

#include <cmath>

#include "analysis/palette.h"

namespace halfslope {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::FieldsAre;
using ::testing::IsEmpty;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

LineChart curve(std::vector<ChartPoint> points, double y_most = 4) {
  LineChart chart{"", "g", {}, {{"a", "a", "", 0, std::move(points)}}};
  chart.style.log_x = chart.style.log_y = false;
  chart.style.intervals = Intervals::kBands;
  chart.style.y_least = 0;
  chart.style.y_most = y_most;
  return chart;
}

/// What the lines of the chart's looks are, in values.
std::vector<std::vector<Position>> drawn_lines(const LineChart& chart, bool polygons = false) {
  const std::vector<LineChart> charts = {chart};
  const auto scales = chart_scales(charts, chart.group);
  const Axes axes{{10, 20}, 300, 200, scales->x, scales->y};
  Canvas canvas(400, 300);
  draw_chart(canvas, axes, scales->x_above, chart);
  std::vector<std::vector<Position>> lines;
  for (const Canvas::Element& element : canvas.elements()) {
    const auto* path = std::get_if<Canvas::Path>(&element);
    if (!path || path->closed != polygons) continue;
    if (polygons ? path->paint.fill != looks()[0].ink
                 : !path->paint.stroke || path->paint.stroke->ink != looks()[0].ink)
      continue;
    std::vector<Position>& line = lines.emplace_back();
    for (const Position& p : path->points) {
      const double along = (p.x - 10) / 300, up = 1 - (p.y - 20) / 200;
      line.push_back({axes.x.scale.lo + along * (axes.x.scale.hi - axes.x.scale.lo),
                      axes.y.scale.lo + up * (axes.y.scale.hi - axes.y.scale.lo)});
    }
  }
  return lines;
}

auto at(double x, double y) { return FieldsAre(DoubleNear(x, 1e-9), DoubleNear(y, 1e-9)); }

TEST(LineChart, LinesAreCutWhereTheyLeaveTheFrame) {
  // Up through 4 at x = 2, down again at x = 4, and once from outside to outside.
  const auto lines = drawn_lines(curve({{1, 2}, {3, 6}, {5, 2}, {6, 8}, {7, 9}, {8, 3}}));
  EXPECT_THAT(lines, ElementsAre(ElementsAre(at(1, 2), at(2, 4)), ElementsAre(at(4, 4), at(5, 2), at(5 + 1.0 / 3, 4)),
                                 ElementsAre(at(7 + 5.0 / 6, 4), at(8, 3))));
}

TEST(LineChart, ValuesThatAreNotFiniteAreGaps) {
  EXPECT_THAT(drawn_lines(curve({{0, 1}, {1, 2}, {2, kNaN}, {3, 2}, {4, -std::numeric_limits<double>::infinity()}})),
              ElementsAre(ElementsAre(at(0, 1), at(1, 2))));
  EXPECT_THAT(drawn_lines(curve({{0, 1}, {1, 2}, {2, kNaN}, {3, 2}, {4, 1}, {5, 3}})),
              ElementsAre(ElementsAre(at(0, 1), at(1, 2)), ElementsAre(at(3, 2), at(4, 1), at(5, 3))));
}

TEST(LineChart, BandsGoFromEndToEndAndKeepToTheFrame) {
  const auto bands = drawn_lines(curve({{0, 1, 0.5, 1.5}, {1, 3, 2.5, 9}, {2, 1}, {3, 2, 1, 3}, {4, 2, 1.5, 3}}), true);
  EXPECT_THAT(bands, ElementsAre(ElementsAre(at(0, 1.5), at(1, 4), at(1, 2.5), at(0, 0.5)),
                                 ElementsAre(at(3, 3), at(4, 3), at(4, 1.5), at(3, 1))));
}

TEST(LineChart, ScalesHoldEveryPointOfTheGroup) {
  LineChart first{"", "g", {}, {{"a", "a", "", 0, {{16, 0.5, 0.001, 100.0}, {64, 0.25}, {256, 0}}}}};
  LineChart second = first, other = first;
  second.lines[0].points = {{1024, 0.02}};
  other.group = "h";
  other.lines[0].points = {{1e6, 1e-9}};
  const std::vector<LineChart> charts = {first, second, other};
  const auto scales = chart_scales(charts, "g");
  ASSERT_TRUE(scales);
  for (const double x : {16.0, 1024.0}) EXPECT_TRUE(scales->x.scale.fraction(x) > 0 && scales->x.scale.fraction(x) < 1);
  for (const double y : {0.5, 0.02}) EXPECT_TRUE(scales->y.scale.fraction(y) > 0 && scales->y.scale.fraction(y) < 1);
  EXPECT_LT(scales->x.scale.hi, 2048);
  // An interval that knows nothing reaches a factor of 4 beyond the points, and the scale half of that more.
  EXPECT_NEAR(scales->y.scale.lo, 0.02 / 4 / 1.5, 0.0005);
  EXPECT_NEAR(scales->y.scale.hi, 0.5 * 4 * 1.5, 0.1);
  EXPECT_FALSE(chart_scales(charts, "none"));
  first.lines[0].points = {{16, 0}, {64, kNaN}};
  EXPECT_FALSE(chart_scales(std::vector{first}, "g"));
}

TEST(LineChart, TheScaleAboveIsThatBelowInAnotherUnit) {
  LineChart chart = curve({{0, 1}, {96, 2}});
  chart.style.x_above_label = "f/√N";
  chart.style.x_above_unit = 32;
  const auto scales = chart_scales(std::vector{chart}, "g");
  ASSERT_TRUE(scales && scales->x_above);
  EXPECT_EQ(scales->x_above->scale.fraction(1), scales->x.scale.fraction(32));
  EXPECT_THAT(scales->x_above->ticks, Not(IsEmpty()));
}

TEST(LineChart, SlopesHaveTheirIntervals) {
  EXPECT_EQ(slope_note(-0.504, Interval{-0.617, -0.4}), "−0.50 [−0.62, −0.40]");
  EXPECT_EQ(slope_note(0.25, std::nullopt), "0.25");
  EXPECT_EQ(slope_note(-0.504, Interval{-0.617, -0.4}, "~", "*"), "−0.50 ~[−0.62, −0.40]*");
}

TEST(LineChart, WithoutPointsHasNoGuidesThatNobodyCouldDraw) {
  LineChart full{"", "g", {}, {{"a", "a", "", 0, {{4, 0.5}, {64, 0.1}}}}}, empty{"", "g", {}, {{"b", "b", "", 1, {}}}};
  full.style.slopes = empty.style.slopes = {-0.5, -1};
  const std::vector<LineChart> charts = {full, empty};
  const auto scales = chart_scales(charts, "g");
  Canvas canvas(400, 300);
  draw_chart(canvas, {{10, 20}, 300, 200, scales->x, scales->y}, {}, empty);
  for (const Canvas::Element& element : canvas.elements()) {
    const auto* path = std::get_if<Canvas::Path>(&element);
    if (!path) continue;
    for (const Position& p : path->points) EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
  }
}

}  // namespace
}  // namespace halfslope
