#include "samplers/radical_inverse.h"

#include <array>

#include "core/assertion.h"

namespace halfslope {
namespace {

constexpr std::size_t kPrimes = 1024;

constexpr std::array<std::uint32_t, kPrimes> first_primes() {
  std::array<std::uint32_t, kPrimes> primes = {};
  std::size_t found = 0;
  for (std::uint32_t n = 2; found < primes.size(); ++n) {
    bool prime = true;
    for (std::size_t i = 0; i < found && primes[i] * primes[i] <= n && prime; ++i) prime = n % primes[i] != 0;
    if (prime) primes[found++] = n;
  }
  return primes;
}

__extension__ using Wide = unsigned __int128;

/// ⌊2³² φ⌋ and the next 21 bits.
struct Fraction {
  std::uint32_t high, low;
};

// φ = R / b^t: the t digits reversed over their power of the base. 64-bit numbers do not hold them (7919⁵ has 65 bits),
// but since b^(t−1) ≤ index < 2⁶⁴ and b < 2³², b^t is under 2⁹⁶, and two long divisions stay inside 128 bits.
Fraction fraction(std::uint32_t base, std::uint64_t index) {
  assert_equal(base >= 2, true, "radical_inverse: base of two or more");
  Wide reversed = 0, power = 1;
  for (; index > 0; index /= base) {
    reversed = reversed * base + index % base;
    power *= base;
  }
  const Wide first = reversed << 32;
  const Wide second = (first % power) << 21;
  return {static_cast<std::uint32_t>(first / power), static_cast<std::uint32_t>(second / power)};
}

}  // namespace

double radical_inverse(std::uint32_t base, std::uint64_t index) {
  const auto [high, low] = fraction(base, index);
  return high * 0x1p-32 + low * 0x1p-53;
}

float radical_inverse_f32(std::uint32_t base, std::uint64_t index) {
  return static_cast<float>(fraction(base, index).high >> 8) * 0x1p-24f;
}

std::span<const std::uint32_t> primes() {
  static constexpr auto kTable = first_primes();
  return kTable;
}

}  // namespace halfslope
