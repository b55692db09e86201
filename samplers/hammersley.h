#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// The Hammersley set of N points: i/N, then the radical inverses of i in the first primes. Deterministic.
std::unique_ptr<Sampler> make_hammersley();

/// The Hammersley set under a Cranley–Patterson rotation.
std::unique_ptr<Sampler> make_hammersley_cp();

}  // namespace halfslope
