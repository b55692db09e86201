#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "samplers/sampler.h"

namespace halfslope {

/// The Halton sequence under nested scrambling: each digit's permutation depends on all digits before it.
std::unique_ptr<Sampler> make_halton_owen();

/// The first 1024 primes: the bases of the Halton dimensions.
std::span<const std::uint32_t> primes();

}  // namespace halfslope
