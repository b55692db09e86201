#include "samplers/radical_inverse.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfslope {
namespace {

TEST(Primes, AreTheFirst1024) {
  ASSERT_EQ(primes().size(), 1024u);
  std::size_t found = 0;
  for (std::uint32_t n = 2; n <= 8161; ++n) {
    bool prime = true;
    for (std::uint32_t q = 2; q * q <= n && prime; ++q) prime = n % q != 0;
    if (prime) {
      ASSERT_EQ(primes()[found++], n);
    }
  }
  EXPECT_EQ(found, 1024u);
}

struct Case {
  std::uint32_t base;
  std::uint64_t index;
  long double exact;  ///< from 30-digit answers
  double f64, f32;    ///< relative errors that a form with a few roundings stays under
};

// Where implementations fail: digits that overflow 64 bits when reversed, answers that round to 1, long expansions.
// Several answers have 1 as their nearest binary32 or binary64 number; a coordinate is never 1 here.
constexpr Case kCases[] = {
    {2, 1, 0.5L, 8.881784197001252e-16, 4.76837158203125e-07},
    {7919, 18446744073709551615u, 0.503716679330381405866600595166L, 2.288e-15, 1.0064e-06},
    {3, 43046720, 0.999999976769426874581225362090L, 1.2544e-14, 5.824e-07},
    {3, 129140162, 0.999999992256475624860408454030L, 1.424e-14, 8.304e-07},
    {3, 1000000000000, 0.352167831843615619558756057664L, 1.5632e-14, 1.4128e-05},
    {5, 1000000007, 0.440000249036800000000000000000L, 1.072e-14, 6.032e-06},
    {2, 18446744073709551615u, 0.999999999999999999945789891376L, 1.776e-15, 9.536e-07},
    {2, 4294967295, 0.999999999767169356346130371094L, 8.881784197001252e-16, 9.504e-07},
    {7919, 3932614460934720, 0.999999999999999745716237903902L, 1.2608e-15, 1.904e-06},
    {5, 18446744073709551615u, 0.155922899103023057597575987200L, 2.368e-14, 1.28e-05},
    {11, 9223372036854775808u, 0.806219697637891220435716162198L, 5.04e-15, 4.72e-06},
};

TEST(RadicalInverse, HoldsWhereOthersOverflowOrRoundToOne) {
  for (const Case& c : kCases) {
    const double f64 = radical_inverse(c.base, c.index);
    const float f32 = radical_inverse_f32(c.base, c.index);
    const long double error64 = static_cast<long double>(f64) - c.exact,
                      error32 = static_cast<long double>(f32) - c.exact;
    EXPECT_LE(std::abs(error64) / c.exact, c.f64) << c.base << ' ' << c.index;
    EXPECT_LE(std::abs(error32) / c.exact, c.f32) << c.base << ' ' << c.index;
    EXPECT_LT(f64, 1);
    EXPECT_LT(f32, 1);
    // Rounded down by less than a unit (the answers themselves are good to 2⁻⁶⁴).
    EXPECT_TRUE(-0x1p-53L - 0x1p-63L < error64 && error64 <= 0x1p-63L) << c.base << ' ' << c.index;
    EXPECT_TRUE(-0x1p-24L - 0x1p-63L < error32 && error32 <= 0x1p-63L) << c.base << ' ' << c.index;
  }
}

TEST(RadicalInverse, IsTheRationalNumberRoundedDown) {
  // φ = numerator / power with both under 2³⁰: X · 2⁻⁵³ ≤ φ < (X + 1) · 2⁻⁵³ in 128-bit integers.
  __extension__ using Wide = unsigned __int128;
  for (const std::uint32_t base : {2u, 3u, 4u, 5u, 7u, 10u, 16u, 29u, 101u, 1000u, 8161u}) {
    for (std::uint64_t index = 0; index < 20000; ++index) {
      std::uint64_t numerator = 0, power = 1;
      for (std::uint64_t rest = index; rest > 0; rest /= base) {
        numerator = numerator * base + rest % base;
        power *= base;
      }
      const double found = radical_inverse(base, index);
      const auto x = static_cast<std::uint64_t>(found * 0x1p53);
      ASSERT_EQ(static_cast<double>(x) * 0x1p-53, found);
      ASSERT_LE(Wide{x} * power, Wide{numerator} << 53) << base << ' ' << index;
      ASSERT_GT(Wide{x + 1} * power, Wide{numerator} << 53) << base << ' ' << index;
      ASSERT_EQ(static_cast<double>(radical_inverse_f32(base, index)), std::floor(found * 0x1p24) * 0x1p-24);
    }
  }
}

TEST(RadicalInverse, LastPointOfAPowerIsOneMinusItsInverseAndNeverOne) {
  // φ(b^k − 1) = 1 − b^−k for every power of 64 bits, in every Halton base.
  for (const std::uint32_t base : primes()) {
    std::uint64_t power = 1;
    while (power <= ~std::uint64_t{0} / base) {
      power *= base;
      const double found = radical_inverse(base, power - 1);
      ASSERT_LT(found, 1) << base << ' ' << power;
      ASSERT_LT(radical_inverse_f32(base, power - 1), 1.0f) << base << ' ' << power;
      const long double exact = 1 - 1 / static_cast<long double>(power);
      ASSERT_NEAR(static_cast<double>(exact - static_cast<long double>(found)), 0x1p-54, 0x1.01p-54)
          << base << ' ' << power;
    }
  }
}

TEST(RadicalInverse, LargestBaseAndIndexStayInside128Bits) {
  // n = 2⁶⁴ − 1 in base b = 2³² − 1 is 1·b² + 2·b + 0, so φ = 2/b² + 1/b³.
  const long double b = 4294967295.0L;
  const double found = radical_inverse(4294967295u, ~std::uint64_t{0});
  EXPECT_EQ(found, std::floor((2 / (b * b) + 1 / (b * b * b)) * 0x1p53L) * 0x1p-53);
  EXPECT_EQ(radical_inverse(4294967295u, 1), std::floor(0x1p53L / b) * 0x1p-53L);
  EXPECT_EQ(radical_inverse(2, 0), 0);
  EXPECT_EQ(radical_inverse_f32(2, 0), 0);
}

TEST(RadicalInverseDeathTest, ABaseBelowTwoIsAProgrammersError) {
  EXPECT_DEATH(radical_inverse(1, 5), "base of two or more");
}

}  // namespace
}  // namespace halfslope
