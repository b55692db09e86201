#pragma once

#include "analysis/coverage.h"

namespace halfslope {

/// How often the interval of an RMSE holds the truth when the interval itself decided how many replicates there are:
/// replicate_schedule() up to 4096, stopped by target_state(). A row's `replicates` is the mean over its runs, `marked`
/// the share whose target was not reached.
std::vector<CoverageRow> stopping_coverage(const CoverageRequest& request);

/// One of its rows: images of `pixels` integrals, in every one the same law of errors.
enum class StoppingLaw : std::uint8_t { kGaussian, kLognormal };
CoverageRow stopping_coverage(StoppingLaw law, int pixels, double target, const CoverageRequest& request);

}  // namespace halfslope
