#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Poisson-disk pairs: a set of exactly N points on the torus that keep their distance from each other, left over from
/// 5N uniform ones (samplers/sample_elimination.h).
std::unique_ptr<Sampler> make_poisson_disk();

}  // namespace halfslope
