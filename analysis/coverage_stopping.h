#pragma once

#include "analysis/coverage.h"
#include "analysis/error_laws.h"

namespace halfslope {

/// How often the interval of an RMSE holds the truth when the interval itself decided how many replicates there are:
/// replicate_schedule() up to 4096, stopped by target_state(). A row's `replicates` is the mean over its runs, `marked`
/// the share whose target was not reached.
std::vector<CoverageRow> stopping_coverage(const CoverageRequest& request);

/// One of its rows: images of `pixels` integrals whose errors have the same law; `share` of the progress is its own.
/// No runs where it was stopped.
CoverageRow stopping_coverage(const ErrorLaw& law, int pixels, double target, const CoverageRequest& request,
                              double share = 1);

}  // namespace halfslope
