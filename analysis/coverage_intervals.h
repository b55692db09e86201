// The coverage of the intervals of RMSE and mean, and how often errors are marked as heavy-tailed.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/coverage.h"
#include "analysis/error_laws.h"
#include "analysis/interval_methods.h"

namespace halfslope {

/// Images whose pixels have independent errors of one law, each times its own scale; a single integral has one scale.
struct ErrorImages {
  std::string name;
  ErrorLaw law;
  std::vector<double> scales = {1};
  double mse() const;  ///< the truth: σ² times the mean squared scale
};

/// Simulates runs of so many replicates and makes the intervals of the RMSE by each of `methods`, a row each, and of
/// the mean by Student's t, a row after them. A run counts as marked where its corrected kurtosis is above the limit
/// (analysis/tails.h); coverage is over all runs, marked or not, and a run without an interval is not covered. `width`
/// is the mean over the runs that have an interval with two ends. `share` of the study's progress. Empty where it
/// was stopped.
std::vector<CoverageRow> measure_intervals(const ErrorImages& images, std::int64_t replicates,
                                           std::span<const IntervalMethod> methods, const CoverageRequest& request,
                                           double share = 1);

/// Every method on Gaussian, uniform, Laplace, lognormal(1.5) and Pareto(2.5) errors at 16, 64 and 256 replicates; with
/// 1024 by the methods that do not resample, for the mark; and on images of 256 pixels, means of 64 of the last two, at
/// 16 and 64. The pixels' scales are equal, or quantiles of e^Z (lognormal_scales). Gaussian
/// errors and images with equal scales at 16 replicates take all the runs, the rest a fifth.
std::vector<CoverageRow> interval_coverage(const CoverageRequest& request);

}  // namespace halfslope
