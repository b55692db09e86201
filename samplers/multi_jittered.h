#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Multi-jittered pairs: an a × b grid of cells, a · b = N, one point in each; each of N strata of x and each of N
/// strata of y holds one point too, under a shuffle of its own for every column and row.
std::unique_ptr<Sampler> make_multi_jittered();

}  // namespace halfslope
