// Which samplers a figure shows, and at which N.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/figures.h"

namespace halfslope {

/// The samplers of --samplers and --points; where there are none, those of `usual` that the catalogue has in so many
/// dimensions. Error(kUsage) for a name that is none, or a sampler with fewer dimensions; a file's fault stays the
/// file's (exit 3).
std::vector<std::string> figure_samplers(const FigureRequest& request, const Catalogue& catalogue,
                                         const std::vector<std::string>& usual, int dims);

/// --samples; where it is not given, all points of a file, and `usual` of any other sampler.
SampleCounts figure_counts(const FigureRequest& request, const SamplerInfo& info, const SampleCounts& usual);

}  // namespace halfslope
