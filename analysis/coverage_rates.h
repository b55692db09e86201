// The coverage of the intervals of rates, and how often floors are found and references refused.
#pragma once

#include <vector>

#include "analysis/coverage.h"
#include "analysis/rate_laws.h"

namespace halfslope {

/// How a fit treats the error of its reference.
enum class ReferenceUse {
  kCarried,     ///< as analyse_rates does
  kSubtracted,  ///< V̄ is subtracted and taken as exact
  kIgnored      ///< nothing is
};

/// Simulates runs of so many replicates of a law and analyses each: a row of the plain fit and one of the window. A
/// run whose fit was refused is not covered. `marked` is the share of runs whose plain row is not "ok" (of both rows),
/// `width` the mean over the runs that have an interval. `share` of the study's progress. Empty where it was stopped.
std::vector<CoverageRow> measure_rates(const RateLaw& law, std::int64_t replicates, ReferenceUse use,
                                       const CoverageRequest& request, double share = 1);

/// The rate of the sample variance of one integral, at N of `law` as single walks with signs; a row.
std::vector<CoverageRow> measure_variance_rate(std::int64_t replicates, const CoverageRequest& request,
                                               double share = 1);

/// Walks and Owen-like mixtures at 16, 64 and 256 replicates; references of 4× and 1× the largest N; floors. Promised
/// are 92.5 to 97.5 % at 64 and 256 replicates and 92 % at 16, with a reference of 4× too, whose error the other two
/// uses of it leave under 85 %; of 1×, and with a floor at 64 replicates and more, the plain fit is refused.
std::vector<CoverageRow> rate_coverage(const CoverageRequest& request);

}  // namespace halfslope
