#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// The Sobol' sequence itself, in natural order from the origin. Deterministic.
std::unique_ptr<Sampler> make_sobol();

/// The Sobol' sequence under a digital shift: all 53 digits of a dimension exclusive or the same random ones.
std::unique_ptr<Sampler> make_sobol_xor();

/// The Sobol' sequence under a Cranley–Patterson rotation.
std::unique_ptr<Sampler> make_sobol_cp();

}  // namespace halfslope
