// Which of 64 equal logarithmic bins an octave a number falls into, without a logarithm.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace halfslope::log_bins {

inline constexpr std::uint64_t kInfinityBits = std::uint64_t{0x7ff} << 52;
inline constexpr int kMinBin = -1074 * 64, kMaxBin = 1023 * 64 + 63;

/// Square root by Newton's method, good to the last digit or two and the same on every machine.
constexpr double newton_sqrt(double x) {
  double root = 1;
  for (int i = 0; i < 8; ++i) root = 0.5 * (root + x / root);  // x is in [1, 2]: 8 steps are plenty
  return root;
}

/// An octave's bins: the 52 mantissa bits of their lower ends 2^(j/64), and of the octave's end.
struct Bounds {
  std::array<std::uint64_t, 65> lower{};
  std::array<double, 64> centre{};  ///< 2^((j + ½)/64)
  /// The bin of the first number of each of 128 equal slices of the octave. A slice (2⁻⁷ wide) is narrower than any bin
  /// (at least 2^(1/64) − 1 = 0.0109 wide), so a slice's number is in this bin or the next one.
  std::array<std::uint8_t, 128> first_bin{};

  constexpr Bounds() {
    std::array<double, 6> root{};  // 2^(1/2), 2^(1/4), … 2^(1/64)
    for (std::size_t i = 0; i < 6; ++i) root[i] = newton_sqrt(i == 0 ? 2.0 : root[i - 1]);
    for (std::size_t j = 0; j < 64; ++j) {
      double bound = 1;
      for (std::size_t i = 0; i < 6; ++i) bound *= (j >> (5 - i)) & 1 ? root[i] : 1.0;
      lower[j] = std::bit_cast<std::uint64_t>(bound) & 0xfffffffffffff;
      centre[j] = bound * newton_sqrt(root[5]);
    }
    lower[64] = std::uint64_t{1} << 52;
    for (std::size_t slice = 0; slice < 128; ++slice) {
      const auto above = std::upper_bound(lower.begin(), lower.end(), static_cast<std::uint64_t>(slice) << 45);
      first_bin[slice] = static_cast<std::uint8_t>(above - lower.begin() - 1);
    }
  }
};
inline constexpr Bounds kBounds;

/// ⌊64 · log2 x⌋ of the positive finite binary64 number with these bits (to the last digits of the bins' ends).
inline int bin_of(std::uint64_t bits) {
  int exponent = static_cast<int>(bits >> 52) - 1023;
  if (exponent == -1023) [[unlikely]] {  // subnormal: shift it into the normal range, exactly
    bits = std::bit_cast<std::uint64_t>(std::bit_cast<double>(bits) * 0x1p64);
    exponent = static_cast<int>(bits >> 52) - 1023 - 64;
  }
  const std::uint64_t mantissa = bits & 0xfffffffffffff;
  const int first = kBounds.first_bin[mantissa >> 45];
  return exponent * 64 + first + (mantissa >= kBounds.lower[static_cast<std::size_t>(first) + 1] ? 1 : 0);
}

/// The geometric centre 2^((index + ½)/64) of a bin.
inline double centre_of(int index) {
  return std::ldexp(kBounds.centre[static_cast<std::size_t>(index & 63)], index >> 6);
}

}  // namespace halfslope::log_bins
