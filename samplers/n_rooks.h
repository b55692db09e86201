#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// N-rooks, or Latin hypercube: one point in each of N strata of every dimension, the dimensions shuffled
/// independently.
std::unique_ptr<Sampler> make_n_rooks();

}  // namespace halfslope
