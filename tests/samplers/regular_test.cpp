#include "samplers/regular.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/samplers/points.h"

namespace halfslope {
namespace {

__extension__ using Wide = unsigned __int128;

TEST(Regular, PointsAreTheCentresRoundedDown) {
  for (const std::uint64_t side : {1u, 2u, 3u, 7u, 10u, 999u, 4096u, 5003u}) {
    const Points points = points_of(*make_regular(), side, singles(1));
    for (std::uint64_t k = 0; k < side; ++k) {
      const auto centre = static_cast<std::uint64_t>((Wide{2 * k + 1} << 53) / (2 * side));
      for (int lane = 0; lane < kLanes; ++lane) ASSERT_EQ(points.at(0, k, lane), centre) << side << ' ' << k;
    }
  }
}

TEST(Regular, LastCentresOfTheLargestGridAreExactToo) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
  const Layout layout = singles(1);
  const auto sampler = make_regular();
  sampler->prepare({.count = kMost - 1, .layout = &layout, .key = kTestKey, .low_words = true});
  PointBlock block;
  block.reset(1, 64, true);
  sampler->fill(kMost - 65, block);
  for (std::uint64_t s = 0; s < 64; ++s) {
    const auto centre = static_cast<std::uint64_t>((Wide{2 * (kMost - 65 + s) + 1} << 53) / (2 * (kMost - 1)));
    const std::uint64_t bits = std::uint64_t{block.high(0)[s * kLanes]} << 21 | block.low(0)[s * kLanes];
    ASSERT_EQ(bits, centre) << s;
  }
}

TEST(Regular, EveryCellOfTheGridHasItsCentre) {
  for (const auto& [side, dims] : {std::pair{2, 5}, {3, 3}, {10, 2}, {5, 4}}) {
    std::uint64_t count = 1;
    for (int d = 0; d < dims; ++d) count *= static_cast<std::uint64_t>(side);
    const Points points = points_of(*make_regular(), count, singles(dims), 0, 7, kTestKey, 0, 13);
    std::set<std::vector<std::uint64_t>> cells;
    for (std::uint64_t i = 0; i < count; ++i) {
      std::vector<std::uint64_t> cell;
      for (int d = 0; d < dims; ++d) {
        cell.push_back(points.interval(d, i, 0, static_cast<std::uint64_t>(side)));
        const double centre = (static_cast<double>(cell.back()) + 0.5) / side;
        ASSERT_NEAR(points(d, i, 0), centre, 0x1p-53);
      }
      ASSERT_TRUE(cells.insert(cell).second);
    }
  }
}

TEST(Regular, AWaveOfTheGridsOwnFrequencyLooksConstant) {
  // cos 2πnx integrates to 0, and is −1 at every centre: n x is an odd multiple of ½, to n units in the last place.
  constexpr std::uint64_t kSide = 37;
  const Points points = points_of(*make_regular(), kSide * kSide, {{2}});
  for (std::uint64_t i = 0; i < points.count(); ++i) {
    const std::uint64_t phase = (points.at(0, i, 0) * kSide) & ((std::uint64_t{1} << 53) - 1);
    ASSERT_LE((std::uint64_t{1} << 52) - phase, kSide);
  }
}

TEST(Regular, OnlyPowersOfTheDimensionAreLegal) {
  const auto sampler = make_regular();
  EXPECT_FALSE(sampler->illegal(243, singles(5)));
  const auto neighbours = sampler->illegal(242, singles(5));
  ASSERT_TRUE(neighbours);
  EXPECT_EQ(neighbours->below, 32u);
  EXPECT_EQ(neighbours->above, 243u);
}

}  // namespace
}  // namespace halfslope
