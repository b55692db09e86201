// Which samplers a figure shows, and at which N.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/layout.h"
#include "experiments/figures.h"

namespace halfslope {

/// The samplers of --samplers and --points; where there are none, those of `usual` that the catalogue has in so many
/// dimensions. Error(kUsage) for a name that is none, or a sampler with fewer dimensions; a file's fault stays the
/// file's (exit 3).
std::vector<std::string> figure_samplers(const FigureRequest& request, const Catalogue& catalogue,
                                         const std::vector<std::string>& usual, int dims);

/// --samples; where it is not given, all points of a file, and `usual` of any other sampler.
SampleCounts figure_counts(const FigureRequest& request, const SamplerInfo& info, const SampleCounts& usual);

/// Error(kUsage) that names the nearest legal counts.
void check_count(const Sampler& sampler, std::uint64_t count, const Layout& layout);

}  // namespace halfslope
