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

// The stratum of a coordinate when edges are rounded up to multiples of 2⁻³²: that of its high word.
std::uint64_t stratum(const Points& points, int dim, std::uint64_t i, int lane, std::uint64_t strata) {
  return ((points.at(dim, i, lane) >> 21) * strata) >> 32;
}

class MultiJitteredSets : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Both, MultiJitteredSets, testing::Values("multi-jittered", "correlated-multi-jittered"),
                         [](const auto& info) { return info.index == 0 ? "independent" : "correlated"; });

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
    const Points points = points_of(*sampler, kCount, {{2}}, group * kLanes);
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
  // N = 16, 4 × 4: the shuffles of columns (or rows) 0 and 3, one of 24 each, independent: 575 degrees over 65536
  // replicates. Of N = 4100 = 82 × 50, where shuffles are keyed: where the first two rows of two columns go, in fifths:
  // 624 degrees over 8192 replicates. False alarm 2e-7 for each of 4.
  const auto sampler = sampler_named("multi-jittered");
  for (int x = 0; x < 2; ++x) {
    std::map<std::vector<std::uint64_t>, std::size_t> shuffles;
    std::array<std::uint32_t, 576> joint = {};
    std::array<std::uint32_t, 625> keyed = {};
    for (std::uint32_t group = 0; group < 4096; ++group) {
      const Points points = points_of(*sampler, 16, {{2}}, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto orders = column_orders(points, lane, x, 1 - x);
        const std::size_t first = shuffles.emplace(orders[0], shuffles.size()).first->second;
        ++joint[first * 24 + shuffles.emplace(orders[3], shuffles.size()).first->second];
      }
    }
    for (std::uint32_t group = 0; group < 512; ++group) {
      const Points points = points_of(*sampler, 4100, {{2}}, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto orders = column_orders(points, lane, x, 1 - x);
        const auto fifth = [&](std::size_t column, std::size_t row) {
          return orders[column][row] * 5 / orders[column].size();
        };
        ++keyed[((fifth(0, 0) * 5 + fifth(0, 1)) * 5 + fifth(1, 0)) * 5 + fifth(1, 1)];
      }
    }
    EXPECT_EQ(shuffles.size(), 24u);
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(joint)), chi_squared_upper(575, 2e-7)) << x;
    // Two rows of a column go to different strata, which makes equal fifths a little rarer: at 50 strata a fifth is 10
    // of them, (10/50)(9/49) for (10/50)², at 82 less. It adds at most 8192 · 2 · (0.082² / 5 + 0.02² · 4 / 5).
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(keyed)),
              chi_squared_upper(624, 2e-7) + 8192 * 2 * (0.082 * 0.082 / 5 + 0.0205 * 0.0205 * 4 / 5))
        << x;
  }
}

TEST(CorrelatedMultiJittered, ColumnsShareOneShuffleAndRowsAnother) {
  const auto sampler = sampler_named("correlated-multi-jittered");
  for (const std::uint64_t count : {16u, 100u, 512u, 4100u}) {
    const Points points = points_of(*sampler, count, {{2}});
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int x = 0; x < 2; ++x) {
        const auto orders = column_orders(points, lane, x, 1 - x);
        for (const auto& order : orders) ASSERT_EQ(order, orders[0]) << count;
      }
    }
  }
}

TEST(CorrelatedMultiJittered, TheTwoShufflesAreUniformAndIndependent) {
  // N = 16: 24 × 24 pairs of shuffles over 65536 replicates, 575 degrees, false alarm 1e-7.
  const auto sampler = sampler_named("correlated-multi-jittered");
  std::map<std::vector<std::uint64_t>, std::size_t> shuffles;
  std::array<std::uint32_t, 576> joint = {};
  for (std::uint32_t group = 0; group < 4096; ++group) {
    const Points points = points_of(*sampler, 16, {{2}}, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t of_columns =
          shuffles.emplace(column_orders(points, lane, 0, 1)[0], shuffles.size()).first->second;
      const std::size_t of_rows = shuffles.emplace(column_orders(points, lane, 1, 0)[0], shuffles.size()).first->second;
      ++joint[of_columns * 24 + of_rows];
    }
  }
  EXPECT_LT(chi_squared(std::span<const std::uint32_t>(joint)), chi_squared_upper(575, 1e-7));
}

// Of the mean of f = (x − ½)(y − ½) over n × n cells. Write x = (c + (s + u)/n)/n for column c, stratum s within it,
// and u − ½ of variance 1/12; the bars are centred. Then x̄ = (c̄ + (s̄ + ū)/n)/n, and likewise ȳ = (r̄ + (t̄ + v̄)/n)/n. The
// terms of n⁴ Σ f/N: Σ c̄ r̄ = 0; Σ c̄ t̄/n over all cells; Σ r̄ s̄/n; Σ s̄ t̄/n²; and those with ū or v̄. Where all columns
// share σ(r) = s, and all rows τ(c) = t: Σ c̄ t̄ = n Σ_c c̄ τ̄(c), whose variance is n² V²/(n − 1) with V = n(n² − 1)/12
// (Hoeffding, 1951); Σ s̄ t̄ = 0. So nothing of c̄ t̄ cancels over the rows: the leading variance is 2 n² V²/((n − 1) n²) /
// n⁸ ~ n⁻³/72, that is N^(−3/2) and RMSE ~ N^(−¾), where shuffles of each row's own give n of V²/(n − 1), n times less:
// N^−1. The rest, to order n⁻⁴: n² cells' terms c̄ v̄/n and r̄ ū/n, each V/(12 n²) · n, in both kinds; and Σ s̄ t̄ /n²,
// which is below.
TEST(CorrelatedMultiJittered, VarianceOfAProductIsThatOfASharedShuffle) {
  constexpr std::uint32_t kGroups = 1024;
  constexpr double kEstimates = kGroups * kLanes;
  for (const int side : {4, 16}) {
    const double n = side, spread = n * (n * n - 1) / 12, count = n * n;
    const double jitter = 2 * n * spread / 12 / (n * n)           // c̄ v̄ and r̄ ū, n² cells: n V each
                          + 2 * n * spread / 12 / std::pow(n, 4)  // s̄ v̄ and ū t̄
                          + count / 144 / std::pow(n, 4);         // ū v̄
    const double shared = 2 * n * n * spread * spread / (n - 1) / (n * n);
    // Own shuffles: n rows of Σ_c c̄ τ̄_r(c), n columns likewise; s̄ t̄ of the n² cells: variance (V/n)² each, and two
    // cells of a row (or of a column) have covariance 0 since their columns' shuffles are independent.
    const double own = 2 * n * spread * spread / (n - 1) / (n * n) + count * spread * spread / (n * n) / std::pow(n, 4);
    for (const bool correlated : {true, false}) {
      const double exact = ((correlated ? shared : own) + jitter) / std::pow(n, 4) / (count * count);
      const auto sampler = sampler_named(correlated ? "correlated-multi-jittered" : "multi-jittered");
      double sum = 0, squares = 0, fourths = 0;
      for (std::uint32_t group = 0; group < kGroups; ++group) {
        const Points points = points_of(*sampler, static_cast<std::uint64_t>(count), {{2}}, group * kLanes);
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
