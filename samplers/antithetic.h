#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Pairs of independent points that are each other's mirror images in the middle of the cube: u and 1 − u. In binary64
/// the reflection is exact, so odd integrands are integrated without error.
std::unique_ptr<Sampler> make_antithetic();

}  // namespace halfslope
