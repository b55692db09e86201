#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Best-candidate pairs: a sequence whose next point is the farthest, on the torus, from all points before it, of as
/// many uniform candidates as there are points.
std::unique_ptr<Sampler> make_best_candidate();

}  // namespace halfslope
