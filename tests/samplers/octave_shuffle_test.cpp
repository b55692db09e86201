#include "samplers/octave_shuffle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>

#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

/// Where the first `count` indices go in each lane, by (index, lane).
std::vector<std::uint32_t> order_of(std::uint64_t count, std::uint32_t replicate = 0, int dim = 2,
                                    std::uint32_t pixel = 0) {
  WordSource words;
  words.prepare({.count = 1, .layout = nullptr, .key = kTestKey, .pixel = pixel, .replicate = replicate});
  OctaveShuffle shuffle;
  shuffle.prepare(words, dim);
  std::vector<std::uint32_t> order(count * kLanes);
  shuffle.rows(0, static_cast<int>(count), order.data());
  return order;
}

TEST(OctaveShuffle, OctavesArePermutedWithinThemselvesAndAlignedRunsStayRuns) {
  const auto order = order_of(8192);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::uint64_t run = 16; run <= 4096; run *= 2) {
      for (std::uint64_t begin = 0; begin < 8192; begin += run) {
        std::vector<std::uint32_t> to;
        for (std::uint64_t i = begin; i < begin + run; ++i) to.push_back(order[i * kLanes + lane]);
        std::sort(to.begin(), to.end());
        ASSERT_EQ(to.front() % run, 0u);
        for (std::uint32_t i = 0; i < run; ++i) ASSERT_EQ(to[i], to[0] + i) << run << " from " << begin;
      }
    }
    for (std::uint32_t i = 1; i < 8192; ++i) {
      ASSERT_EQ(std::bit_width(order[i * kLanes + lane]), std::bit_width(i)) << "of the same octave";
    }
  }
}

TEST(OctaveShuffle, OrderDoesNotDependOnHowItIsAskedFor) {
  const auto order = order_of(1000);
  WordSource words;
  words.prepare({.count = 1, .layout = nullptr, .key = kTestKey, .pixel = 0, .replicate = 0});
  OctaveShuffle shuffle;
  shuffle.prepare(words, 2);
  for (const std::uint64_t i : {999u, 0u, 17u, 16u, 15u, 31u, 500u}) {
    std::array<std::uint32_t, kLanes> row;
    shuffle.rows(i, 1, row.data());
    for (std::size_t l = 0; l < kLanes; ++l) EXPECT_EQ(row[l], order[i * kLanes + l]);
  }
}

TEST(OctaveShuffle, PlacesWithinAnOctaveAreUniformAndPairsIndependent) {
  // Of [64, 128) over 16384 replicates: where indices 64, 80 and 127 go, 64 places, 63 degrees; and the blocks that 64
  // and 96, in different halves, go to within their halves (2 × 2), the blocks of 64 and 80 within theirs, and the
  // places within the block of two neighbours (16 × 16 without the diagonal, 239 degrees). The same index in two lanes,
  // dimensions and pixels: 16 × 16, 255 degrees. False alarm 1e-8 for each of 8.
  std::array<std::array<std::uint32_t, 64>, 3> places = {};
  std::array<std::uint32_t, 4> blocks = {};
  std::array<std::uint32_t, 256> neighbours = {};
  std::array<std::array<std::uint32_t, 256>, 3> others = {};
  for (std::uint32_t group = 0; group < 1024; ++group) {
    const auto order = order_of(128, group * kLanes), dim = order_of(128, group * kLanes, 3),
               pixel = order_of(128, group * kLanes, 2, 1);
    for (std::size_t l = 0; l < kLanes; ++l) {
      const auto to = [&](std::size_t i) { return order[i * kLanes + l]; };
      const std::array<std::size_t, 3> from = {64, 80, 127};
      for (std::size_t k = 0; k < 3; ++k) ++places[k][to(from[k]) - 64];
      ++blocks[to(64) / 16 % 2 * 2 + to(96) / 16 % 2];
      ++neighbours[to(64) % 16 * 16 + to(65) % 16];
      const std::uint32_t here = (to(70) - 64) / 4;
      ++others[0][here * 16 + (order[70 * kLanes + (l + 1) % kLanes] - 64) / 4];
      ++others[1][here * 16 + (dim[70 * kLanes + l] - 64) / 4];
      ++others[2][here * 16 + (pixel[70 * kLanes + l] - 64) / 4];
    }
  }
  for (const auto& counts : places) {
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(counts)), chi_squared_upper(63, 1e-8));
  }
  EXPECT_LT(chi_squared(std::span<const std::uint32_t>(blocks)), chi_squared_upper(3, 1e-8));
  std::vector<std::uint32_t> different;
  for (std::size_t i = 0; i < 256; ++i) {
    if (i / 16 != i % 16) different.push_back(neighbours[i]);
  }
  EXPECT_LT(chi_squared(std::span<const std::uint32_t>(different)), chi_squared_upper(239, 1e-8));
  for (const auto& counts : others) {
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(counts)), chi_squared_upper(255, 1e-8));
  }
}

}  // namespace
}  // namespace halfslope
