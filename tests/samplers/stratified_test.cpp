#include "samplers/stratified.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

// The stratum of a coordinate when edges are rounded up to multiples of 2⁻³²: that of its high word.
std::uint64_t stratum(const Points& points, int dim, std::uint64_t i, int lane, std::uint64_t strata) {
  return ((points.at(dim, i, lane) >> 21) * strata) >> 32;
}

TEST(Stratified, SquarestGridIsTheNearestPairOfFactors) {
  for (std::uint64_t count = 1; count <= 3000; ++count) {
    const Grid grid = squarest_grid(count);
    ASSERT_EQ(grid.columns * grid.rows, count);
    ASSERT_GE(grid.columns, grid.rows);
    for (std::uint64_t rows = grid.rows + 1; rows * rows <= count; ++rows) ASSERT_NE(count % rows, 0u) << count;
  }
  EXPECT_EQ(squarest_grid(1u << 31).rows, 32768u);
  EXPECT_EQ(squarest_grid(46340ull * 46340).rows, 46340u);
}

TEST(Stratified, OnePointInEachCellOfEveryGroup) {
  const Layout layout = {{1, 2, 2, 1}};
  const auto sampler = sampler_named("stratified");
  for (const std::uint64_t count :
       {1u, 2u, 3u, 4u, 6u, 7u, 12u, 64u, 97u, 100u, 1000u, 1024u, 4096u, 4099u, 4100u, 10000u}) {
    const Points points = points_of(*sampler, count, layout);
    const Grid grid = squarest_grid(count);
    for (int lane = 0; lane < kLanes; ++lane) {
      std::array<std::vector<int>, 4> seen;
      for (auto& cells : seen) cells.resize(count);
      for (std::uint64_t i = 0; i < count; ++i) {
        ++seen[0][stratum(points, 0, i, lane, count)];
        for (int pair = 0; pair < 2; ++pair) {
          const std::uint64_t column = stratum(points, 1 + 2 * pair, i, lane, grid.columns);
          const std::uint64_t row = stratum(points, 2 + 2 * pair, i, lane, grid.rows);
          ++seen[static_cast<std::size_t>(1 + pair)][row * grid.columns + column];
        }
        ++seen[3][stratum(points, 5, i, lane, count)];
      }
      for (const auto& cells : seen) ASSERT_EQ(cells, std::vector<int>(count, 1)) << count << " lane " << lane;
    }
  }
}

TEST(Stratified, GroupsAreShuffledIndependently) {
  // Σ_i a_i b_{π(i)} over centred cell indices of two groups has mean 0 and variance (S_a S_b)/(N − 1) under a uniform
  // π (Hoeffding, 1951); over R = 2048 · 16 replicates the sum's z is normal. And the cells of the first point in two
  // groups, 8 × 8, χ² with 63 degrees. False alarm 2e-7 + 1e-7 for each of 6 pairs of groups.
  constexpr std::uint64_t kCount = 64;
  constexpr int kGroups = 2048;
  const Layout layout = {{1, 2, 2, 1}};
  const auto sampler = sampler_named("stratified");
  std::array<std::array<double, 4>, 4> correlation = {};
  std::array<std::array<std::array<std::uint32_t, 64>, 4>, 4> joint = {};
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const Points points = points_of(*sampler, kCount, layout, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (std::uint64_t i = 0; i < kCount; ++i) {
        const std::array<std::uint64_t, 4> cells = {
            stratum(points, 0, i, lane, 64),
            stratum(points, 2, i, lane, 8) * 8 + stratum(points, 1, i, lane, 8),
            stratum(points, 4, i, lane, 8) * 8 + stratum(points, 3, i, lane, 8),
            stratum(points, 5, i, lane, 64),
        };
        for (std::size_t g = 0; g < 4; ++g) {
          for (std::size_t h = 0; h < g; ++h) {
            correlation[g][h] += (static_cast<double>(cells[g]) - 31.5) * (static_cast<double>(cells[h]) - 31.5);
            if (i == 0) ++joint[g][h][cells[g] / 8 * 8 + cells[h] / 8];
          }
        }
      }
    }
  }
  const double spread = 64.0 * (64 * 64 - 1) / 12;  // S_a = S_b
  const double sd = std::sqrt(spread * spread / 63 * kGroups * kLanes);
  for (std::size_t g = 0; g < 4; ++g) {
    for (std::size_t h = 0; h < g; ++h) {
      EXPECT_LT(std::abs(correlation[g][h]) / sd, 5.2) << g << ' ' << h;
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(joint[g][h])), chi_squared_upper(63, 1e-7)) << g << ' ' << h;
    }
  }
}

// Of the mean over an a × b jittered grid of f = x + y: each cell's x has variance 1/(12a²), its y 1/(12b²), cells
// independent, so Var = (1/N)(1/(12a²) + 1/(12b²)); in a 1-D group of N strata, of f = x: 1/(12N³). Estimates are sums
// of at least 24 independent terms, nearly normal; 16384 of them, false alarm 1e-7 each side.
TEST(Stratified, VarianceIsThatOfTheJitteredGrid) {
  constexpr std::uint32_t kGroups = 1024;
  constexpr double kEstimates = kGroups * kLanes;
  const Layout layout = {{2, 1}};
  const auto sampler = sampler_named("stratified");
  for (const std::uint64_t count : {24u, 29u, 64u}) {
    const Grid grid = squarest_grid(count);
    const double n = static_cast<double>(count), a = static_cast<double>(grid.columns),
                 b = static_cast<double>(grid.rows);
    const std::array<double, 2> exact = {(1 / (12 * a * a) + 1 / (12 * b * b)) / n, 1 / (12 * n * n * n)};
    std::array<double, 2> sum = {}, squares = {};
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, count, layout, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        std::array<double, 2> error = {};
        for (std::uint64_t i = 0; i < count; ++i) {
          error[0] += (points(0, i, lane) + points(1, i, lane) - 1) / n;
          error[1] += (points(2, i, lane) - 0.5) / n;
        }
        for (std::size_t f = 0; f < 2; ++f) {
          sum[f] += error[f];
          squares[f] += error[f] * error[f];
        }
      }
    }
    for (std::size_t f = 0; f < 2; ++f) {
      const double chi = (squares[f] - sum[f] * sum[f] / kEstimates) / exact[f];
      EXPECT_LT(chi, chi_squared_upper(kEstimates - 1, 1e-7)) << count << " f" << f;
      EXPECT_GT(chi, chi_squared_lower(kEstimates - 1, 1e-7)) << count << " f" << f;
      EXPECT_LT(std::abs(sum[f]) / std::sqrt(kEstimates * exact[f]), 5.4) << "bias, " << count << " f" << f;
    }
  }
}

}  // namespace
}  // namespace halfslope
