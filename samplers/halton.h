#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// The Halton sequence itself, from index 0: dimension k is the radical inverse in the k-th prime. Deterministic.
std::unique_ptr<Sampler> make_halton();

/// The Halton sequence under a Cranley–Patterson rotation.
std::unique_ptr<Sampler> make_halton_cp();

}  // namespace halfslope
