#pragma once

#include <cstdint>
#include <span>

namespace halfslope {

/// Van der Corput's radical inverse φ_b(n) = Σ_k a_k b^−(k+1) of n = Σ_k a_k b^k, exactly, rounded down to a multiple
/// of 2⁻⁵³: never 1. base ≥ 2; every 64-bit index. J. G. van der Corput, "Verteilungsfunktionen" (1935).
double radical_inverse(std::uint32_t base, std::uint64_t index);

/// The top 24 bits of radical_inverse: φ_b(n) rounded down to a multiple of 2⁻²⁴.
float radical_inverse_f32(std::uint32_t base, std::uint64_t index);

/// The first 1024 primes: the bases of the Halton and Hammersley dimensions.
std::span<const std::uint32_t> primes();

}  // namespace halfslope
