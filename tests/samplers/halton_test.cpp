#include "samplers/halton.h"

#include <gtest/gtest.h>

#include "core/coordinates.h"
#include "samplers/radical_inverse.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

TEST(Halton, DimensionsAreTheRadicalInversesOfThePrimes) {
  const auto sampler = sampler_named("halton");
  const Points points = points_of(*sampler, 300, singles(1024));
  for (int dim = 0; dim < 1024; ++dim) {
    for (std::uint64_t i = 0; i < 300; ++i) {
      ASSERT_EQ(points(dim, i, 3), radical_inverse(primes()[static_cast<std::size_t>(dim)], i)) << dim << ' ' << i;
    }
  }
}

TEST(Halton, FirstPointsAreThoseOfThePaper) {
  // Halton 1960 numbers them from 1; from 0 they are (0, 0), (1/2, 1/3), (1/4, 2/3), (3/4, 1/9), (1/8, 4/9), (5/8,
  // 7/9).
  const Points points = points_of(*sampler_named("halton"), 6, {{2}});
  constexpr double kX[] = {0, 0.5, 0.25, 0.75, 0.125, 0.625};
  constexpr std::uint64_t kNinths[] = {0, 3, 6, 1, 4, 7};
  for (std::uint64_t i = 0; i < 6; ++i) {
    EXPECT_EQ(points(0, i, 0), kX[i]);
    EXPECT_EQ(points.at(1, i, 0), (kNinths[i] << 53) / 9);
  }
}

TEST(Halton, HoldsWhereOthersRoundToOne) {
  // 30-digit answers at indices where digit-by-digit sums in binary32 or binary64 err or give 1.
  struct Case {
    int dim;
    std::uint64_t index;
    long double exact;
  };
  constexpr Case kCases[] = {{0, 1, 0.5L},
                             {1, 43046720, 0.999999976769426874581225362090L},
                             {1, 129140162, 0.999999992256475624860408454030L},
                             {2, 1000000007, 0.440000249036800000000000000000L}};
  const auto sampler = sampler_named("halton");
  const Layout layout = {{2, 1}};
  for (const Case& c : kCases) {
    sampler->prepare({.count = 1u << 31, .layout = &layout, .key = kTestKey, .low_words = true});
    PointBlock block;
    block.reset(3, 1, true);
    sampler->fill(c.index, block);
    const long double error = static_cast<long double>(block.coordinate(c.dim, 0, 0)) - c.exact;
    EXPECT_TRUE(-0x1p-53L - 0x1p-63L < error && error <= 0x1p-63L) << c.dim << ' ' << c.index;
    float single[kLanes];
    to_coordinates(block.high(c.dim), block.low(c.dim), kLanes, single);
    const long double error32 = static_cast<long double>(single[0]) - c.exact;
    EXPECT_TRUE(-0x1p-24L - 0x1p-63L < error32 && error32 <= 0x1p-63L) << c.dim << ' ' << c.index;
    EXPECT_EQ(single[0], radical_inverse_f32(primes()[static_cast<std::size_t>(c.dim)], c.index));
  }
}

TEST(Halton, EveryCountTo31BitsIsLegal) {
  for (const char* name : {"halton", "halton-cp"}) {
    const auto sampler = sampler_named(name);
    for (const std::uint64_t count : {1ull, 3ull, 1000003ull, (1ull << 31) - 1, 1ull << 31}) {
      EXPECT_FALSE(sampler->illegal(count, singles(1024))) << name << ' ' << count;
    }
    EXPECT_EQ(sampler->illegal((1ull << 31) + 1, singles(2))->below, 1ull << 31);
  }
}

}  // namespace
}  // namespace halfslope
