#include "analysis/double_double.h"

#include <gtest/gtest.h>

#include <random>

namespace halfslope {
namespace {

// Whole numbers under 2^100 are exact both as 128-bit integers and as a pair of 53-bit ones.
__extension__ using Integer = __int128;

DoubleDouble pair_of(Integer value) {
  const auto high = static_cast<double>(value);
  return {high, static_cast<double>(value - static_cast<Integer>(high))};
}
Integer integer_of(DoubleDouble value) { return static_cast<Integer>(value.high) + static_cast<Integer>(value.low); }

TEST(DoubleDouble, SumsOfWholeNumbersAreExact) {
  std::mt19937_64 random(1);
  const auto draw = [&] {
    const auto magnitude = static_cast<Integer>(random()) << (random() % 36);
    return (magnitude + static_cast<Integer>(random())) * (random() % 2 == 0 ? 1 : -1);
  };
  for (int i = 0; i < 10000; ++i) {
    const Integer a = draw(), b = draw();
    EXPECT_EQ(integer_of(pair_of(a) + pair_of(b)), a + b);
    EXPECT_EQ(integer_of(pair_of(a) - pair_of(b)), a - b);
    EXPECT_EQ(integer_of(pair_of(a) - pair_of(a)), 0);
  }
}

TEST(DoubleDouble, ProductsAndQuotientsOfWholeNumbersAreExact) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 10000; ++i) {
    const auto a = static_cast<Integer>(random()), b = static_cast<Integer>(random() >> 28);  // 64 and 36 bits
    EXPECT_EQ(integer_of(pair_of(a) * pair_of(b)), a * b);
    const auto divisor = static_cast<double>((random() >> 28) + 1);
    EXPECT_EQ(integer_of(pair_of(a * static_cast<Integer>(divisor)) / divisor), a);
  }
  const double x = 1 + 0x1p-52;
  EXPECT_EQ(DoubleDouble::product(x, x).high, 1 + 0x1p-51);
  EXPECT_EQ(DoubleDouble::product(x, x).low, 0x1p-104);
  EXPECT_EQ(DoubleDouble::sum(1, 0x1p-80).low, 0x1p-80);
}

// 3 · (1/3) is 1 to 2⁻¹⁰⁴, though 1/3 has no end.
TEST(DoubleDouble, KeepsAHundredBits) {
  const DoubleDouble third = DoubleDouble{1, 0} / 3.0;
  EXPECT_LE(std::abs((third * 3.0 - DoubleDouble{1, 0}).value()), 0x1p-104);
  EXPECT_NEAR(third.low / third.high, 0x1p-54, 0x1p-55);  // 1/3 rounds down by a third of its last place's half
}

}  // namespace
}  // namespace halfslope
