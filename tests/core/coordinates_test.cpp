#include "core/coordinates.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace halfslope {
namespace {

template <class T>
T coordinate(std::uint32_t high, const std::uint32_t* low = nullptr) {
  T out;
  to_coordinates(&high, low, 1, &out);
  return out;
}

TEST(Coordinates, WordsWhereTheTextbookFormulaFails) {
  // x · 2⁻³², with the relative errors that two roundings stay under. float(x) · 2⁻³² gives 1 for the first (2.98e-8 of
  // all draws); a coordinate is never 1. One binary32 step holds the smallest word nowhere, so it is 0 there.
  struct Case {
    std::uint32_t word;
    long double exact;
    double f64, f32;
  };
  constexpr double kSingle = 4.76837158203125e-07, kDouble = 8.881784197001252e-16;
  for (const Case& c : {Case{4294967168u, 0.9999999701976776123046875L, kDouble, kSingle},
                        Case{4294967167u, 0.999999969964846968650817871094L, kDouble, kSingle},
                        Case{1u, 2.32830643653869628906250000000e-10L, kDouble, 1}, Case{0u, 0, 0, 0}}) {
    const double f64 = coordinate<double>(c.word);
    const float f32 = coordinate<float>(c.word);
    EXPECT_LE(std::abs(static_cast<long double>(f64) - c.exact), c.f64 * c.exact) << c.word;
    EXPECT_LE(std::abs(static_cast<long double>(f32) - c.exact), c.f32 * c.exact) << c.word;
    EXPECT_LT(f64, 1);
    EXPECT_LT(f32, 1.0f);
  }
  EXPECT_EQ(coordinate<float>(1), 0.0f);
  EXPECT_EQ(coordinate<float>(0xffffffffu), 0x1.fffffep-1f);
  const std::uint32_t low = 0x1fffffu;
  EXPECT_EQ(coordinate<double>(0xffffffffu, &low), 1 - 0x1p-53);
}

TEST(Coordinates, Binary64IsExactAndBinary32ItsTop24Bits) {
  std::mt19937_64 random(3);
  constexpr std::size_t kCount = 10001;  // not a multiple of any packet
  std::array<std::uint32_t, kCount> high, low;
  std::array<double, kCount> f64, f64_high;
  std::array<float, kCount> f32;
  for (std::size_t i = 0; i < kCount; ++i) {
    high[i] = static_cast<std::uint32_t>(random()) >> (i % 33 == 32 ? 31 : i % 33);
    low[i] = static_cast<std::uint32_t>(random()) >> 11;
  }
  to_coordinates(high.data(), low.data(), kCount, f64.data());
  to_coordinates<double>(high.data(), nullptr, kCount, f64_high.data());
  to_coordinates(high.data(), low.data(), kCount, f32.data());
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::uint64_t x = std::uint64_t{high[i]} << 21 | low[i];
    ASSERT_EQ(f64[i], std::ldexp(static_cast<double>(x), -53));
    ASSERT_EQ(f64_high[i], std::ldexp(static_cast<double>(high[i]), -32));
    ASSERT_EQ(static_cast<double>(f32[i]), std::ldexp(static_cast<double>(x >> 29), -24));
  }
}

TEST(Choices, AreTheFloorOfCoordinateTimesChoicesAndNeverTheLastPlusOne) {
  // floor(float(x) · 2⁻³² · 7) is 7 for the first word: out of bounds.
  for (const std::uint32_t word : {0xffffff80u, 0xffffffffu, 0x7fffffffu, 0u}) {
    for (const std::uint32_t choices : {1u, 2u, 3u, 7u, 1000u, 1u << 24}) {
      float f32;
      double f64;
      to_choices(&word, choices, 1, &f32);
      to_choices(&word, choices, 1, &f64);
      const double exact = std::floor(static_cast<double>(word) * 0x1p-32 * choices);
      EXPECT_EQ(f64, exact) << word << ' ' << choices;
      EXPECT_EQ(static_cast<double>(f32), exact) << word << ' ' << choices;
      EXPECT_LT(f64, choices);
    }
  }
  float seventh;
  const std::uint32_t word = 0xffffff80u;
  to_choices(&word, 7, 1, &seventh);
  EXPECT_EQ(seventh, 6.0f);
}

}  // namespace
}  // namespace halfslope
