#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "samplers/sampler.h"

namespace halfslope {

/// The Kronecker sequence R_d, i α modulo 1 with the powers of one algebraic number, shifted at random.
std::unique_ptr<Sampler> make_kronecker();

/// A fraction (high + low · 2⁻³²) · 2⁻⁶⁴ of 96 bits.
struct LongFraction {
  std::uint64_t high = 0;
  std::uint32_t low = 0;

  /// The first 64 bits of `index` times this modulo 1, exactly rounded down; index < 2³².
  std::uint64_t multiple(std::uint64_t index) const { return index * high + ((index * low) >> 32); }
};

/// α_k = y^k, k = 1 … dims, where y is the root of y^dims + y^(dims + 1) = 1 in (0, 1), rounded down to 96 bits. 1 ≤
/// dims.
std::vector<LongFraction> kronecker_steps(int dims);

}  // namespace halfslope
