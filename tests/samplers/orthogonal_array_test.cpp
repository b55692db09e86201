#include "samplers/orthogonal_array.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

/// Which of `count` strata a point is in, their edges rounded up to multiples of 2⁻³².
std::uint64_t stratum(const Points& points, int dim, std::uint64_t point, int lane, std::uint64_t count) {
  return ((points.at(dim, point, lane) >> 21) * count) >> 32;
}

TEST(OrthogonalArray, EveryPairOfDimensionsHasOnePointInEachCell) {
  for (const std::uint64_t p : {2u, 3u, 5u, 7u, 11u}) {
    const int dims = static_cast<int>(p) + 1;
    const Points points = points_of(*make_orthogonal_array(), p * p, singles(dims), 0, 7, kTestKey, 0, 17);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int d = 0; d < dims; ++d) {
        for (int e = 0; e < d; ++e) {
          std::set<std::uint64_t> cells;
          for (std::uint64_t i = 0; i < p * p; ++i)
            cells.insert(points.interval(d, i, lane, p) * p + points.interval(e, i, lane, p));
          ASSERT_EQ(cells.size(), p * p) << p << ' ' << d << ' ' << e << ' ' << lane;
        }
      }
    }
  }
}

TEST(OrthogonalArray, EveryDimensionHasOnePointInEachOfNStrata) {
  for (const std::uint64_t p : {2u, 3u, 5u, 7u, 67u}) {
    const int dims = std::min(static_cast<int>(p) + 1, 4);
    const Points points = points_of(*make_orthogonal_array(), p * p, singles(dims));
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int d = 0; d < dims; ++d) {
        std::set<std::uint64_t> strata;
        for (std::uint64_t i = 0; i < p * p; ++i) strata.insert(stratum(points, d, i, lane, p * p));
        ASSERT_EQ(strata.size(), p * p) << p << ' ' << d << ' ' << lane;
      }
    }
  }
}

TEST(OrthogonalArray, LargeArraysAreArraysToo) {
  // Above 4096 levels their permutation is a hash; the first p points go through all of them in dimensions 1 and 2, and
  // keep to one in dimension 0.
  constexpr std::uint64_t kPrime = 4099;
  const Points points = points_of(*make_orthogonal_array(), kPrime * kPrime, singles(3), 0, 7, kTestKey, kPrime);
  for (int lane = 0; lane < kLanes; ++lane) {
    std::array<std::set<std::uint64_t>, 3> levels;
    std::set<std::uint64_t> strata;
    for (std::uint64_t i = 0; i < kPrime; ++i) {
      for (int d = 0; d < 3; ++d) levels[static_cast<std::size_t>(d)].insert(points.interval(d, i, lane, kPrime));
      strata.insert(stratum(points, 0, i, lane, kPrime * kPrime));
    }
    EXPECT_EQ(levels[0].size(), 1u);
    EXPECT_EQ(levels[1].size(), kPrime);
    EXPECT_EQ(levels[2].size(), kPrime);
    EXPECT_EQ(strata.size(), kPrime);
  }
}

TEST(OrthogonalArray, PairsOfPointsGoToEveryPairOfStrataThatTheArrayAllows) {
  // p = 3, in each of three dimensions: two points of one level lie in two of its three strata, in 3 · 3 · 2 ways, two
  // points of different levels in 9 · 6 ways, all equally likely. 65536 replicates, χ² with 17 and 53 degrees: false
  // alarm 1e-8 for each of 6.
  constexpr std::uint32_t kGroups = 4096;
  // Points a p + b, so these two share their level in dimension 0 (same a), 1 (same b), 2 (same a + b mod 3).
  constexpr std::array<std::array<std::uint64_t, 2>, 3> kSame = {{{0, 1}, {0, 3}, {1, 3}}};
  constexpr std::array<std::array<std::uint64_t, 2>, 3> kOther = {{{0, 3}, {0, 1}, {0, 1}}};
  const auto sampler = make_orthogonal_array();
  std::array<std::array<std::uint32_t, 18>, 3> same = {};
  std::array<std::array<std::uint32_t, 54>, 3> other = {};
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const Points points = points_of(*sampler, 9, singles(3), group * kLanes);
    for (std::size_t d = 0; d < 3; ++d) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto of_nine = [&](std::uint64_t i) { return stratum(points, static_cast<int>(d), i, lane, 9); };
        const std::uint64_t a = of_nine(kSame[d][0]), b = of_nine(kSame[d][1]);
        ASSERT_TRUE(a != b && a / 3 == b / 3);
        ++same[d][a * 2 + (b % 3 + 3 - a % 3) % 3 - 1];
        const std::uint64_t e = of_nine(kOther[d][0]), f = of_nine(kOther[d][1]);
        ASSERT_NE(e / 3, f / 3);
        ++other[d][e * 6 + (f + 9 - (e / 3 + 1) * 3) % 9];
      }
    }
  }
  for (std::size_t d = 0; d < 3; ++d) {
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(same[d])), chi_squared_upper(17, 1e-8)) << d;
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(other[d])), chi_squared_upper(53, 1e-8)) << d;
  }
}

TEST(OrthogonalArray, OnlySquaresOfPrimesThatHaveTheDimensionsAreLegal) {
  const auto sampler = make_orthogonal_array();
  for (const std::uint64_t count : {4u, 9u, 25u, 49u, 121u}) EXPECT_FALSE(sampler->illegal(count, singles(3))) << count;
  const auto four = sampler->illegal(16, singles(2));
  ASSERT_TRUE(four);
  EXPECT_EQ(four->below, 9u);
  EXPECT_EQ(four->above, 25u);
  EXPECT_FALSE(sampler->illegal(9, singles(4)));
  const auto narrow = sampler->illegal(9, singles(5));
  ASSERT_TRUE(narrow);
  EXPECT_EQ(narrow->below, std::nullopt);
  EXPECT_EQ(narrow->above, 25u);
  // The largest prime whose square is at most 2³¹ is 46337.
  const auto many = sampler->illegal(std::uint64_t{1} << 60, singles(2));
  ASSERT_TRUE(many);
  EXPECT_EQ(many->below, std::uint64_t{46337} * 46337);
  EXPECT_EQ(many->above, std::nullopt);
}

}  // namespace
}  // namespace halfslope
