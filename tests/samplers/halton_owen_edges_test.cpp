// The scrambled Halton kernel where rounding is at its worst: fractions of an interval that are nearly 0 and nearly 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/kernel_library.h"
#include "core/point_block.h"
#include "samplers/kernels.h"

namespace halfslope {
namespace {

std::uint32_t mix(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x21f0aaadu;
  x = (x ^ (x >> 15)) * 0x735a2d97u;
  return x ^ (x >> 15);
}
std::uint32_t inverse_of(std::uint32_t odd) {  // mod 2³², by Newton's iteration
  std::uint32_t x = odd;
  for (int i = 0; i < 5; ++i) x *= 2 - odd * x;
  return x;
}
std::uint32_t unmix(std::uint32_t x) {
  x ^= x >> 15 ^ x >> 30;
  x *= inverse_of(0x735a2d97u);
  x ^= x >> 15 ^ x >> 30;
  x *= inverse_of(0x21f0aaadu);
  return x ^ x >> 16;
}

/// The second key under which the kernel's hash of `index`, mix(mix(index ^ key₀) + key₁) with key₀ = 0, is `word`.
std::uint32_t key_for(std::uint32_t word, std::uint32_t index) { return unmix(word) - mix(index); }

TEST(HaltonOwenEdges, PointsStayInTheirIntervalsAndBelowOneAtBothEndsOfTheirFractions) {
  // Points a·b of base b, whose parent is the origin, in the table at the middle of the last of b intervals: digits
  // (b−1, h·a), among them the last of all b² intervals. Whatever the hashed fraction of its interval, a point's
  // interval is the same; fractions are 0, ½ and 1 − 2⁻³² before rounding. Bases whose square lies just under a power
  // of two, where 1/b² is rounded worst.
  using Fraction = std::array<std::uint32_t, 3>;
  constexpr Fraction kWords = {0, 0x80000000u, 0xffffffffu};
  for (const Isa isa : supported_isas()) {
    const auto& table = kernels<SamplerKernels>(isa);
    std::array<std::uint32_t, 4 * kLanes> keys = {};
    for (const std::uint32_t word : kWords) {  // that key_for() knows the kernel's hash: the origin is (word + ½)/2³²
      std::fill_n(keys.begin() + kLanes, kLanes, key_for(word, 0));
      AlignedBuffer<double> origin(kLanes);
      table.halton_owen_table(2, keys.data(), 1, origin.data());
      ASSERT_EQ(origin[5], (word + 0.5) * 0x1p-32);
    }
    for (const std::uint32_t base : {983u, 997u, 1019u, 1303u, 1409u, 2609u, 2851u, 4093u, 5791u, 7369u, 8161u}) {
      const std::uint64_t intervals = std::uint64_t{base} * base;
      AlignedBuffer<double> start(std::size_t{base} * kLanes);
      std::fill_n(start.data(), kLanes, 1 - 0.5 / base + 0.25 / static_cast<double>(intervals));
      const HaltonDim dim = {base, 1, start.data(), keys.data()};
      bool last = false;
      for (std::uint32_t a = 1; a < base; ++a) {
        std::array<std::uint64_t, 3> interval;
        for (std::size_t w = 0; w < kWords.size(); ++w) {
          std::fill_n(keys.begin() + kLanes, kLanes, key_for(kWords[w], a * base));
          std::array<std::uint32_t, kLanes> high, low;
          const std::uint32_t index = a * base;
          table.halton_owen(dim, &index, 1, high.data(), low.data());
          const std::uint64_t top = high[3] * intervals, bottom = (std::uint64_t{low[3]} << 11) * intervals;
          interval[w] = (top + (bottom >> 32)) >> 32;
        }
        ASSERT_EQ(interval[0], interval[1]) << "base " << base << " a " << a << ' ' << to_string(isa);
        ASSERT_EQ(interval[2], interval[1]) << "base " << base << " a " << a << ' ' << to_string(isa);
        last = last || interval[1] == intervals - 1;
      }
      EXPECT_TRUE(last) << "the last interval was not met in base " << base;
    }
  }
}

}  // namespace
}  // namespace halfslope
