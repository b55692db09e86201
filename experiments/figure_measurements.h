// What figures of measures are drawn from: means over replicates.
#pragma once

#include <string>
#include <vector>

#include "experiments/figures.h"
#include "experiments/measures.h"

namespace halfslope {

struct FigureMeasurements {
  MeasuresPlan plan;
  Measurements values;
  std::vector<MeasuredMean> means;  ///< point into the plan
};

/// Makes the points of all requests and measures them together, with progress. Inside a range of N what cannot be is
/// left out, and told; else it is an error of usage, and so is a sampler of which nothing is left, or more than 2²⁵
/// values.
FigureMeasurements measure_for_figure(const FigureRequest& request, const Catalogue& catalogue,
                                      const std::vector<MeasuresRequest>& requests);

/// --measures, or `usual`; `parameters` are given to those that have none. Error(kUsage) for one that is not among
/// `allowed` (by name alone), and for one that stands twice.
std::vector<std::string> figure_measures(const FigureRequest& request, std::vector<std::string> usual,
                                         const std::vector<std::string>& allowed, const std::string& parameters);

/// "N = 1024, 64 replicates, seed 1": what all means share, as far as they do.
std::string measured_subtitle(const std::vector<MeasuredMean>& means, std::uint64_t seed);

/// Whether all means are of equally many points.
bool same_count(const std::vector<MeasuredMean>& means);

}  // namespace halfslope
