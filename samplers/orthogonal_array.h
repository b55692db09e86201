#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Bose's orthogonal arrays of strength 2, N = p² for a prime p, levels permuted at random and refined to a Latin
/// hypercube: one point in each of the p × p cells of every two dimensions, and one in each of the N strata of every
/// dimension. At most p + 1 dimensions.
std::unique_ptr<Sampler> make_orthogonal_array();

}  // namespace halfslope
