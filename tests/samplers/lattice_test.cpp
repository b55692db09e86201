#include "samplers/lattice.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tests/samplers/points.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kMask = (std::uint64_t{1} << 53) - 1;

/// Differences to point 0, modulo 1, of one lane.
std::vector<std::vector<std::uint64_t>> unshifted(const Points& points, int dims, int lane) {
  std::vector<std::vector<std::uint64_t>> differences;
  for (std::uint64_t i = 0; i < points.count(); ++i) {
    std::vector<std::uint64_t> x;
    for (int d = 0; d < dims; ++d) x.push_back((points.at(d, i, lane) - points.at(d, 0, lane)) & kMask);
    differences.push_back(std::move(x));
  }
  return differences;
}

TEST(Lattice, FirstPowersOfTwoAreGroupsBeforeTheShift) {
  constexpr int kDims = 10;
  for (int m = 0; m <= 8; ++m) {
    const std::uint64_t count = std::uint64_t{1} << m;
    const auto points = unshifted(points_of(*make_lattice(), count, singles(kDims)), kDims, 3);
    const std::set<std::vector<std::uint64_t>> set(points.begin(), points.end());
    ASSERT_EQ(set.size(), count);
    for (const auto& a : points) {
      for (const auto& b : points) {
        std::vector<std::uint64_t> sum;
        for (std::size_t d = 0; d < kDims; ++d) sum.push_back((a[d] + b[d]) & kMask);
        ASSERT_TRUE(set.contains(sum));
      }
    }
  }
}

TEST(Lattice, EveryDimensionOfAPowerOfTwoIsEvenlySpaced) {
  constexpr int kDims = 250;
  constexpr std::uint64_t kCount = 256;
  const auto points = unshifted(points_of(*make_lattice(), kCount, singles(kDims)), kDims, 0);
  for (std::size_t d = 0; d < kDims; ++d) {
    std::set<std::uint64_t> places;
    for (const auto& x : points) {
      ASSERT_EQ(x[d] % (std::uint64_t{1} << 45), 0u);
      places.insert(x[d] >> 45);
    }
    ASSERT_EQ(places.size(), kCount) << d;
  }
}

TEST(Lattice, GeneratingVectorIsThePublishedOne) {
  const std::vector<std::uint32_t> first = {1, 182667, 469891, 498753, 110745, 446247, 250185, 118627, 245333, 283199};
  const auto z = lattice_vector();
  ASSERT_EQ(z.size(), 250u);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), z.begin()));
  EXPECT_EQ(z.back(), 480757u);
  for (const std::uint32_t component : z) EXPECT_TRUE(component % 2 == 1 && component < 1u << 20);
  // Point 2¹⁹ has the radical inverse 2⁻²⁰, so it is z/2²⁰ from the first.
  const Layout layout = singles(250);
  const auto sampler = make_lattice();
  sampler->prepare({.count = 1u << 20, .layout = &layout, .key = kTestKey, .low_words = true});
  PointBlock origin, point;
  origin.reset(250, 1, true);
  point.reset(250, 1, true);
  sampler->fill(0, origin);
  sampler->fill(1u << 19, point);
  for (int d = 0; d < 250; ++d) EXPECT_EQ(point.high(d)[0] - origin.high(d)[0], z[static_cast<std::size_t>(d)] << 12);
}

TEST(Lattice, WavesOfTheDualLatticeAreNotIntegrated) {
  // h · z = 0 mod N: cos 2π h · x integrates to 0 over the square, and has the same value at all N points.
  constexpr std::uint64_t kCount = 1024;
  std::uint64_t h = 0, length = kCount;  // the shortest wave (h, −h z mod N) found along dimension 0
  std::uint64_t g = 0;
  const std::uint64_t z = lattice_vector()[1] % kCount;
  for (std::uint64_t k = 1; k < kCount; ++k) {
    const std::uint64_t other = (kCount - k * z % kCount) % kCount;  // k z + other = 0 mod N
    if (k + other < length) length = k + other, g = k, h = other;
  }
  ASSERT_LT(length, 100u) << "no wave that a picture could hold";
  const Points points = points_of(*make_lattice(), kCount, {{2}});
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto phase = [&](std::uint64_t i) { return (h * points.at(0, i, lane) + g * points.at(1, i, lane)) & kMask; };
    for (std::uint64_t i = 1; i < kCount; ++i) ASSERT_EQ(phase(i), phase(0));
  }
}

TEST(Lattice, TheTentFoldsEachPointAndLosesNoBit) {
  constexpr int kDims = 5;
  const Points plain = points_of(*make_lattice(), 4096, singles(kDims));
  const Points folded = points_of(*make_lattice_tent(), 4096, singles(kDims));
  constexpr std::uint64_t kHalf = std::uint64_t{1} << 52, kTwo = std::uint64_t{1} << 54;
  for (int d = 0; d < kDims; ++d) {
    for (std::uint64_t i = 0; i < 4096; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const std::uint64_t x = plain.at(d, i, lane), t = folded.at(d, i, lane);
        ASSERT_EQ(t, x < kHalf ? 2 * x : kTwo - 1 - 2 * x);  // 1 − |2x − 1|, less a unit where it falls
        // It can be undone, so it is a bijection of the 2⁵³ coordinates and keeps the uniform measure.
        ASSERT_EQ(t % 2 == 0 ? t / 2 : (kTwo - 1 - t) / 2, x);
      }
    }
  }
}

TEST(Lattice, EndsAtTwoToTheTwenty) {
  for (const auto& sampler : {make_lattice(), make_lattice_tent()}) {
    EXPECT_FALSE(sampler->illegal(1u << 20, singles(250)));
    EXPECT_FALSE(sampler->illegal(999, singles(250)));
    const auto more = sampler->illegal((1u << 20) + 1, singles(250));
    ASSERT_TRUE(more);
    EXPECT_EQ(more->below, 1u << 20);
    EXPECT_EQ(more->above, std::nullopt);
  }
}

}  // namespace
}  // namespace halfslope
