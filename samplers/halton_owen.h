#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// The Halton sequence under nested scrambling: each digit's permutation depends on all digits before it.
std::unique_ptr<Sampler> make_halton_owen();

}  // namespace halfslope
