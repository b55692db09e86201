#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Stratified pairs: each 1-D group has N strata, each 2-D group an a × b grid of cells, a · b = N; every group is
/// shuffled on its own, so any number of groups can be padded together.
std::unique_ptr<Sampler> make_stratified();

/// The factors a ≥ b of count = a · b that are nearest to each other.
struct Grid {
  std::uint64_t columns, rows;
};
Grid squarest_grid(std::uint64_t count);

}  // namespace halfslope
