#pragma once

#include <cstdint>
#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Jittered points on the full grid: n^d cells over all d dimensions of the layout, one uniform point in each.
std::unique_ptr<Sampler> make_jittered();

/// The largest n with n^dims ≤ count, exactly. 1 ≤ count, 1 ≤ dims.
std::uint64_t grid_side(std::uint64_t count, int dims);

}  // namespace halfslope
