#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/spacing.h"
#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

using Place = std::pair<long double, long double>;

/// The point set, and for the torus its 8 nearest copies: no place is farther than √½ from some point's image.
std::vector<Place> sites(const Columns& points, bool torus) {
  std::vector<Place> all;
  const int reach = torus ? 1 : 0;
  for (int a = -reach; a <= reach; ++a) {
    for (int b = -reach; b <= reach; ++b) {
      for (std::size_t i = 0; i < points[0].size(); ++i) all.emplace_back(points[0][i] + a, points[1][i] + b);
    }
  }
  return all;
}

/// The largest hole has its centre equally far from three points, or from two and on an edge of the square, or in a
/// corner: all such places, each with its nearest point.
double all_centres(const Columns& points, bool torus) {
  std::vector<Place> all = sites(points, torus);
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  long double largest = 0;
  const auto look = [&](long double x, long double y) {
    if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return;
    long double nearest = 100;
    for (const auto& [a, b] : all) {
      nearest = std::min(nearest, std::hypot(a - x, b - y));
      if (nearest <= largest) return;
    }
    largest = nearest;
  };
  for (const long double x : {0, 1}) {
    for (const long double y : {0, 1}) look(x, y);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto [ax, ay] = all[i];
      const long double bx = all[j].first - ax, by = all[j].second - ay, b = bx * bx + by * by;
      for (const long double edge : {0, 1}) {
        if (by != 0) look(edge, ay + (b / 2 - (edge - ax) * bx) / by);
        if (bx != 0) look(ax + (b / 2 - (edge - ay) * by) / bx, edge);
      }
      for (std::size_t k = 0; k < j; ++k) {
        const long double cx = all[k].first - ax, cy = all[k].second - ay, c = cx * cx + cy * cy;
        const long double twice = 2 * (bx * cy - by * cx);
        if (twice != 0) look(ax + (cy * b - by * c) / twice, ay + (bx * c - cx * b) / twice);
      }
    }
  }
  return static_cast<double>(largest);
}

void expect_all_centres(const Columns& points) {
  EXPECT_NEAR(dispersion(view(points)), all_centres(points, false), 2e-14);
  if (points[0].size() <= 5) {
    EXPECT_NEAR(dispersion_toroidal(view(points)), all_centres(points, true), 2e-14);
  }
}

TEST(Dispersion, OfOnePoint) {
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {0.5, 0.5}, {0.25, 0.875}, {1.0, 0.0}, {1.0, 1.0}}) {
    EXPECT_DOUBLE_EQ(dispersion(view({{x}, {y}})), std::hypot(std::max(x, 1 - x), std::max(y, 1 - y)));
    EXPECT_DOUBLE_EQ(dispersion_toroidal(view({{x}, {y}})), std::sqrt(0.5));
  }
}

TEST(Dispersion, IsTheLargestOfAllCentres) {
  std::mt19937_64 random(1);
  for (std::size_t count = 1; count <= 24; ++count) {
    SCOPED_TRACE(count);
    for (int trial = 0; trial < (count <= 5 ? 6 : 3); ++trial) expect_all_centres(random_points(count, 2, random));
  }
}

// Four on a circle, many on a line, equal points, points on the edges and in the corners.
TEST(Dispersion, OfTies) {
  std::mt19937_64 random(2);
  for (std::uint64_t grid = 1; grid <= 8; ++grid) {
    for (const std::size_t count : {1, 2, 3, 4, 5, 12, 24}) {
      SCOPED_TRACE(testing::Message() << count << " points, grid " << grid);
      Columns points = random_points(count, 2, random, grid);
      expect_all_centres(points);
      points[0] = random_points(count, 1, random)[0];
      expect_all_centres(points);
    }
  }
}

TEST(Dispersion, OfClustersAndLines) {
  std::mt19937_64 random(3);
  for (const double scale : {1e-300, 1e-16, 1e-8, 1e-3}) {
    SCOPED_TRACE(scale);
    Columns points = random_points(20, 2, random);
    for (double& x : points[0]) x *= scale;
    expect_all_centres(points);  // nearly on the left edge
    for (double& x : points[0]) x = 0.5 + x / 4;
    expect_all_centres(points);
    for (double& y : points[1]) y *= scale;
    expect_all_centres(points);
    Columns few = {{0.1, 0.5, 0.9, 0.5}, {0.5, 0.5 + scale, 0.5, 0.5 - scale / 2}};
    expect_all_centres(few);  // nearly on a line: circles through three of them are huge
  }
}

TEST(Dispersion, OfGrids) {
  for (int n = 1; n <= 20; ++n) {
    Columns centred(2), cornered(2);
    for (int i = 0; i < n * n; ++i) {
      centred[0].push_back((i % n + 0.5) / n), centred[1].push_back((i / n + 0.5) / n);
      cornered[0].push_back(i % n / static_cast<double>(n)), cornered[1].push_back(i / n / static_cast<double>(n));
    }
    const double half_diagonal = std::sqrt(0.5) / n;
    EXPECT_NEAR(dispersion(view(centred)), half_diagonal, 2e-14);
    EXPECT_NEAR(dispersion_toroidal(view(centred)), half_diagonal, 2e-14);
    EXPECT_NEAR(dispersion(view(cornered)), 2 * half_diagonal, 2e-14);  // at the corner (1, 1)
    EXPECT_NEAR(dispersion_toroidal(view(cornered)), half_diagonal, 2e-14);
  }
}

// The covering radius of a plane lattice is the circumradius |a| |b| |a − b|/(2 area) of the triangle of its reduced
// basis, whose angle is not obtuse.
TEST(Dispersion, OfLattices) {
  for (const auto& [n, g] : {std::pair(5, 2), {13, 5}, {144, 89}, {610, 377}, {1024, 1}, {1021, 76}, {4096, 1555}}) {
    Columns points(2);
    for (std::int64_t i = 0; i < n; ++i) {
      points[0].push_back(static_cast<double>(i) / n);
      points[1].push_back(static_cast<double>(i * g % n) / n);
    }
    // Gauss's reduction, in units of 1/n, of the lattice with the basis (1, g), (0, n).
    std::int64_t ax = 1, ay = g, bx = 0, by = n;
    for (;;) {
      if (ax * ax + ay * ay > bx * bx + by * by) std::swap(ax, bx), std::swap(ay, by);
      const std::int64_t dot = ax * bx + ay * by, square = ax * ax + ay * ay;
      if (2 * std::abs(dot) <= square) break;
      const auto times = std::llround(static_cast<double>(dot) / static_cast<double>(square));
      bx -= times * ax, by -= times * ay;
    }
    if (ax * bx + ay * by < 0) bx = -bx, by = -by;
    const double a = std::hypot(ax, ay), b = std::hypot(bx, by), c = std::hypot(ax - bx, ay - by);
    EXPECT_NEAR(dispersion_toroidal(view(points)), a * b * c / (2.0 * n) / n, 2e-14) << n << ' ' << g;
  }
}

TEST(Dispersion, EqualPointsCountOnce) {
  std::mt19937_64 random(5);
  Columns points = random_points(30, 2, random);
  const double planar = dispersion(view(points)), torus = dispersion_toroidal(view(points));
  for (auto& column : points) column.resize(100'000, column[7]);
  EXPECT_EQ(dispersion(view(points)), planar);
  EXPECT_EQ(dispersion_toroidal(view(points)), torus);
}

// No place is farther from its nearest point; among many places some are nearly as far.
TEST(Dispersion, BoundsTheDistanceFromEveryPlace) {
  std::mt19937_64 random(6);
  for (const Columns& points : {random_points(1000, 2, random), halton(0, 1000), hammersley(10)}) {
    const double planar = dispersion(view(points));
    EXPECT_LE(dispersion_toroidal(view(points)), planar);  // more points, and no edges
    const Columns places = random_points(4000, 2, random);
    double farthest = 0;
    for (std::size_t q = 0; q < places[0].size(); ++q) {
      double nearest = 2;
      for (std::size_t i = 0; i < points[0].size(); ++i) {
        const double x = points[0][i] - places[0][q], y = points[1][i] - places[1][q];
        nearest = std::min(nearest, x * x + y * y);
      }
      farthest = std::max(farthest, std::sqrt(nearest));
    }
    EXPECT_LE(farthest, planar);
    EXPECT_GT(farthest, 0.75 * planar);
  }
}

// All are equally far from the middle, and any three give that circle, however near to each other.
TEST(Dispersion, OfPointsOnACircle) {
  Columns points(2);
  for (int i = 0; i < 3000; ++i) {
    const double angle = 2 * 3.14159265358979 * i * i / 9e6;
    points[0].push_back(0.5 + 0.375 * std::cos(angle)), points[1].push_back(0.5 + 0.375 * std::sin(angle));
  }
  EXPECT_NEAR(dispersion(view(points)), 0.375, 2e-14);
  // Around the torus' corner there is a smaller hole, √½ − 0.375.
  EXPECT_NEAR(dispersion_toroidal(view(points)), 0.375, 2e-14);
}

// Moving all points around the torus, by a step that rounds nothing.
TEST(Dispersion, OnTheTorusDoesNotDependOnTheOrigin) {
  std::mt19937_64 random(7);
  Columns points = random_points(500, 2, random, std::uint64_t{1} << 40);
  const double before = dispersion_toroidal(view(points));
  for (double& x : points[0]) x = x + 0.375 - std::floor(x + 0.375);
  for (double& y : points[1]) y = y + 0.8125 - std::floor(y + 0.8125);
  EXPECT_NEAR(dispersion_toroidal(view(points)), before, 2e-14);
}

TEST(DispersionDeathTest, IsOfTwoDimensions) {
  EXPECT_DEATH(dispersion(view({{0.5}})), "dimensions of the dispersion");
}

}  // namespace
}  // namespace halfslope
