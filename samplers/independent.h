#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Pseudo-random points: each coordinate independent and uniform.
std::unique_ptr<Sampler> make_independent();

}  // namespace halfslope
