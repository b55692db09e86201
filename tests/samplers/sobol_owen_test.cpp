#include "samplers/sobol_owen.h"

#include <gtest/gtest.h>

#include "core/kernel_library.h"
#include "tests/samplers/net_variance.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

TEST(SobolOwen, VarianceIsOwensForScrambledNets) {
  for (const auto& [dims, digits] : {std::pair{1, 4}, std::pair{2, 5}, std::pair{3, 5}, std::pair{4, 3}}) {
    const std::uint64_t count = 1u << digits;
    const Points plain = points_of(*sampler_named("sobol"), count, singles(dims));
    const double exact = product_variance(plain, dims, 2, digits);
    if (dims == 1) {
      EXPECT_NEAR(exact * 12 * std::pow(16.0, 3), 1, 1e-12) << "one point in each stratum";
    }
    for (const char* name : {"sobol-owen", "sobol-owen-fast"}) expect_product_variance(name, dims, count, exact);
  }
}

TEST(SobolOwen, ManyDimensionsAreTheSameAsFew) {
  // However small the tables become that so many dimensions share.
  for (const char* name : {"sobol-owen", "sobol-owen-fast"}) {
    const auto sampler = sampler_named(name);
    const int dims = sampler->info().max_dims;
    const Points few = points_of(*sampler, 700, singles(3));
    const Layout layout = singles(dims);
    sampler->prepare({.count = 700, .layout = &layout, .key = kTestKey, .pixel = 7, .low_words = true});
    PointBlock block;
    std::vector<int> seen(64);
    for (const std::uint64_t begin : {0u, 320u, 636u}) {
      block.reset(dims, 64, true);
      sampler->fill(begin, block);
      for (int s = 0; s < 64; ++s) {
        for (int lane = 0; lane < kLanes; ++lane) {
          for (int d = 0; d < 3; ++d) {
            ASSERT_EQ(block.coordinate(d, s, lane), few(d, begin + static_cast<std::uint64_t>(s), lane)) << name;
          }
        }
        if (begin == 0) ++seen[block.high(dims - 1)[s * kLanes] >> 26];
      }
    }
    EXPECT_EQ(seen, std::vector<int>(64, 1)) << name;
  }
}

TEST(SobolOwen, LastPointsAreTheSameOnEveryIsaAndPartFromTheirNeighbours) {
  for (const char* name : {"sobol-owen", "sobol-owen-fast"}) {
    std::vector<std::vector<std::uint32_t>> words;
    const Layout layout = singles(3);
    for (const Isa isa : supported_isas()) {
      const IsaScope scope(to_string(isa));
      const auto sampler = sampler_named(name);
      sampler->prepare({.count = 1ull << 31, .layout = &layout, .key = kTestKey, .low_words = true});
      PointBlock block;
      block.reset(3, 300, true);
      sampler->fill((1ull << 31) - 300, block);
      words.emplace_back(block.high(0), block.high(0) + 3 * block.stride());
      // In the first dimension the last two points differ in digit 0, and the last but two has digit 0 alone in common.
      for (int lane = 0; lane < kLanes; ++lane) {
        EXPECT_EQ((block.high(0)[299 * kLanes + lane] ^ block.high(0)[298 * kLanes + lane]) >> 31, 1u);
        EXPECT_EQ((block.high(0)[299 * kLanes + lane] ^ block.high(0)[297 * kLanes + lane]) >> 30, 1u);
      }
    }
    for (const auto& other : words) EXPECT_EQ(other, words[0]) << name;
  }
}

}  // namespace
}  // namespace halfslope
