#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// The Sobol' sequence under nested uniform scrambling, exactly as defined; see sobol_owen.kernel.cpp.
std::unique_ptr<Sampler> make_sobol_owen();

/// The Sobol' sequence under nested scrambling by a hash of its digits; see sobol_owen_fast.kernel.cpp.
std::unique_ptr<Sampler> make_sobol_owen_fast();

}  // namespace halfslope
