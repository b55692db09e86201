#include "samplers/hammersley_owen.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

#include "samplers/radical_inverse.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/nets.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

TEST(HammersleyOwen, EveryElementaryIntervalHoldsOnePoint) {
  const auto sampler = sampler_named("hammersley-owen");
  for (int m = 0; m <= 10; ++m) {
    const Points points = points_of(*sampler, 1u << m, {{2}});
    for (int lane = 0; lane < kLanes; ++lane) EXPECT_TRUE(is_net(points, m, lane)) << m << " lane " << lane;
  }
}

TEST(HammersleyOwen, LargeSetsAreNetsTooAndFurtherDimensionsAreStratified) {
  const auto sampler = sampler_named("hammersley-owen");
  constexpr int kDigits = 15;
  const Points points = points_of(*sampler, 1u << kDigits, {{2, 1, 1}});
  EXPECT_TRUE(is_net(points, kDigits, 3));
  for (int dim = 1; dim < 4; ++dim) {  // the first b^k points of a dimension: one in each of b^k intervals
    const std::uint64_t base = primes()[static_cast<std::size_t>(dim - 1)];
    for (std::uint64_t power = base; power <= points.count(); power *= base) {
      std::vector<int> seen(power);
      for (std::uint64_t i = 0; i < power; ++i) ++seen[points.interval(dim, i, 3, power)];
      EXPECT_EQ(seen, std::vector<int>(power, 1)) << dim << ' ' << power;
    }
  }
}

TEST(HammersleyOwen, OnlyPowersOfTwoAreLegal) {
  const auto sampler = sampler_named("hammersley-owen");
  for (int m = 0; m <= 31; ++m) {
    EXPECT_FALSE(sampler->illegal(1ull << m, singles(2))) << m;
    if (m < 2) continue;
    for (const std::uint64_t count : {(1ull << m) - 1, (1ull << m) - (1ull << (m - 2))}) {
      const auto neighbours = sampler->illegal(count, singles(2));
      ASSERT_TRUE(neighbours) << count;
      EXPECT_EQ(neighbours->below, 1ull << (m - 1));
      EXPECT_EQ(neighbours->above, 1ull << m);
    }
  }
  EXPECT_EQ(sampler->illegal(0, singles(2))->above, 1u);
  EXPECT_EQ(sampler->illegal((1ull << 31) + 1, singles(1))->below, 1ull << 31);
  // From the third dimension on the digits in base 3 must fit: 3¹⁹ points, of which 2³⁰ are a power of two.
  for (const std::uint64_t count : {(1ull << 30) + 1, 1ull << 31, ~0ull}) {
    EXPECT_EQ(sampler->illegal(count, singles(3))->below, 1ull << 30);
    EXPECT_EQ(sampler->illegal(count, singles(3))->above, std::nullopt);
  }
  EXPECT_FALSE(sampler->illegal(1ull << 30, singles(3)));
}

TEST(HammersleyOwen, LastPointsOfTheLargestSetStandInTheirParentsIntervals) {
  // The first k digits of i/2^m and of j/2^m, i without its lowest 1, are the same, and so are the points'; digit k
  // differs.
  const auto sampler = sampler_named("hammersley-owen");
  const Layout layout = singles(1);
  sampler->prepare({.count = 1ull << 31, .layout = &layout, .key = kTestKey, .low_words = true});
  for (const std::uint64_t index : {(1ull << 31) - 1, (1ull << 31) - 2, 1ull << 30, 0x55555555ull, 0x7ffff000ull}) {
    PointBlock child, parent;
    child.reset(1, 1, true), parent.reset(1, 1, true);
    sampler->fill(index, child);
    sampler->fill(index & (index - 1), parent);
    const int k = 30 - std::countr_zero(index);
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t differ = child.high(0)[lane] ^ parent.high(0)[lane];
      EXPECT_EQ(std::countl_zero(differ), k) << index << " lane " << lane;
    }
  }
}

TEST(HammersleyOwen, NodesFlipUniformlyAndIndependently) {
  // The flip of node (k, prefix) of i/2^m is digit k of x_i for the i of that prefix and then zeros. For m = 4: 15
  // nodes, the first digit of each point's tail (16 more), over 32768 replicates; each is a fair coin, and every two of
  // them are independent, of the second dimension's first digit too: 2 × 2 tables, 3 degrees. False alarm 1e-9 for each
  // of 496.
  constexpr int kDigits = 4;
  constexpr std::uint32_t kGroups = 2048;
  const auto sampler = sampler_named("hammersley-owen");
  std::vector<std::vector<std::uint8_t>> coins(32);
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const Points points = points_of(*sampler, 1u << kDigits, {{2}}, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      std::size_t coin = 0;
      for (int k = 0; k < kDigits; ++k) {
        for (std::uint64_t prefix = 0; prefix < 1u << k; ++prefix) {
          const std::uint64_t i = prefix << (kDigits - k);
          coins[coin++].push_back(static_cast<std::uint8_t>(points.interval(0, i, lane, 2u << k) & 1));
        }
      }
      for (std::uint64_t i = 0; i < 1u << kDigits; ++i) {
        coins[coin++].push_back(static_cast<std::uint8_t>(points.interval(0, i, lane, 2u << kDigits) & 1));
      }
      coins[coin].push_back(static_cast<std::uint8_t>(points.interval(1, 0, lane, 2)));
    }
  }
  for (std::size_t a = 0; a < coins.size(); ++a) {
    ASSERT_EQ(coins[a].size(), std::size_t{kGroups} * kLanes);
    for (std::size_t b = 0; b < a; ++b) {
      std::array<std::uint32_t, 4> table = {};
      for (std::size_t r = 0; r < coins[a].size(); ++r) ++table[2u * coins[a][r] + coins[b][r]];
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(table)), chi_squared_upper(3, 1e-9)) << a << ' ' << b;
    }
  }
}

TEST(HammersleyOwen, EveryBitOfTheFirstCoordinateIsAFairCoin) {
  // 53 bits of each of 8 points, 32768 replicates: |z| < 6.5, false alarm 8e-11 for each of 424.
  constexpr std::uint32_t kGroups = 2048;
  constexpr double kReplicates = kGroups * kLanes;
  const auto sampler = sampler_named("hammersley-owen");
  std::array<std::array<std::uint32_t, 53>, 8> ones = {};
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const Points points = points_of(*sampler, 8, {{2}}, group * kLanes);
    for (std::uint64_t i = 0; i < 8; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) {
        for (std::size_t bit = 0; bit < 53; ++bit)
          ones[i][bit] += static_cast<std::uint32_t>(points.at(0, i, lane) >> bit & 1);
      }
    }
  }
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t bit = 0; bit < 53; ++bit) {
      EXPECT_LT(std::abs(ones[i][bit] - kReplicates / 2) / std::sqrt(kReplicates / 4), 6.5) << i << " bit " << bit;
    }
  }
}

// Of the mean of f = x over N = 2^m points: one point, uniform, in each of N strata, so Var = 1/(12N³).
TEST(HammersleyOwen, VarianceOfTheFirstCoordinateIsThatOfItsStrata) {
  constexpr std::uint32_t kGroups = 1024;
  constexpr double kEstimates = kGroups * kLanes;
  const auto sampler = sampler_named("hammersley-owen");
  for (const std::uint64_t count : {16u, 64u}) {
    const double n = static_cast<double>(count), exact = 1 / (12 * n * n * n);
    double sum = 0, squares = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, count, {{2}}, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        double error = 0;
        for (std::uint64_t i = 0; i < count; ++i) error += (points(0, i, lane) - 0.5) / n;
        sum += error;
        squares += error * error;
      }
    }
    const double chi = (squares - sum * sum / kEstimates) / exact;
    EXPECT_LT(chi, chi_squared_upper(kEstimates - 1, 1e-7)) << count;
    EXPECT_GT(chi, chi_squared_lower(kEstimates - 1, 1e-7)) << count;
    EXPECT_LT(std::abs(sum) / std::sqrt(kEstimates * exact), 5.4) << "bias, " << count;
  }
}

// Of the mean of f = (x − ½)(y − ½), as A. B. Owen derives it ("Monte Carlo variance of scrambled net quadrature",
// 1997, in base 2): Var = (1/N) Σ_{k, l ≥ 0} Γ_kl σ²_kl, where σ²_kl is the variance of f at level k of x and l of y,
// and
//   Γ_kl = (1/N) Σ_{i, j} Π_{x, y} (2 · [same interval of level k + 1] − [same interval of level k])
// over all pairs of the unscrambled points. Here x − ½ = Σ_k (digit_k − ½) 2^−(k+1), so σ²_kl = 4^−(k+l)/256. Beyond k
// = m − 1 no two points share an interval, so Γ_kl = 1. 32768 squared errors against their own spread; false alarm
// 4e-8.
TEST(HammersleyOwen, VarianceOfAProductIsOwensForScrambledNets) {
  constexpr std::uint32_t kGroups = 2048;
  constexpr double kEstimates = kGroups * kLanes;
  const auto sampler = sampler_named("hammersley-owen");
  for (const int m : {3, 5}) {
    const std::uint64_t count = 1u << m;
    const double n = static_cast<double>(count);
    const Points plain = points_of(*sampler_named("hammersley"), count, {{2}});
    const auto factor = [&](int dim, int level, std::uint64_t i, std::uint64_t j) {
      const auto same = [&](std::uint64_t intervals) {
        return plain.interval(dim, i, 0, intervals) == plain.interval(dim, j, 0, intervals) ? 1.0 : 0.0;
      };
      return 2 * same(2u << level) - same(1u << level);
    };
    double exact = 1.0 / (144 * n), gains = 0;  // all Γ = 1, and what differs from that
    for (int k = 0; k < m; ++k) {
      for (int l = 0; l < m; ++l) {
        double gamma = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
          for (std::uint64_t j = 0; j < count; ++j) gamma += factor(0, k, i, j) * factor(1, l, i, j) / n;
        }
        if (k + l + 2 <= m) {
          ASSERT_NEAR(gamma, 0, 1e-12) << "a (0, m, 2)-net takes the coarse levels away";
        }
        gains += (gamma - 1) * std::pow(0.25, k + l) / 256;
      }
    }
    exact += gains / n;
    double sum = 0, squares = 0, fourths = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, count, {{2}}, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        double error = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
          error += (points(0, i, lane) - 0.5) * (points(1, i, lane) - 0.5) / n;
        }
        sum += error;
        squares += error * error;
        fourths += std::pow(error, 4);
      }
    }
    const double variance = squares / kEstimates;
    const double se = std::sqrt((fourths / kEstimates - variance * variance) / kEstimates);
    EXPECT_LT(std::abs(variance - exact) / se, 5.5) << "2^" << m << ": " << variance << " for " << exact;
    EXPECT_LT(std::abs(sum) / std::sqrt(kEstimates * exact), 5.5) << "bias, 2^" << m;
  }
}

}  // namespace
}  // namespace halfslope
