#include "samplers/pmj02.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

#include "tests/samplers/chi_squared.h"
#include "tests/samplers/nets.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kPair = {{2}};

/// Points begin … begin + count − 1 of `points`.
Points run_of(const Points& points, std::uint64_t begin, std::uint64_t count) {
  Points run(2, count);
  for (int dim = 0; dim < 2; ++dim) {
    for (std::uint64_t i = 0; i < count; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) run.at(dim, i, lane) = points.at(dim, begin + i, lane);
    }
  }
  return run;
}

TEST(Pmj02, EveryAlignedRunOfAPowerOfTwoIsANet) {
  const auto sampler = sampler_named("pmj02");
  constexpr int kDigits = 12;
  const Points points = points_of(*sampler, 1u << kDigits, kPair);
  for (int m = 0; m <= kDigits; ++m) {
    for (std::uint64_t begin = 0; begin < points.count(); begin += std::uint64_t{1} << m) {
      const Points run = run_of(points, begin, std::uint64_t{1} << m);
      for (int lane = 0; lane < kLanes; lane += m < 6 ? 5 : 1) {
        ASSERT_TRUE(is_net(run, m, lane)) << "2^" << m << " from " << begin << " lane " << lane;
      }
    }
  }
}

/// The digits of every point of the linear sequence that is scrambled, from the top, as pmj02_parent() chains them:
/// those of the parent, the other one at the place of the highest 1, and then zeros.
std::uint32_t digits(int coordinate, std::uint32_t index) {
  std::uint32_t word = 0;
  for (; index > 0; index = pmj02_parent(coordinate, index)) word ^= 0x80000000u >> (std::bit_width(index) - 1);
  return word;
}

TEST(Pmj02, ParentsAreThoseOfALinearZeroTwoSequenceInAllOctaves) {
  // Linear over bits, and for each m ≤ 31 and a + b = m the first a digits of x and b of y of the 2^m first points are
  // all different: the m × m matrix of what the index's bits do to them is regular.
  std::array<std::array<std::uint32_t, 31>, 2> columns;
  for (int c = 0; c < 2; ++c) {
    for (std::size_t bit = 0; bit < 31; ++bit) columns[static_cast<std::size_t>(c)][bit] = digits(c, 1u << bit);
    for (const std::uint32_t index : {3u, 6u, 1023u, 0x155u, 0x12345678u, 0x7fffffffu}) {
      std::uint32_t sum = 0;
      for (std::uint32_t bit = 0; bit < 31; ++bit) {
        if (index >> bit & 1) sum ^= columns[static_cast<std::size_t>(c)][bit];
      }
      ASSERT_EQ(digits(c, index), sum) << index;
    }
  }
  for (int m = 1; m <= 31; ++m) {
    for (int a = 0; a <= m; ++a) {
      std::vector<std::uint64_t> basis;  // of the columns as vectors of the m digits, kept in reduced form
      for (std::size_t bit = 0; bit < static_cast<std::size_t>(m); ++bit) {
        const std::uint64_t x = a ? columns[0][bit] >> (32 - a) : 0, y = a < m ? columns[1][bit] >> (32 - (m - a)) : 0;
        std::uint64_t vector = x << 32 | y;
        for (const std::uint64_t other : basis) vector = std::min(vector, vector ^ other);
        ASSERT_NE(vector, 0u) << "2^" << m << " points, " << a << " digits of x";
        basis.push_back(vector);
      }
    }
  }
}

TEST(Pmj02, TheNextPointOfASquareIsDiagonallyOpposite) {
  const auto sampler = sampler_named("pmj02");
  const Points points = points_of(*sampler, 8192, kPair);
  for (std::uint64_t side = 1; side * side < 8192; side *= 2) {
    for (std::uint64_t i = 0; i < side * side && i + side * side < 8192; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) {
        for (int dim = 0; dim < 2; ++dim) {
          ASSERT_EQ(points.interval(dim, i, lane, 2 * side) ^ 1, points.interval(dim, i + side * side, lane, 2 * side));
        }
      }
    }
  }
}

TEST(Pmj02, PointsBeyondTheTableGoOnTheSameWay) {
  // A run that lies late, and the digits that the last points share with their parents.
  const auto sampler = sampler_named("pmj02");
  sampler->prepare({.count = 1ull << 31, .layout = &kPair, .key = kTestKey, .low_words = true});
  PointBlock block;
  block.reset(2, 256, true);
  sampler->fill(0x12345600, block);
  Points run(2, 256);
  for (int dim = 0; dim < 2; ++dim) {
    for (int s = 0; s < 256; ++s) {
      for (int lane = 0; lane < kLanes; ++lane) {
        run.at(dim, static_cast<std::uint64_t>(s), lane) = std::uint64_t{block.high(dim)[s * kLanes + lane]} << 21;
      }
    }
  }
  for (int lane = 0; lane < kLanes; ++lane) EXPECT_TRUE(is_net(run, 8, lane));
  for (const std::uint32_t index : {0x7fffffffu, 0x40000000u, 0x55555555u, 1024u, 1025u, 2047u, 0x8000u}) {
    const int k = static_cast<int>(std::bit_width(index)) - 1;
    for (int dim = 0; dim < 2; ++dim) {
      PointBlock child, parent;
      child.reset(2, 1, true), parent.reset(2, 1, true);
      sampler->fill(index, child);
      sampler->fill(pmj02_parent(dim, index), parent);
      for (int lane = 0; lane < kLanes; ++lane) {
        EXPECT_EQ(std::countl_zero(child.high(dim)[lane] ^ parent.high(dim)[lane]), k) << index << " dim " << dim;
      }
    }
  }
}

TEST(Pmj02, EveryBitIsAFairCoin) {
  // 53 bits of two coordinates of indices on both sides of the table's end, 8192 replicates: |z| < 6.5, false alarm
  // 8e-11 for each of 848.
  constexpr std::uint32_t kGroups = 512;
  constexpr double kReplicates = kGroups * kLanes;
  const auto sampler = sampler_named("pmj02");
  for (const std::uint64_t begin : {0u, 5000u}) {
    std::array<std::array<std::array<std::uint32_t, 53>, 4>, 2> ones = {};
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      sampler->prepare(
          {.count = 8192, .layout = &kPair, .key = kTestKey, .replicate = group * kLanes, .low_words = true});
      PointBlock block;
      block.reset(2, 4, true);
      sampler->fill(begin, block);
      for (std::size_t dim = 0; dim < 2; ++dim) {
        for (std::size_t s = 0; s < 4; ++s) {
          for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::size_t i = s * kLanes + lane;
            const std::uint64_t x =
                std::uint64_t{block.high(static_cast<int>(dim))[i]} << 21 | block.low(static_cast<int>(dim))[i];
            for (std::size_t bit = 0; bit < 53; ++bit) ones[dim][s][bit] += static_cast<std::uint32_t>(x >> bit & 1);
          }
        }
      }
    }
    for (const auto& coordinate : ones) {
      for (const auto& point : coordinate) {
        for (const std::uint32_t heads : point) {
          EXPECT_LT(std::abs(heads - kReplicates / 2) / std::sqrt(kReplicates / 4), 6.5) << begin;
        }
      }
    }
  }
}

TEST(Pmj02, TailsOfPointsAreIndependent) {
  // Digits 2⁻⁵ … 2⁻⁷ of x and of y of 16 points lie below what they share: 8 × 8 tables of every two of these 32, 63
  // degrees, over 16384 replicates; false alarm 1e-9 for each of 496.
  const auto sampler = sampler_named("pmj02");
  std::vector<std::vector<std::uint8_t>> tails(32);
  for (std::uint32_t group = 0; group < 1024; ++group) {
    const Points points = points_of(*sampler, 16, kPair, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (std::uint64_t i = 0; i < 16; ++i) {
        for (int dim = 0; dim < 2; ++dim) {
          tails[2 * i + static_cast<std::size_t>(dim)].push_back(
              static_cast<std::uint8_t>(points.interval(dim, i, lane, 128) % 8));
        }
      }
    }
  }
  for (std::size_t a = 0; a < tails.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::array<std::uint32_t, 64> table = {};
      for (std::size_t r = 0; r < tails[a].size(); ++r) ++table[tails[a][r] * 8u + tails[b][r]];
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(table)), chi_squared_upper(63, 1e-9)) << a << ' ' << b;
    }
  }
}

}  // namespace
}  // namespace halfslope
