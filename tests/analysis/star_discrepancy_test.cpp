#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

/// Every box that ends at coordinates of points or at 1, open and closed, each point counted anew.
double all_boxes(const Columns& columns) {
  const auto &x = columns[0], &y = columns[1];
  auto right = x, top = y;
  right.push_back(1), top.push_back(1);
  const auto n = static_cast<double>(x.size());
  double worst = 0;
  for (const double a : right) {
    for (const double b : top) {
      int closed = 0, open = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        closed += x[i] <= a && y[i] <= b;
        open += x[i] < a && y[i] < b;
      }
      worst = std::max({worst, closed / n - a * b, a * b - open / n});
    }
  }
  return worst;
}

TEST(StarDiscrepancy, IsTheWorstOfAllBoxes) {
  std::mt19937_64 random(1);
  for (std::size_t count = 1; count <= 40; ++count) {
    for (int trial = 0; trial < 8; ++trial) {
      const Columns points = random_points(count, 2, random);
      EXPECT_NEAR(star_discrepancy(view(points)), all_boxes(points), 1e-15) << count;
    }
  }
}

// Equal coordinates, equal points, coordinates 0 and 1.
TEST(StarDiscrepancy, TiesAreCountedOnTheirSideOfTheBox) {
  std::mt19937_64 random(2);
  for (std::uint64_t grid = 1; grid <= 12; ++grid) {
    for (const std::size_t count : {1, 2, 3, 5, 8, 13, 30}) {
      for (int trial = 0; trial < 6; ++trial) {
        Columns points = random_points(count, 2, random, grid);
        EXPECT_NEAR(star_discrepancy(view(points)), all_boxes(points), 1e-15) << grid << ' ' << count;
        points[0] = random_points(count, 1, random)[0];  // ties in one dimension alone
        EXPECT_NEAR(star_discrepancy(view(points)), all_boxes(points), 1e-15) << grid << ' ' << count;
      }
    }
  }
}

TEST(StarDiscrepancy, ClusteredPoints) {
  std::mt19937_64 random(3);
  for (const double scale : {1e-300, 1e-17, 1e-3}) {
    Columns points = random_points(24, 2, random);
    for (double& x : points[0]) x *= scale;
    EXPECT_NEAR(star_discrepancy(view(points)), all_boxes(points), 1e-15);
    std::swap(points[0], points[1]);
    EXPECT_NEAR(star_discrepancy(view(points)), all_boxes(points), 1e-15);
    for (double& x : points[1]) x = 1 - x;
    EXPECT_NEAR(star_discrepancy(view(points)), all_boxes(points), 1e-15);
  }
}

// One point (x, y): the box up to it holds everything or nothing; the box that grows to the far side of it is empty.
TEST(StarDiscrepancy, OfOnePoint) {
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {0.25, 0.5}, {0.9, 0.1}, {0.75, 0.75}, {1.0, 1.0}, {0.0, 0.999}}) {
    EXPECT_DOUBLE_EQ(star_discrepancy(view({{x}, {y}})), std::max({1 - x * y, x, y}));
  }
  const double golden = (std::sqrt(5.0) - 1) / 2;  // the least that one point can have, where 1 − x² = x
  EXPECT_DOUBLE_EQ(star_discrepancy(view({{golden}, {golden}})), golden);
}

// Centred k × k grid: the closed box up to the last point is short of volume, D* = 1 − (1 − 1/(2k))²; the points all at
// one place, as one point.
TEST(StarDiscrepancy, OfGridsAndCopies) {
  for (int k = 1; k <= 32; ++k) {
    Columns points(2);
    for (int i = 0; i < k * k; ++i) {
      points[0].push_back((i % k + 0.5) / k);
      points[1].push_back((i / k + 0.5) / k);
    }
    EXPECT_NEAR(star_discrepancy(view(points)), 1 - std::pow(1 - 0.5 / k, 2), 1e-15) << k;
  }
  const std::vector<double> copies(1000, 0.25);
  EXPECT_DOUBLE_EQ(star_discrepancy(view({copies, copies})), 1 - 0.0625);
}

// J. H. Halton, S. K. Zaremba, "The extreme and L2 discrepancies of some plane sets", Monatsh. Math. 73, 1969.
TEST(StarDiscrepancy, OfHammersleyPoints) {
  EXPECT_DOUBLE_EQ(star_discrepancy(view(hammersley(1))), 0.75);
  for (int m = 2; m <= 16; ++m) {
    const double n = std::ldexp(1.0, m);
    EXPECT_NEAR(n * star_discrepancy(view(hammersley(m))), m / 3.0 + 13 / 9.0 - (m % 2 == 0 ? 4 : -4) / (9 * n), 1e-9)
        << m;
  }
}

// Found by enumerating boxes, and by the algorithm of Dobkin, Eppstein and Mitchell (jakobbossek/dandy).
TEST(StarDiscrepancy, OfHaltonAndSobolPoints) {
  for (const auto& [count, star] : {std::pair(16u, 0.2013888888888889),
                                    {64u, 0.05208333333333326},
                                    {100u, 0.050239197530864144},
                                    {256u, 0.018759645061728447},
                                    {1000u, 0.006848379629629808},
                                    {1024u, 0.0068359375}}) {
    EXPECT_NEAR(star_discrepancy(view(halton(0, count))), star, 1e-12) << count;
  }
  for (const auto& [count, star] : {std::pair(8u, 0.3125),
                                    {16u, 0.171875},
                                    {32u, 0.08984375},
                                    {256u, 0.01458740234375},
                                    {512u, 0.0084075927734375},
                                    {1024u, 0.004299163818359375}}) {
    EXPECT_NEAR(star_discrepancy(view(sobol(0, count))), star, 1e-12) << count;
  }
}

TEST(StarDiscrepancy, InOneDimension) {
  for (const int n : {1, 7, 64}) {
    Columns points(1);
    for (int i = 0; i < n; ++i) points[0].push_back((n - 1 - i + 0.5) / n);
    EXPECT_NEAR(star_discrepancy(view(points)), 0.5 / n, 1e-16);
  }
  EXPECT_DOUBLE_EQ(star_discrepancy(view({{0.0}})), 1);
  EXPECT_DOUBLE_EQ(star_discrepancy(view({{0.5, 0.5, 0.5, 0.5}})), 0.5);
  // A second dimension that never matters: y = 0 for all, and boxes of height 1.
  std::mt19937_64 random(4);
  const Columns line = random_points(50, 1, random);
  std::vector<double> x = line[0];
  std::sort(x.begin(), x.end());
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto below = static_cast<double>(i) / 50;
    worst = std::max({worst, std::abs(x[i] - below), std::abs(below + 0.02 - x[i])});
  }
  EXPECT_NEAR(star_discrepancy(view(line)), worst, 1e-15);
}

TEST(StarDiscrepancy, DoesNotDependOnOrderOrSwappedAxes) {
  std::mt19937_64 random(5);
  Columns points = random_points(3000, 2, random);
  const double star = star_discrepancy(view(points));
  EXPECT_NEAR(star_discrepancy(view({points[1], points[0]})), star, 1e-15);
  std::reverse(points[0].begin(), points[0].end());
  std::reverse(points[1].begin(), points[1].end());
  EXPECT_EQ(star_discrepancy(view(points)), star);
}

TEST(PointSetDeathTest, RefusesWhatIsNotAPointSet) {
  EXPECT_DEATH(PointSet({}), "without dimensions");
  EXPECT_DEATH(view({{}, {}}), "without points");
  EXPECT_DEATH(view({{0.5}, {0.5, 0.5}}), "points in every dimension");
  EXPECT_DEATH(view({{0.5}, {1.5}}), "lies in \\[0, 1\\]");
  EXPECT_DEATH(view({{std::nan("")}}), "lies in \\[0, 1\\]");
  EXPECT_DEATH(star_discrepancy(view({{0.5}, {0.5}, {0.5}})), "dimensions of the star discrepancy");
}

}  // namespace
}  // namespace halfslope
