#pragma once

#include <cstdint>
#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Jittered points on the full grid: n^d cells over all d dimensions of the layout, one uniform point in each.
std::unique_ptr<Sampler> make_jittered();

/// The largest n with n^dims ≤ count, exactly. 1 ≤ count, 1 ≤ dims.
std::uint64_t grid_side(std::uint64_t count, int dims);

/// Null where count ≤ most is a power n^dims; else the powers next to it, those above `most` left out. 1 ≤ count, 1 ≤
/// dims.
std::optional<LegalNeighbours> illegal_grid(std::uint64_t count, int dims, std::uint64_t most);

}  // namespace halfslope
