#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// `points`, a deterministic sampler, randomised by a Cranley–Patterson rotation: each dimension is shifted modulo 1 by
/// a uniform random number of its own for every replicate and pixel. Named as `points` is, with "-cp" behind it.
///
/// R. Cranley & T. N. L. Patterson, "Randomization of number theoretic methods for multiple integration" (1976).
std::unique_ptr<Sampler> rotated(std::unique_ptr<Sampler> points);

}  // namespace halfslope
