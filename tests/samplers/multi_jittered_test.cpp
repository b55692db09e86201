#include "samplers/multi_jittered.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "samplers/stratified.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kPair = {{2}};

// The stratum of a coordinate when edges are rounded up to multiples of 2⁻³²: that of its high word.
std::uint64_t stratum(const Points& points, int dim, std::uint64_t i, int lane, std::uint64_t strata) {
  return ((points.at(dim, i, lane) >> 21) * strata) >> 32;
}

class MultiJitteredSets : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Both, MultiJitteredSets, testing::Values("multi-jittered", "correlated-multi-jittered"),
                         [](const auto& set) { return set.index == 0 ? "independent" : "correlated"; });

TEST_P(MultiJitteredSets, OnePointInEachCellEachStratumOfXAndEachOfY) {
  const Layout layout = {{1, 2, 2}};
  const auto sampler = sampler_named(GetParam());
  for (const std::uint64_t count :
       {1u, 2u, 3u, 4u, 6u, 7u, 12u, 64u, 97u, 100u, 1000u, 1024u, 4096u, 4099u, 4100u, 8192u, 10000u}) {
    ASSERT_FALSE(sampler->illegal(count, layout));
    const Points points = points_of(*sampler, count, layout);
    const Grid grid = squarest_grid(count);
    for (int lane = 0; lane < kLanes; ++lane) {
      std::array<std::vector<int>, 7> seen;
      for (auto& cells : seen) cells.resize(count);
      for (std::uint64_t i = 0; i < count; ++i) {
        ++seen[0][stratum(points, 0, i, lane, count)];
        for (int pair = 0; pair < 2; ++pair) {
          const auto first = static_cast<std::size_t>(1 + 3 * pair);
          const int x = 1 + 2 * pair, y = x + 1;
          ++seen[first][stratum(points, x, i, lane, count)];
          ++seen[first + 1][stratum(points, y, i, lane, count)];
          ++seen[first + 2]
                [stratum(points, y, i, lane, grid.rows) * grid.columns + stratum(points, x, i, lane, grid.columns)];
        }
      }
      for (const auto& cells : seen) ASSERT_EQ(cells, std::vector<int>(count, 1)) << count << " lane " << lane;
    }
  }
}

TEST_P(MultiJitteredSets, PointsAreUniformInTheirBoxes) {
  // Where the points stand within their strata of 1/36: 8 × 8 cells of both fractions together, 63 degrees, false alarm
  // 1e-7.
  constexpr std::uint64_t kCount = 36;
  const auto sampler = sampler_named(GetParam());
  std::array<std::uint32_t, 64> cells = {};
  for (std::uint32_t group = 0; group < 512; ++group) {
    const Points points = points_of(*sampler, kCount, kPair, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (std::uint64_t i = 0; i < kCount; ++i) {
        ++cells[points.interval(0, i, lane, kCount * 8) % 8 * 8 + points.interval(1, i, lane, kCount * 8) % 8];
      }
    }
  }
  EXPECT_LT(chi_squared(std::span<const std::uint32_t>(cells)), chi_squared_upper(63, 1e-7));
}

/// Of each column, from the lowest row up, the stratum of x within the column: what its shuffle says.
std::vector<std::vector<std::uint64_t>> column_orders(const Points& points, int lane, int x, int y) {
  const std::uint64_t count = points.count();
  Grid grid = squarest_grid(count);
  if (x == 1) std::swap(grid.columns, grid.rows);
  std::vector<std::vector<std::uint64_t>> orders(grid.columns, std::vector<std::uint64_t>(grid.rows));
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t fine = stratum(points, x, i, lane, count), row = stratum(points, y, i, lane, grid.rows);
    orders[fine / grid.rows][row] = fine % grid.rows;
  }
  return orders;
}

TEST(MultiJittered, ColumnsAndRowsHaveShufflesOfTheirOwn) {
  // N = 16, 4 × 4: the shuffles of columns (or rows) 0 and 3, one of 24 each, independent: 575 degrees over 32768
  // replicates. False alarm 2e-7 each.
  const auto sampler = sampler_named("multi-jittered");
  for (int x = 0; x < 2; ++x) {
    std::map<std::vector<std::uint64_t>, std::size_t> shuffles;
    std::array<std::uint32_t, 576> joint = {};
    for (std::uint32_t group = 0; group < 2048; ++group) {
      const Points points = points_of(*sampler, 16, kPair, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto orders = column_orders(points, lane, x, 1 - x);
        const std::size_t first = shuffles.emplace(orders[0], shuffles.size()).first->second;
        ++joint[first * 24 + shuffles.emplace(orders[3], shuffles.size()).first->second];
      }
    }
    EXPECT_EQ(shuffles.size(), 24u);
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(joint)), chi_squared_upper(575, 2e-7)) << x;
  }
}

TEST(MultiJittered, KeyedShufflesOfNeighboursAreIndependent) {
  // N = 4900, 70 × 70, too large for tables: where the lowest cells of two neighbouring columns (or rows) go, in
  // fifths: 24 degrees over 35 pairs of 512 replicates. False alarm 2e-7 each.
  const auto sampler = sampler_named("multi-jittered");
  for (int x = 0; x < 2; ++x) {
    std::array<std::uint32_t, 25> joint = {};
    for (std::uint32_t group = 0; group < 32; ++group) {
      const Points points = points_of(*sampler, 4900, kPair, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto orders = column_orders(points, lane, x, 1 - x);
        for (std::size_t c = 0; c < 70; c += 2) ++joint[orders[c][0] / 14 * 5 + orders[c + 1][0] / 14];
      }
    }
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(joint)), chi_squared_upper(24, 2e-7)) << x;
  }
}

TEST(CorrelatedMultiJittered, ColumnsShareOneShuffleAndRowsAnother) {
  const auto sampler = sampler_named("correlated-multi-jittered");
  for (const std::uint64_t count : {16u, 100u, 512u, 4100u}) {
    const Points points = points_of(*sampler, count, kPair);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int x = 0; x < 2; ++x) {
        const auto orders = column_orders(points, lane, x, 1 - x);
        for (const auto& order : orders) ASSERT_EQ(order, orders[0]) << count;
      }
    }
  }
}

TEST(CorrelatedMultiJittered, TheTwoShufflesAreUniformAndIndependent) {
  // N = 16: 24 × 24 pairs of shuffles over 32768 replicates, 575 degrees, false alarm 1e-7.
  const auto sampler = sampler_named("correlated-multi-jittered");
  std::map<std::vector<std::uint64_t>, std::size_t> shuffles;
  std::array<std::uint32_t, 576> joint = {};
  for (std::uint32_t group = 0; group < 2048; ++group) {
    const Points points = points_of(*sampler, 16, kPair, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t of_columns =
          shuffles.emplace(column_orders(points, lane, 0, 1)[0], shuffles.size()).first->second;
      const std::size_t of_rows = shuffles.emplace(column_orders(points, lane, 1, 0)[0], shuffles.size()).first->second;
      ++joint[of_columns * 24 + of_rows];
    }
  }
  EXPECT_LT(chi_squared(std::span<const std::uint32_t>(joint)), chi_squared_upper(575, 1e-7));
}

// Of the mean of f = (x − ½)(y − ½) over n × n cells. In column c and row r let s be the stratum of x within the
// column, t that of y within the row, u and v uniform on [0, 1), all centred below: x − ½ = (c + (s + u)/n)/n, and y −
// ½ = (r + (t + v)/n)/n. Let V = n(n² − 1)/12 be the sum of squares of c, as of r, s and t. Of the sum of n² f over all
// cells:
//   c r        cancels.
//   c t/n      In a row, Σ_c c t(c) under a random shuffle has variance V²/(n − 1) (Hoeffding, 1951). Rows that share
//              one shuffle add up to n² of that; rows with shuffles of their own to n of it. Likewise r s/n.
//   s t/n²     Under shared shuffles Σ_r s(r) Σ_c t(c) = 0. Under own ones, cells are uncorrelated: n² (V/n)².
//   c v/n, r u/n                 nV/12 each, over n²;
//   s v/n², u t/n²               nV/12 each, over n⁴;
//   u v/n²                       n²/144, over n⁴.
// So sharing costs a factor of n in the leading term: variance N^(−3/2) instead of N^−2, whatever is smooth.
TEST(CorrelatedMultiJittered, VarianceOfAProductIsThatOfASharedShuffle) {
  constexpr std::uint32_t kGroups = 1024;
  constexpr double kEstimates = kGroups * kLanes;
  for (const int side : {4, 16}) {
    const double n = side, spread = n * (n * n - 1) / 12, count = n * n;
    const double jitter = 2 * n * spread / 12 * (std::pow(n, -2) + std::pow(n, -4)) + n * n / 144 * std::pow(n, -4);
    const double shared = 2 * n * n * spread * spread / (n - 1) / (n * n);
    const double own = shared / n + spread * spread * std::pow(n, -4);
    for (const bool correlated : {true, false}) {
      const double exact = ((correlated ? shared : own) + jitter) / std::pow(n, 4) / (count * count);
      const auto sampler = sampler_named(correlated ? "correlated-multi-jittered" : "multi-jittered");
      double sum = 0, squares = 0, fourths = 0;
      for (std::uint32_t group = 0; group < kGroups; ++group) {
        const Points points = points_of(*sampler, static_cast<std::uint64_t>(count), kPair, group * kLanes);
        for (int lane = 0; lane < kLanes; ++lane) {
          double error = 0;
          for (std::uint64_t i = 0; i < points.count(); ++i) {
            error += (points(0, i, lane) - 0.5) * (points(1, i, lane) - 0.5) / count;
          }
          sum += error;
          squares += error * error;
          fourths += std::pow(error, 4);
        }
      }
      const double variance = squares / kEstimates;
      const double se = std::sqrt((fourths / kEstimates - variance * variance) / kEstimates);
      EXPECT_LT(std::abs(variance - exact) / se, 5.5) << correlated << ' ' << n << ": " << variance << " for " << exact;
      EXPECT_LT(std::abs(sum) / std::sqrt(kEstimates * exact), 5.5) << correlated << ' ' << n;
    }
  }
}

}  // namespace
}  // namespace halfslope
