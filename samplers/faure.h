#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// The Faure sequence itself, in natural order from the origin, in the least prime base that is not below the number of
/// dimensions. Deterministic.
std::unique_ptr<Sampler> make_faure();

/// The Faure sequence under nested scrambling by affine permutations of digits (docs/decisions/0003).
std::unique_ptr<Sampler> make_faure_owen();

}  // namespace halfslope
