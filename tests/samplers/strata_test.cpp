#include "samplers/strata.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

WordSource words_of(std::uint32_t replicate, std::uint32_t pixel = 0) {
  WordSource words;
  words.prepare({.count = 1, .layout = nullptr, .key = kTestKey, .pixel = pixel, .replicate = replicate});
  return words;
}

TEST(Strata, EdgesAreTheFractionsRoundedUpAndPointsStayInside) {
  Strata strata;
  for (const std::uint64_t count : {1u, 2u, 3u, 5u, 7u, 100u, 4096u, 4097u, 100003u, 1u << 31}) {
    strata.reset(count);
    const std::uint64_t stride = std::max<std::uint64_t>(1, count / 100003);
    std::uint64_t covered = 0;
    for (std::uint64_t i = 0; i < count; i += stride) {
      // The first and the last words of stratum [i/count, (i+1)/count) are the least with word · count ≥ i · 2³² and
      // the greatest with word · count < (i+1) · 2³².
      const std::uint64_t first = strata.place(i, 0), last = strata.place(i, 0xffffffffu);
      ASSERT_GE(first * count, i << 32) << count << ' ' << i;
      if (i > 0) {
        ASSERT_LT((first - 1) * count, i << 32) << count << ' ' << i;
      }
      ASSERT_LT(last * count, (i + 1) << 32) << count << ' ' << i;
      ASSERT_GE((last + 1) * count, (i + 1) << 32) << count << ' ' << i;
      ASSERT_LE(last, 0xffffffffu);
      const std::uint64_t middle = strata.place(i, 0x80000000u);
      ASSERT_NEAR(static_cast<double>(middle), 0.5 * static_cast<double>(first + last), 1.0);
      covered += last - first + 1;
    }
    if (stride == 1) {
      EXPECT_EQ(covered, std::uint64_t{1} << 32) << "the strata of " << count;
    }
  }
}

TEST(Strata, ARowOfLanesIsPlacedLikeEachAlone) {
  Strata strata;
  for (const std::uint64_t count : {1u, 2u, 3u, 4u, 4096u, 4097u, 8192u, 1u << 20, 1u << 31}) {
    strata.reset(count);
    std::uint32_t cells[kLanes], words[kLanes], placed[kLanes];
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      cells[lane] = static_cast<std::uint32_t>((count - 1) * lane / (kLanes - 1));
      words[lane] = placed[lane] = random_word(kTestKey, Draw::kHigh, 0, lane, 0, 0) | (lane < 2 ? ~0u : 0u);
    }
    strata.place_lanes(cells, placed);
    for (int lane = 0; lane < kLanes; ++lane) ASSERT_EQ(placed[lane], strata.place(cells[lane], words[lane])) << count;
    for (const std::uint32_t cell : cells) {
      std::copy_n(words, kLanes, placed);
      strata.place_row(cell, placed);
      for (int lane = 0; lane < kLanes; ++lane) ASSERT_EQ(placed[lane], strata.place(cell, words[lane])) << count;
    }
  }
}

TEST(LanePermutation, IsABijectionInEveryLane) {
  LanePermutation permutation;
  for (const std::uint64_t count :
       {1u, 2u, 3u, 5u, 64u, 65u, 1000u, 4095u, 4096u, 4097u, 5000u, 8191u, 8192u, 8193u, 100003u}) {
    permutation.prepare(words_of(3), 11, count);
    std::vector<std::uint8_t> seen(count);
    for (int lane = 0; lane < kLanes; ++lane) {
      std::fill(seen.begin(), seen.end(), std::uint8_t{0});
      for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t image = permutation.at(i, lane);
        std::uint32_t row[kLanes];
        permutation.lanes(i, row);
        ASSERT_EQ(row[lane], image);
        ASSERT_LT(image, count);
        ASSERT_EQ(seen[image]++, 0) << count << " lane " << lane << " index " << i;
      }
    }
  }
}

TEST(LanePermutation, EveryOrderOfAFewElementsIsEquallyLikely) {
  // 65536 replicates; χ² with N! − 1 degrees of freedom, false alarm 1e-7 each.
  constexpr std::uint32_t kGroups = 4096;
  LanePermutation permutation;
  for (const std::uint64_t count : {2u, 3u, 4u, 5u}) {
    std::map<std::uint64_t, std::uint32_t> orders;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      permutation.prepare(words_of(group * kLanes), 0, count);
      for (int lane = 0; lane < kLanes; ++lane) {
        std::uint64_t order = 0;
        for (std::uint64_t i = 0; i < count; ++i) order = order * count + permutation.at(i, lane);
        ++orders[order];
      }
    }
    std::vector<std::uint32_t> counts;
    for (const auto& [order, times] : orders) counts.push_back(times);
    const double factorial = std::tgamma(static_cast<double>(count + 1));
    ASSERT_EQ(static_cast<double>(counts.size()), factorial) << "orders of " << count;
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(counts)), chi_squared_upper(factorial - 1, 1e-7)) << count;
  }
}

// Where elements go, over replicates: for indices i and j, 16 × 16 bins of (π(i), π(j)), and 32 bins of the difference
// π(j) − π(i) mod N. Bins of N = 5000 differ by at most one place in 312, which moves χ² by less than 1 here.
void check_pairs(std::uint64_t count) {
  constexpr std::uint32_t kGroups = 4096;
  constexpr std::array<std::array<std::uint64_t, 2>, 6> kPairs = {
      {{0, 1}, {0, 2}, {1, 2}, {0, 64}, {7, 4071}, {2499, 2500}}};
  std::array<std::array<std::uint32_t, 256>, kPairs.size()> joint = {};
  std::array<std::array<std::uint32_t, 32>, kPairs.size()> difference = {};
  std::array<std::uint32_t, 64> place = {};
  LanePermutation permutation;
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    permutation.prepare(words_of(group * kLanes), 0, count);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (std::size_t p = 0; p < kPairs.size(); ++p) {
        const std::uint64_t a = permutation.at(kPairs[p][0], lane), b = permutation.at(kPairs[p][1], lane);
        ++joint[p][a * 16 / count * 16 + b * 16 / count];
        ++difference[p][(b + count - a) % count * 32 / count];
      }
      ++place[permutation.at(1234, lane) * 64 / count];
    }
  }
  // False alarm 1e-8 each, 13 of them.
  EXPECT_LT(chi_squared(std::span<const std::uint32_t>(place)), chi_squared_upper(63, 1e-8)) << count;
  for (std::size_t p = 0; p < kPairs.size(); ++p) {
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(joint[p])), chi_squared_upper(255, 1e-8))
        << count << " pair " << p;
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(difference[p])), chi_squared_upper(31, 1e-8))
        << count << " pair " << p;
  }
}

TEST(LanePermutation, ShuffledPlacesAreUniformAndPairsIndependent) { check_pairs(4096); }
TEST(LanePermutation, WalkedPlacesAreUniformAndPairsIndependent) {
  check_pairs(5000);
  check_pairs(1 << 20);
}

}  // namespace
}  // namespace halfslope
