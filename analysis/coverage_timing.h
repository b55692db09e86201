// The coverage of the intervals of times and of efficiency.
#pragma once

#include <vector>

#include "analysis/coverage.h"

namespace halfslope {

/// The median's interval of 6, 15 and 51 timings that are normal, that have an exponential tail, and that a machine of
/// two speeds gives, 1 and 1.3, of which it has the first in three of five; and the efficiency of 64 Gaussian errors
/// and 15 timings whose logarithm is normal with σ = 0.05, where the error's half-width rules, and 0.5, where the
/// time's does. `replicates` of the first are timings.
std::vector<CoverageRow> timing_coverage(const CoverageRequest& request);

}  // namespace halfslope
