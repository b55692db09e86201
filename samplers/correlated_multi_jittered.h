#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Correlated multi-jittered pairs: as multi-jittered ones, but all columns share one permutation, and so do all rows.
std::unique_ptr<Sampler> make_correlated_multi_jittered();

}  // namespace halfslope
