#include "samplers/pmj.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/samplers/chi_squared.h"
#include "tests/samplers/nets.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kPair = {{2}};

TEST(Pmj, PrefixesOfPowersOfTwoAreMultiJittered) {
  const auto sampler = sampler_named("pmj");
  for (const std::uint32_t replicate : {0u, 16u, 32u}) {
    const Points points = points_of(*sampler, 8192, kPair, replicate);
    for (std::uint64_t count = 1, side = 1; count <= 8192; count *= 2) {
      if (count > side * side * 2) side *= 2;
      for (int lane = 0; lane < kLanes; ++lane) {
        std::vector<int> x(count), y(count), squares(side * side);
        for (std::uint64_t i = 0; i < count; ++i) {
          ++x[points.interval(0, i, lane, count)];
          ++y[points.interval(1, i, lane, count)];
          ++squares[points.interval(0, i, lane, side) * side + points.interval(1, i, lane, side)];
        }
        ASSERT_EQ(x, std::vector<int>(count, 1)) << count;
        ASSERT_EQ(y, std::vector<int>(count, 1)) << count;
        ASSERT_EQ(squares, std::vector<int>(side * side, static_cast<int>(count / (side * side)))) << count;
      }
    }
  }
}

TEST(Pmj, TheSecondPointOfASquareIsDiagonallyOppositeAndSoIsTheFourthToTheThird) {
  const auto sampler = sampler_named("pmj");
  const Points points = points_of(*sampler, 4096, kPair);
  const auto opposite = [&](std::uint64_t i, std::uint64_t j, std::uint64_t side) {
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int dim = 0; dim < 2; ++dim) {
        if ((points.interval(dim, i, lane, 2 * side) ^ 1) != points.interval(dim, j, lane, 2 * side)) return false;
      }
    }
    return true;
  };
  for (std::uint64_t side = 1; 4 * side * side <= 4096; side *= 2) {
    const std::uint64_t cells = side * side;
    for (std::uint64_t i = 0; i < cells; ++i) {
      ASSERT_TRUE(opposite(i, i + cells, side)) << i;
      ASSERT_TRUE(opposite(i + 2 * cells, i + 3 * cells, side)) << i;
    }
  }
}

TEST(Pmj, TheThirdPointTakesEitherQuadrantAlike) {
  // The coins of the 16 squares of 4 × 4, over 4096 replicates: whether point 32 + i has point i's column of quadrants.
  // Every two of them are independent and fair: 3 degrees, false alarm 1e-9 for each of 120.
  const auto sampler = sampler_named("pmj");
  std::vector<std::vector<std::uint8_t>> coins(16);
  for (std::uint32_t group = 0; group < 256; ++group) {
    const Points points = points_of(*sampler, 64, kPair, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (std::uint64_t i = 0; i < 16; ++i) {
        coins[i].push_back(points.interval(0, i, lane, 8) == points.interval(0, 32 + i, lane, 8));
      }
    }
  }
  for (std::size_t a = 0; a < 16; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::array<std::uint32_t, 4> table = {};
      for (std::size_t r = 0; r < coins[a].size(); ++r) ++table[2u * coins[a][r] + coins[b][r]];
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(table)), chi_squared_upper(3, 1e-9)) << a << ' ' << b;
    }
  }
}

TEST(Pmj, FreeStrataAreTakenAtRandom) {
  // From 16 to 32 points each column of quadrants, 1/8 wide, gets two new points and has two strata of 1/32 free: which
  // of the two takes the lower one is a fair coin, and so it is in rows. All 16 coins are independent in pairs, 8192
  // replicates: 3 degrees, false alarm 1e-9 for each of 120.
  const auto sampler = sampler_named("pmj");
  std::vector<std::vector<std::uint8_t>> coins(16);
  for (std::uint32_t group = 0; group < 512; ++group) {
    const Points points = points_of(*sampler, 32, kPair, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int dim = 0; dim < 2; ++dim) {
        std::array<std::vector<std::uint64_t>, 8> fallen;
        for (std::uint64_t i = 16; i < 32; ++i)
          fallen[points.interval(dim, i, lane, 8)].push_back(points.at(dim, i, lane));
        for (std::size_t column = 0; column < 8; ++column) {
          ASSERT_EQ(fallen[column].size(), 2u);
          coins[8 * static_cast<std::size_t>(dim) + column].push_back(fallen[column][0] < fallen[column][1]);
        }
      }
    }
  }
  for (std::size_t a = 0; a < 16; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::array<std::uint32_t, 4> table = {};
      for (std::size_t r = 0; r < coins[a].size(); ++r) ++table[2u * coins[a][r] + coins[b][r]];
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(table)), chi_squared_upper(3, 1e-9)) << a << ' ' << b;
    }
  }
}

TEST(Pmj, IsNoNet) {
  // What sets pmj02 apart: pmj leaves elementary intervals empty that are neither squares nor strips.
  const auto sampler = sampler_named("pmj");
  int nets = 0;
  const Points points = points_of(*sampler, 64, kPair);
  for (int lane = 0; lane < kLanes; ++lane) nets += is_net(points, 6, lane);
  EXPECT_EQ(nets, 0);
}

TEST(Pmj, CountIsBoundedByWhatTheGroupsHoldInMemory) {
  const auto sampler = sampler_named("pmj");
  EXPECT_FALSE(sampler->illegal(1u << 18, singles(1)));
  EXPECT_EQ(sampler->illegal((1u << 18) + 1, singles(1))->below, 1u << 18);
  EXPECT_FALSE(sampler->illegal(1u << 16, {{1, 2, 2}}));
  EXPECT_EQ(sampler->illegal((1u << 16) + 1, {{1, 2, 2}})->below, 1u << 16);
}

}  // namespace
}  // namespace halfslope
