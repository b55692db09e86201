// Integers of 128 and 256 bits, for sums that must not round.
#pragma once

#include <cstdint>

#include "analysis/double_double.h"

namespace halfslope {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

/// (a, b) ↦ the 256 bits of a · b.
struct WideProduct {
  UInt128 low;
  Int128 high;

  WideProduct(Int128 a, Int128 b) {
    const auto ua = static_cast<UInt128>(a), ub = static_cast<UInt128>(b);
    const UInt128 a0 = static_cast<std::uint64_t>(ua), a1 = ua >> 64, b0 = static_cast<std::uint64_t>(ub),
                  b1 = ub >> 64;
    const UInt128 low_low = a0 * b0, low_high = a0 * b1, high_low = a1 * b0;
    const UInt128 middle =
        (low_low >> 64) + static_cast<std::uint64_t>(low_high) + static_cast<std::uint64_t>(high_low);
    low = (middle << 64) | static_cast<std::uint64_t>(low_low);
    UInt128 top = a1 * b1 + (low_high >> 64) + (high_low >> 64) + (middle >> 64);
    // In two's complement a negative factor was taken 2¹²⁸ too large.
    top -= (static_cast<UInt128>(a >> 127) & ub) + (static_cast<UInt128>(b >> 127) & ua);
    high = static_cast<Int128>(top);
  }
};

/// A running sum of products of 128-bit integers, exact while it stays within ±2²⁵⁵.
class WideSum {
 public:
  void add(Int128 a, Int128 b) {
    const WideProduct product(a, b);
    low_ += product.low;
    high_ = static_cast<Int128>(static_cast<UInt128>(high_) + static_cast<UInt128>(product.high) +
                                (low_ < product.low ? 1 : 0));
  }

  /// The sum times 2^exponent, rounded to 106 bits.
  DoubleDouble value(int exponent) const {
    const bool negative = high_ < 0;
    UInt128 low = low_, high = static_cast<UInt128>(high_);
    if (negative) {
      low = ~low + 1;
      high = ~high + (low == 0 ? 1 : 0);
    }
    DoubleDouble sum;
    for (int word = 7; word >= 0; --word) {
      const UInt128 half = word >= 4 ? high : low;
      const auto bits = static_cast<std::uint32_t>(half >> (32 * (word & 3)));
      sum = sum + DoubleDouble{std::ldexp(bits, 32 * word + exponent), 0};
    }
    return negative ? -sum : sum;
  }

 private:
  UInt128 low_ = 0;
  Int128 high_ = 0;
};

/// a · 2^exponent, rounded to 106 bits.
inline DoubleDouble to_double_double(Int128 a, int exponent) {
  WideSum sum;
  sum.add(a, 1);
  return sum.value(exponent);
}

}  // namespace halfslope
