#include "analysis/spacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

struct Distances {
  double least, mean;
};

/// Every point against every other.
Distances all_pairs(const Columns& points, bool torus) {
  const std::size_t n = points[0].size();
  Distances found = {std::numeric_limits<double>::infinity(), 0};
  for (std::size_t i = 0; i < n; ++i) {
    long double nearest = std::numeric_limits<long double>::infinity();
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      long double sum = 0;
      for (const auto& column : points) {
        long double apart = std::abs(static_cast<long double>(column[i]) - column[j]);
        if (torus) apart = std::min(apart, 1 - apart);
        sum += apart * apart;
      }
      nearest = std::min(nearest, sum);
    }
    const auto distance = static_cast<double>(std::sqrt(nearest));
    found.least = std::min(found.least, distance);
    found.mean += distance / static_cast<double>(n);
  }
  return found;
}

void expect_all_pairs(const Columns& points) {
  const Distances cube = all_pairs(points, false), torus = all_pairs(points, true);
  EXPECT_NEAR(min_distance(view(points)), cube.least, 1e-14 * cube.least);
  EXPECT_NEAR(mean_nn_distance(view(points)), cube.mean, 1e-13 * cube.mean);
  EXPECT_NEAR(min_distance_toroidal(view(points)), torus.least, 1e-14 * torus.least);
  EXPECT_NEAR(mean_nn_distance_toroidal(view(points)), torus.mean, 1e-13 * torus.mean);
}

// By brute force, elsewhere.
TEST(Spacing, OfHaltonAndSobolPoints) {
  const auto check = [](const Columns& points, double least, double mean) {
    EXPECT_NEAR(min_distance(view(points)), least, 1e-13);
    EXPECT_NEAR(mean_nn_distance(view(points)), mean, 1e-13);
  };
  check(halton(0, 64), 0.04847351251225633, 0.09412418486200685);
  check(halton(0, 256), 0.02367923767297541, 0.04304262982543293);
  check(halton(0, 1024), 0.008678191423554997, 0.01960865600564096);
  check(sobol(0, 64), 0.04419417382415922, 0.08349040146929829);
  const auto check_torus = [](const Columns& points, double least, double mean) {
    EXPECT_NEAR(min_distance_toroidal(view(points)), least, 1e-13);
    EXPECT_NEAR(mean_nn_distance_toroidal(view(points)), mean, 1e-13);
  };
  check_torus(halton(0, 64), 0.04847351251225633, 0.09019021416339569);
  check_torus(halton(0, 256), 0.023105962798342206, 0.04183009749981868);
  check_torus(sobol(0, 256), 0.005524271728019903, 0.04379946425393733);
  check_torus(sobol(0, 1024), 0.0027621358640099515, 0.018259148480469882);
}

TEST(Spacing, IsThatOfAllPairsInEveryDimension) {
  std::mt19937_64 random(1);
  for (std::size_t dims = 1; dims <= 9; ++dims) {
    for (const std::size_t count : {2, 3, 17, 200}) {
      SCOPED_TRACE(testing::Message() << dims << " dimensions, " << count << " points");
      expect_all_pairs(random_points(count, dims, random));
    }
  }
}

// Grids have ties, equal points, and coordinates 0 and 1, which are one on the torus.
TEST(Spacing, OfTiesAndEqualPoints) {
  std::mt19937_64 random(2);
  for (const std::uint64_t grid : {1, 2, 5, 9, 40}) {
    for (const std::size_t dims : {1u, 2u, 3u, 7u}) {
      SCOPED_TRACE(testing::Message() << dims << " dimensions, grid " << grid);
      expect_all_pairs(random_points(60, dims, random, grid));
    }
  }
}

TEST(Spacing, OfClusters) {
  std::mt19937_64 random(3);
  for (const double scale : {1e-100, 1e-12, 1e-3}) {
    Columns points = random_points(80, 2, random);
    for (std::size_t i = 0; i < 60; ++i) points[0][i] *= scale, points[1][i] = 1 - points[1][i] * scale;
    expect_all_pairs(points);
  }
}

TEST(Spacing, EqualPointsAreAtDistance0) {
  const Columns copies(2, std::vector<double>(100'000, 0.3));  // each has all others at distance 0
  EXPECT_EQ(min_distance(view(copies)), 0);
  EXPECT_EQ(mean_nn_distance(view(copies)), 0);
  EXPECT_EQ(min_distance_toroidal(view(copies)), 0);
  EXPECT_EQ(mean_nn_distance_toroidal(view(copies)), 0);
  EXPECT_EQ(relative_radius(view(copies)), 0);
  const Columns corners = {{0, 1}, {1, 0}};
  EXPECT_DOUBLE_EQ(min_distance(view(corners)), std::sqrt(2.0));
  EXPECT_EQ(min_distance_toroidal(view(corners)), 0);
}

TEST(Spacing, AcrossTheFacesOfTheTorus) {
  const Columns points = {{0.96875, 0.03125, 0.5}, {0.015625, 0.984375, 0.5}};
  EXPECT_DOUBLE_EQ(min_distance_toroidal(view(points)), std::hypot(0.0625, 0.03125));
  EXPECT_DOUBLE_EQ(min_distance(view(points)), std::hypot(0.46875, 0.484375));
}

// For independent points on the torus, P(the nearest is farther than r) = (1 − πr²)^(N−1), whose integral is
// Γ(N)/(2 Γ(N + 1/2)) short of 1e-100. 6 standard errors: a false alarm in 5e8 runs.
TEST(Spacing, OfIndependentPoints) {
  std::mt19937_64 random(4);
  const double n = 512, expected = 0.5 * std::exp(std::lgamma(n) - std::lgamma(n + 0.5));
  const int replicates = 256;
  double sum = 0, squares = 0;
  for (int r = 0; r < replicates; ++r) {
    const double mean = mean_nn_distance_toroidal(view(random_points(512, 2, random)));
    sum += mean, squares += (mean - expected) * (mean - expected);
  }
  EXPECT_NEAR(sum / replicates, expected, 6 * std::sqrt(squares) / replicates);
}

/// The points of a lattice with this base in each cell of an n × n × … grid.
Columns crystal(int n, const std::vector<std::vector<double>>& base) {
  const std::size_t dims = base[0].size();
  std::vector<std::vector<double>> points;
  for (int cell = 0; cell < std::pow(n, dims); ++cell) {
    for (auto point : base) {
      int rest = cell;
      for (double& x : point) x = (x + rest % n) / n, rest /= n;
      points.push_back(point);
    }
  }
  return columns_of(points);
}

TEST(RelativeRadius, OfCrystals) {
  const Columns line = crystal(10, {{0}}), squares = crystal(16, {{0, 0}});
  EXPECT_NEAR(relative_radius(view(line)), 1, 1e-14);
  EXPECT_NEAR(relative_radius(view(squares)), std::sqrt(std::sqrt(3.0) / 2), 1e-14);
  // Face-centred cubic is Kepler's packing; body-centred has √3/2 for the side 1 of a cell of two points.
  const Columns face = crystal(4, {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}});
  const Columns body = crystal(4, {{0, 0, 0}, {0.5, 0.5, 0.5}});
  EXPECT_NEAR(relative_radius(view(face)), 1, 1e-14);
  EXPECT_NEAR(relative_radius(view(body)), std::sqrt(0.75) / std::cbrt(std::sqrt(0.5)), 1e-14);
}

// 26 columns and 30 rows, every other row moved by half: nearly hexagonal, since 30/26 is nearly 2/√3.
TEST(RelativeRadius, OfNearlyHexagonalPoints) {
  Columns points(2);
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 26; ++column) {
      points[0].push_back((column + (row % 2 == 0 ? 0.25 : 0.75)) / 26);
      points[1].push_back(row / 30.0);
    }
  }
  const double nearest = std::min(1 / 26.0, std::hypot(1 / 52.0, 1 / 30.0));
  const double relative = relative_radius(view(points));
  EXPECT_NEAR(relative, nearest * std::sqrt(std::sqrt(3.0) * 26 * 30 / 2), 1e-13);
  EXPECT_GT(relative, 0.999);
  EXPECT_LT(relative, 1);
}

TEST(SpacingDeathTest, NeedsTwoPoints) {
  EXPECT_DEATH(min_distance(view({{0.5}})), "needs two");
  EXPECT_DEATH(mean_nn_distance_toroidal(view({{0.5}, {0.5}})), "needs two");
  EXPECT_DEATH(relative_radius(view(Columns(4, {0.1, 0.2}))), "densest packing");
}

}  // namespace
}  // namespace halfslope
