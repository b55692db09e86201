#include "analysis/wide_integer.h"

#include <gtest/gtest.h>

#include <random>

namespace halfslope {
namespace {

Int128 signed_bits(std::mt19937_64& random, int bits) {
  const auto word = (static_cast<UInt128>(random()) << 64 | random()) >> (128 - bits);
  const auto magnitude = static_cast<Int128>(word);
  return random() % 2 == 0 ? magnitude : -magnitude;
}

void expect_same(const DoubleDouble& a, const DoubleDouble& b) {
  EXPECT_EQ(a.high, b.high);
  EXPECT_EQ(a.low, b.low);
}

// (a + b)(c + d) = ac + ad + bc + bd, all bits of it: a sum of products less the same product is 0.
TEST(WideInteger, ProductsDistribute) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const int bits = 1 + trial % 125;
    const Int128 a = signed_bits(random, bits), b = signed_bits(random, bits), c = signed_bits(random, 125),
                 d = signed_bits(random, 125);
    WideSum sum;
    sum.add(a, c), sum.add(a, d), sum.add(b, c), sum.add(b, d);
    sum.add(-(a + b), c + d);
    expect_same(sum.value(0), {0, 0});
  }
}

TEST(WideInteger, ValuesAreRoundedTo106Bits) {
  const auto power = [](int exponent) { return static_cast<Int128>(1) << exponent; };
  WideSum sum;
  sum.add(power(120), power(120));
  expect_same(sum.value(0), {0x1p240, 0});
  sum.add(-1, power(100));
  expect_same(sum.value(-100), {0x1p140, -1});
  sum.add(-power(120), power(121));
  expect_same(sum.value(-100), {-0x1p140, -1});
  WideSum small;
  small.add(-3, 5);
  expect_same(small.value(-2), {-3.75, 0});
  expect_same(to_double_double(power(100) + 1, -100), {1, 0x1p-100});
  expect_same(to_double_double(-power(100) - 1, -100), {-1, -0x1p-100});
}

}  // namespace
}  // namespace halfslope
