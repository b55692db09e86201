#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Progressive multi-jittered pairs: a sequence of which the first 4^k points are a multi-jittered set, one in each
/// square of side 2^−k and in each of 4^k strata of x and of y, and the first 2 · 4^k points have one in each of as
/// many strata of x and of y, and two in each square, diagonally opposite.
std::unique_ptr<Sampler> make_pmj();

}  // namespace halfslope
