#include "analysis/box_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/analysis/critical_grid.h"
#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kNoEnd = std::uint64_t{1} << 60;

/// The largest excess of both sides, searched to the end.
double searched(const Columns& points) {
  double best = 0;
  for (const Side side : {Side::kFullest, Side::kEmptiest}) {
    const CriticalBoxes boxes(view(points), side);
    std::uint64_t work = kNoEnd;
    EXPECT_TRUE(BoxSearch(boxes).run(0, best, work));
  }
  return best;
}

TEST(BoxSearch, FindsTheWorstOfAllBoxes) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t dims = 1 + random() % 6;
    const Columns points = random_points(1 + random() % (dims < 4 ? 14 : dims < 6 ? 7 : 4), dims, random);
    EXPECT_NEAR(searched(points), critical_grid(points), 1e-14) << dims << ' ' << points[0].size();
  }
}

// Equal coordinates in all or in one dimension, equal points, coordinates 0 and 1.
TEST(BoxSearch, TiesAreCountedOnTheirSideOfTheBox) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 600; ++trial) {
    const std::size_t dims = 2 + random() % 4, count = 1 + random() % (dims < 4 ? 16 : dims < 5 ? 10 : 8);
    Columns points = random_points(count, dims, random, 1 + random() % 6);
    if (trial % 3 == 0) points[random() % dims] = random_points(count, 1, random)[0];
    EXPECT_NEAR(searched(points), critical_grid(points), 1e-14) << dims << ' ' << count;
  }
}

// Volumes that vanish, or whose product does.
TEST(BoxSearch, ClusteredPoints) {
  std::mt19937_64 random(3);
  for (const double scale : {1e-300, 1e-160, 1e-17, 1e-3}) {
    for (int trial = 0; trial < 20; ++trial) {
      Columns points = random_points(12, 3, random);
      for (double& x : points[0]) x *= scale;
      EXPECT_NEAR(searched(points), critical_grid(points), 1e-14);
      for (double& x : points[1]) x *= scale;
      EXPECT_NEAR(searched(points), critical_grid(points), 1e-14);
      for (double& x : points[1]) x = 1 - x;
      EXPECT_NEAR(searched(points), critical_grid(points), 1e-14);
    }
  }
}

// Another algorithm altogether, with many more points.
TEST(BoxSearch, AgreesWithTheSweepInTwoDimensions) {
  std::mt19937_64 random(4);
  for (const std::size_t count : {100, 1000, 10000}) {
    for (const std::uint64_t grid : {0, 64}) {
      const Columns points = random_points(count, 2, random, grid);
      EXPECT_NEAR(searched(points), star_discrepancy(view(points)), 1e-14) << count;
    }
    EXPECT_NEAR(searched(halton(0, count)), star_discrepancy(view(halton(0, count))), 1e-14) << count;
    EXPECT_NEAR(searched(sobol(0, count)), star_discrepancy(view(sobol(0, count))), 1e-14) << count;
  }
}

// A dimension in which all coordinates are 0 leaves closed boxes no volume; points (x, y, 0) have D* = 1 as soon as one
// box holds them all. One in which all are 1 leaves open boxes no points.
TEST(BoxSearch, FlatPoints) {
  std::mt19937_64 random(5);
  Columns points = random_points(200, 3, random);
  std::fill(points[1].begin(), points[1].end(), 0.0);
  EXPECT_DOUBLE_EQ(searched(points), 1);
  std::fill(points[1].begin(), points[1].end(), 1.0);
  EXPECT_DOUBLE_EQ(searched(points), 1);
}

TEST(BoxSearch, AThresholdIsPassedOnlyWhereNoBoxIsAboveIt) {
  std::mt19937_64 random(6);
  const Columns points = random_points(300, 4, random);
  const double star = searched(points);
  for (const double factor : {0.5, 0.999, 1.001, 1.5, 4.0}) {
    double best = 0;
    for (const Side side : {Side::kFullest, Side::kEmptiest}) {
      const CriticalBoxes boxes(view(points), side);
      std::uint64_t work = kNoEnd;
      EXPECT_TRUE(BoxSearch(boxes).run(factor * star, best, work));
    }
    if (factor < 1) {
      EXPECT_EQ(best, star);
    } else {
      EXPECT_LE(best, star);
      EXPECT_GT(best, 0);
    }
  }
}

TEST(BoxSearch, WithoutWorkItSaysSo) {
  const CriticalBoxes boxes(view(halton(0, 200, 4)), Side::kFullest);
  BoxSearch search(boxes);
  double best = 0;
  std::uint64_t work = 10000;
  EXPECT_FALSE(search.run(0, best, work));
  EXPECT_EQ(work, 0u);
  work = kNoEnd;
  EXPECT_TRUE(search.run(0, best, work));
  EXPECT_NEAR(best, searched(halton(0, 200, 4)), 1e-15);
}

}  // namespace
}  // namespace halfslope
