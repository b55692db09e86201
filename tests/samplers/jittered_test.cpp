#include "samplers/jittered.h"

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

std::uint64_t power(std::uint64_t side, int dims) {
  std::uint64_t product = 1;
  for (int d = 0; d < dims; ++d) product *= side;
  return product;
}

TEST(Jittered, OnePointInEachCellOfTheFullGrid) {
  const auto sampler = sampler_named("jittered");
  constexpr std::array<std::array<int, 2>, 17> kGrids = {{{1, 1},
                                                          {1, 31},
                                                          {7, 1},
                                                          {1000, 1},
                                                          {5000, 1},
                                                          {2, 2},
                                                          {3, 2},
                                                          {10, 2},
                                                          {64, 2},
                                                          {101, 2},
                                                          {2, 3},
                                                          {5, 3},
                                                          {16, 3},
                                                          {6, 4},
                                                          {4, 5},
                                                          {3, 8},
                                                          {2, 13}}};
  for (const auto& [n, dims] : kGrids) {
    const auto side = static_cast<std::uint64_t>(n);
    const std::uint64_t count = power(side, dims);
    ASSERT_FALSE(sampler->illegal(count, singles(dims)));
    const Points points = points_of(*sampler, count, singles(dims));
    for (int lane = 0; lane < kLanes; ++lane) {
      std::vector<int> seen(count);
      for (std::uint64_t i = 0; i < count; ++i) {
        std::uint64_t cell = 0;
        for (int d = dims - 1; d >= 0; --d) cell = cell * side + stratum(points, d, i, lane, side);
        ASSERT_EQ(cell, i) << n << '^' << dims;
        ++seen[cell];
      }
      ASSERT_EQ(seen, std::vector<int>(count, 1)) << n << '^' << dims << " lane " << lane;
    }
  }
}

TEST(Jittered, TheLayoutsGroupsDoNotMatter) {
  const auto sampler = sampler_named("jittered");
  EXPECT_EQ(points_of(*sampler, 1024, {{1, 2, 2}}), points_of(*sampler, 1024, singles(5)));
}

TEST(Jittered, SideIsTheExactRoot) {
  for (int dims = 1; dims <= 40; ++dims) {
    for (std::uint64_t side = 1; side <= 70000; side = side < 50 ? side + 1 : side * 3 / 2) {
      long double size = 1;
      for (int d = 0; d < dims; ++d) size *= static_cast<long double>(side);
      if (size >= 0x1p62L) break;
      const std::uint64_t cells = power(side, dims);
      ASSERT_EQ(grid_side(cells, dims), side) << side << '^' << dims;
      if (cells > 1) {
        ASSERT_EQ(grid_side(cells - 1, dims), side - 1) << side << '^' << dims;
      }
      if (dims > 1) {
        ASSERT_EQ(grid_side(cells + 1, dims), side) << side << '^' << dims;
      }
    }
  }
  EXPECT_EQ(grid_side(1u << 31, 1), 1u << 31);
  EXPECT_EQ(grid_side(~std::uint64_t{0}, 2), 0xffffffffu);
  EXPECT_EQ(grid_side(~std::uint64_t{0}, 1), ~std::uint64_t{0});
  EXPECT_EQ(grid_side(~std::uint64_t{0}, 1 << 30), 1u);
}

TEST(Jittered, CountsThatAreNoPowersNameTheirNeighbours) {
  const auto sampler = sampler_named("jittered");
  struct Case {
    int dims;
    std::uint64_t count;
    std::optional<std::uint64_t> below, above;
  };
  const Case cases[] = {{2, 17, 16, 25},
                        {2, 24, 16, 25},
                        {3, 1000001, 1000000, 1030301},
                        {5, 64, 32, 243},
                        {2, 0, std::nullopt, 1},
                        // 46340² < 2³¹ < 46341², 1290³ < 2³¹ < 1291³, 215⁴ < 2³¹ < 216⁴, 2³¹ = 2³¹.
                        {2, 46340ull * 46340 + 1, 46340ull * 46340, std::nullopt},
                        {2, 46340ull * 46340 - 1, 46339ull * 46339, 46340ull * 46340},
                        {2, 1ull << 31, 46340ull * 46340, std::nullopt},
                        {3, 1ull << 31, 1290ull * 1290 * 1290, std::nullopt},
                        {4, (1ull << 31) - 1, 215ull * 215 * 215 * 215, std::nullopt},
                        {31, (1ull << 31) - 1, 1, 1ull << 31},
                        {31, (1ull << 31) + 1, 1ull << 31, std::nullopt},
                        {1, (1ull << 31) + 1, 1ull << 31, std::nullopt},
                        {32, 2, 1, std::nullopt},
                        {1024, 1000, 1, std::nullopt},
                        {6, ~0ull, 35ull * 35 * 35 * 35 * 35 * 35, std::nullopt}};
  for (const Case& c : cases) {
    const auto neighbours = sampler->illegal(c.count, singles(c.dims));
    ASSERT_TRUE(neighbours) << c.count << " in " << c.dims;
    EXPECT_EQ(neighbours->below, c.below) << c.count << " in " << c.dims;
    EXPECT_EQ(neighbours->above, c.above) << c.count << " in " << c.dims;
  }
  for (int dims = 1; dims <= 31; ++dims) EXPECT_FALSE(sampler->illegal(1, singles(dims))) << dims;
  EXPECT_FALSE(sampler->illegal(1ull << 31, singles(1)));
  EXPECT_FALSE(sampler->illegal(1ull << 31, singles(31)));
  EXPECT_FALSE(sampler->illegal(46340ull * 46340, singles(2)));
}

TEST(Jittered, LastPointsOfTheLargestGridsStandInTheirCells) {
  const auto sampler = sampler_named("jittered");
  for (const auto& [n, dims] : {std::pair{46340, 2}, std::pair{1290, 3}, std::pair{2, 31}}) {
    const auto side = static_cast<std::uint64_t>(n);
    const std::uint64_t count = power(side, dims), begin = count - 100;
    const Layout layout = singles(dims);
    sampler->prepare({.count = count, .layout = &layout, .key = kTestKey, .low_words = true});
    PointBlock block;
    block.reset(dims, 100, true);
    sampler->fill(begin, block);
    for (int s = 0; s < 100; ++s) {
      std::uint64_t rest = begin + static_cast<std::uint64_t>(s);
      for (int d = 0; d < dims; ++d, rest /= side) {
        for (int lane = 0; lane < kLanes; ++lane) {
          ASSERT_EQ((std::uint64_t{block.high(d)[s * kLanes + lane]} * side) >> 32, rest % side) << n << '^' << dims;
        }
      }
    }
  }
}

TEST(Jittered, PointsAreUniformInTheirCellsAndIndependent) {
  // Where in its stratum each coordinate lies: 64 bins at every point of 32768 replicates; and the places of two
  // coordinates of a point, and of a coordinate of two points, in 16 × 16. False alarm 1e-9 for each of about 200.
  constexpr std::uint32_t kGroups = 2048;
  const auto sampler = sampler_named("jittered");
  for (const auto& [n, dims] : {std::pair{2, 3}, std::pair{4, 2}, std::pair{8, 1}, std::pair{1, 4}}) {
    const auto side = static_cast<std::uint64_t>(n);
    const std::uint64_t count = power(side, dims);
    const auto coordinates = count * static_cast<std::size_t>(dims);
    std::vector<std::array<std::uint32_t, 64>> place(coordinates);
    std::vector<std::array<std::uint32_t, 256>> joint(2 * coordinates);
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, count, singles(dims), group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto within = [&](int d, std::uint64_t i, std::uint64_t bins) {
          return points.interval(d, i, lane, side * bins) % bins;
        };
        for (std::uint64_t i = 0; i < count; ++i) {
          for (int d = 0; d < dims; ++d) {
            const std::size_t at = i * static_cast<std::size_t>(dims) + static_cast<std::size_t>(d);
            ++place[at][within(d, i, 64)];
            const std::uint64_t here = within(d, i, 16) * 16;
            if (dims > 1) ++joint[2 * at][here + within((d + 1) % dims, i, 16)];
            if (count > 1) ++joint[2 * at + 1][here + within(d, (i + 1) % count, 16)];
          }
        }
      }
    }
    for (std::size_t at = 0; at < coordinates; ++at) {
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(place[at])), chi_squared_upper(63, 1e-9))
          << n << '^' << dims;
      for (const std::size_t kind : {2 * at, 2 * at + 1}) {
        if (dims == 1 && kind == 2 * at) continue;
        if (count == 1 && kind == 2 * at + 1) continue;
        EXPECT_LT(chi_squared(std::span<const std::uint32_t>(joint[kind])), chi_squared_upper(255, 1e-9))
            << n << '^' << dims << " coordinate " << at;
      }
    }
  }
}

// The curse: of the mean of f = x_1 + … + x_d over n^d cells, each coordinate varies by 1/(12n²) in its cell, so Var =
// d/(12 n² N) = d/12 · N^(−1−2/d). 16384 estimates, each a sum of at least 16 uniform terms; false alarm 1e-7 a side.
TEST(Jittered, VarianceOfASumFallsAsTheGridsCurseSays) {
  constexpr std::uint32_t kGroups = 1024;
  constexpr double kEstimates = kGroups * kLanes;
  const auto sampler = sampler_named("jittered");
  for (const auto& [n, dims] : {std::pair{16, 1}, std::pair{5, 2}, std::pair{3, 3}, std::pair{2, 6}}) {
    const std::uint64_t count = power(static_cast<std::uint64_t>(n), dims);
    const double points_n = static_cast<double>(count), exact = dims / (12.0 * n * n * points_n);
    double sum = 0, squares = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, count, singles(dims), group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        double error = 0;
        for (int d = 0; d < dims; ++d) {
          for (std::uint64_t i = 0; i < count; ++i) error += (points(d, i, lane) - 0.5) / points_n;
        }
        sum += error;
        squares += error * error;
      }
    }
    const double chi = (squares - sum * sum / kEstimates) / exact;
    EXPECT_LT(chi, chi_squared_upper(kEstimates - 1, 1e-7)) << n << '^' << dims;
    EXPECT_GT(chi, chi_squared_lower(kEstimates - 1, 1e-7)) << n << '^' << dims;
    EXPECT_LT(std::abs(sum) / std::sqrt(kEstimates * exact), 5.4) << "bias, " << n << '^' << dims;
  }
}

}  // namespace
}  // namespace halfslope
