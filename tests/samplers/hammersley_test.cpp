#include "samplers/hammersley.h"

#include <gtest/gtest.h>

#include <cmath>

#include "samplers/radical_inverse.h"
#include "tests/samplers/nets.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

TEST(Hammersley, IsTheIndexOverNAndThenHalton) {
  __extension__ using Wide = unsigned __int128;
  const auto sampler = sampler_named("hammersley");
  for (const std::uint64_t count : {1u, 2u, 3u, 16u, 100u, 1009u, 4096u, 10007u}) {
    const Points points = points_of(*sampler, count, singles(12));
    for (std::uint64_t i = 0; i < count; ++i) {
      ASSERT_EQ(points.at(0, i, 5), static_cast<std::uint64_t>((Wide{i} << 53) / count)) << i << '/' << count;
      for (int dim = 1; dim < 12; ++dim) {
        ASSERT_EQ(points(dim, i, 5), radical_inverse(primes()[static_cast<std::size_t>(dim - 1)], i))
            << dim << ' ' << i;
      }
    }
  }
}

TEST(Hammersley, OnePreparedSamplerServesCountAfterCount) {
  const auto sampler = sampler_named("hammersley");
  for (const std::uint64_t count : {64u, 100u, 64u, 7u}) {
    EXPECT_EQ(points_of(*sampler, count, {{2, 1}}), points_of(*sampler_named("hammersley"), count, {{2, 1}})) << count;
  }
}

TEST(Hammersley, PowersOfTwoAreNetsInBaseTwo) {
  const auto sampler = sampler_named("hammersley");
  for (int m = 0; m <= 10; ++m) EXPECT_TRUE(is_net(points_of(*sampler, 1u << m, {{2}}), m, 0)) << m;
}

TEST(Hammersley, EveryCountTo31BitsIsLegalAndReachesItsLastPoint) {
  const auto sampler = sampler_named("hammersley");
  const Layout layout = {{2, 2}};
  for (const std::uint64_t count : {(1ull << 31) - 1, 1ull << 31}) {
    ASSERT_FALSE(sampler->illegal(count, layout));
    sampler->prepare({.count = count, .layout = &layout, .key = kTestKey, .low_words = true});
    PointBlock block;
    block.reset(4, 2, true);
    sampler->fill(count - 2, block);
    for (int s = 0; s < 2; ++s) {
      const std::uint64_t i = count - 2 + static_cast<std::uint64_t>(s);
      // 1 − k/N rounded down to 2⁻⁵³: in long double, whose 64 bits hold the quotient to within 2⁻⁶⁴.
      const long double exact = static_cast<long double>(i) / static_cast<long double>(count);
      EXPECT_EQ(block.coordinate(0, s, 0), static_cast<double>(std::floor(exact * 0x1p53L) * 0x1p-53L));
      EXPECT_EQ(block.coordinate(1, s, 0), radical_inverse(2, i));
      EXPECT_EQ(block.coordinate(3, s, 0), radical_inverse(5, i));
    }
  }
  EXPECT_EQ(sampler->illegal((1ull << 31) + 1, layout)->below, 1ull << 31);
}

}  // namespace
}  // namespace halfslope
