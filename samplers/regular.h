#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// The full grid without jitter: the centres of n^d cells over all d dimensions of the layout.
std::unique_ptr<Sampler> make_regular();

}  // namespace halfslope
