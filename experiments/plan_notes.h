// What a plan saves, in words: lines of Plan::skips.
#pragma once

#include "experiments/plan.h"

namespace halfslope {

/// Techniques of each scene that no estimator draws from.
void note_unused_techniques(Plan& plan);

/// Heuristics that share a pass, and sample counts that are prefixes of a larger one.
void note_sharing(Plan& plan);

/// What a reader of `optimal`'s numbers should know.
void note_optimal(Plan& plan);

}  // namespace halfslope
