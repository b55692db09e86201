#include "analysis/box_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace halfslope {
namespace {

/// Boxes in a plain list, each looked at.
struct Boxes {
  std::vector<double> heights;
  std::vector<int> closed, open;
  double count;

  double value(const std::vector<int>& points, std::size_t j, double width) const {
    return points[j] - count * width * heights[j];
  }
  double fullest(double width) const {
    double best = value(closed, 0, width);
    for (std::size_t j = 1; j < heights.size(); ++j) best = std::max(best, value(closed, j, width));
    return best;
  }
  double emptiest(double width) const {
    double best = value(open, 0, width);
    for (std::size_t j = 1; j < heights.size(); ++j) best = std::min(best, value(open, j, width));
    return best;
  }
};

void sweep(std::size_t heights, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> y(heights), x(count);
  for (double& value : y) value = uniform(random);
  for (double& value : x) value = uniform(random) < 0.2 ? 0.5 : uniform(random);  // many at one width
  std::sort(y.begin(), y.end());
  std::sort(x.begin(), x.end());
  Boxes boxes = {y, std::vector<int>(heights), std::vector<int>(heights), static_cast<double>(count)};
  BoxSweep sweep(y, count);
  for (const double width : x) {
    sweep.grow(width);
    const std::size_t rank = random() % heights;
    sweep.add_point(rank);
    for (std::size_t j = rank; j < heights; ++j) ++boxes.closed[j];
    for (std::size_t j = rank + 1; j < heights; ++j) ++boxes.open[j];
    const BoxSweep::Box full = sweep.fullest(), empty = sweep.emptiest();
    const auto place = [&](double height) {
      return static_cast<std::size_t>(std::find(y.begin(), y.end(), height) - y.begin());
    };
    ASSERT_LT(place(full.height), heights);
    ASSERT_LT(place(empty.height), heights);
    ASSERT_EQ(full.points, boxes.closed[place(full.height)]);
    ASSERT_EQ(empty.points, boxes.open[place(empty.height)]);
    const double rounding = 1e-15 * static_cast<double>(count);
    ASSERT_NEAR(boxes.value(boxes.closed, place(full.height), width), boxes.fullest(width), rounding);
    ASSERT_NEAR(boxes.value(boxes.open, place(empty.height), width), boxes.emptiest(width), rounding);
  }
}

TEST(BoxSweep, KnowsTheFullestAndTheEmptiestBox) {
  for (const std::size_t heights : {1, 2, 3, 4, 5, 16, 17, 31, 100, 1000}) {
    for (const std::size_t count : {1, 10, 300, 1000}) sweep(heights, count, heights + count);
  }
}

TEST(BoxSweep, APointIsInTheClosedBoxesOfItsHeight) {
  const std::vector<double> heights = {0, 0.25, 1};
  BoxSweep sweep(heights, 4);
  sweep.grow(0.5);
  EXPECT_EQ(sweep.fullest().height, 0);  // no points: the least volume and the most
  EXPECT_EQ(sweep.emptiest().height, 1);
  sweep.add_point(1);
  EXPECT_EQ(sweep.fullest().height, 0.25);  // 1 − 4 · 0.5 · 0.25
  EXPECT_EQ(sweep.fullest().points, 1);
  EXPECT_EQ(sweep.emptiest().height, 1);  // 1 − 2, against 0 − 0.5 of the open box below the point
  sweep.add_point(1);
  EXPECT_EQ(sweep.fullest().points, 2);
  EXPECT_EQ(sweep.emptiest().height, 0.25);
  EXPECT_EQ(sweep.emptiest().points, 0);
}

}  // namespace
}  // namespace halfslope
