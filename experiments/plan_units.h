// How a plan's work is cut into units.
#pragma once

#include "experiments/plan.h"

namespace halfslope {

/// Appends the units of pass `index`, stage by stage, in each the batches of its replicates, in each the tiles of its
/// pixels. What they are and which numbers they have is a function of the experiment alone.
void add_units(Plan& plan, std::size_t index);

}  // namespace halfslope
