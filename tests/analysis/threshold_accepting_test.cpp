#include "analysis/threshold_accepting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "analysis/box_counter.h"
#include "tests/analysis/critical_grid.h"
#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

using Box = std::vector<std::uint32_t>;

std::size_t counted(const CriticalBoxes& boxes, const Box& box) {
  std::size_t points = 0;
  for (std::size_t i = 0; i < boxes.count(); ++i) {
    bool in = true;
    for (std::size_t k = 0; k < box.size(); ++k) in = in && boxes.first[k][i] <= box[k];
    points += in ? 1 : 0;
  }
  return points;
}

/// Whether a side can move, alone, to a larger excess without another point in or out.
bool movable(const CriticalBoxes& boxes, const Box& box) {
  const std::size_t points = counted(boxes, box);
  for (std::size_t k = 0; k < box.size(); ++k) {
    Box moved = box;
    if (boxes.side == Side::kFullest ? moved[k]-- == 0 : ++moved[k] == boxes.ends[k].size()) continue;
    if (counted(boxes, moved) == points) return true;
  }
  return false;
}

TEST(BoxCounter, CountsAndSnaps) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {1, 2, 63, 64, 65, 130, 1000}) {
    for (const std::uint64_t grid : {0, 3, 40}) {
      for (const Side side : {Side::kFullest, Side::kEmptiest}) {
        const Columns points = random_points(count, 1 + random() % 5, random, grid);
        const CriticalBoxes boxes(view(points), side);
        BoxCounter counter(boxes);
        for (int trial = 0; trial < 30; ++trial) {
          Box box, order(boxes.dims());
          for (const auto& ends : boxes.ends) box.push_back(static_cast<std::uint32_t>(random() % ends.size()));
          std::iota(order.begin(), order.end(), 0u);
          std::shuffle(order.begin(), order.end(), random);
          const std::size_t expected = counted(boxes, box);
          ASSERT_EQ(counter.points(box), expected);
          const double before = boxes.excess(box, expected);
          ASSERT_EQ(counter.snap(box, order), expected);
          ASSERT_EQ(counted(boxes, box), expected);
          ASSERT_GE(boxes.excess(box, expected), before - 1e-15);
          ASSERT_FALSE(movable(boxes, box) && !(side == Side::kFullest && expected == 0));
        }
      }
    }
  }
}

double walked(const Columns& points, std::size_t steps) {
  double best = 0;
  for (const Side side : {Side::kFullest, Side::kEmptiest}) {
    best = std::max(best, threshold_accepting(CriticalBoxes(view(points), side), steps));
  }
  return best;
}

TEST(ThresholdAccepting, IsNeverAboveAndOnFewPointsFindsTheWorst) {
  std::mt19937_64 random(2);
  int found = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Columns points = random_points(1 + random() % 9, 2 + random() % 3, random, trial % 2 == 0 ? 0 : 5);
    const double star = critical_grid(points), walk = walked(points, 1000);
    EXPECT_LE(walk, star + 1e-15);
    found += walk >= star - 1e-15 ? 1 : 0;
  }
  EXPECT_GE(found, 95);
}

TEST(ThresholdAccepting, TheSamePointsGiveTheSameBits) {
  const Columns points = halton(0, 100, 6);
  EXPECT_EQ(walked(points, 500), walked(points, 500));
  EXPECT_GT(walked(points, 500), 0.05);
}

}  // namespace
}  // namespace halfslope
