// Errors over parts of an image.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/cell_statistics.h"
#include "experiments/fold.h"
#include "experiments/plan.h"

namespace halfslope {

/// Errors over one part of the image: "all", what a shape covers ("plate1"), or that part of it whose mirror direction
/// points nearest to one light ("plate1/light2").
struct RegionResult {
  std::string region;
  std::int64_t pixels = 0;
  std::optional<double> rmse, rmse_lo, rmse_hi, relmse, relmse_lo, relmse_hi;
};

/// Sums over one region of the reference's variance, plain and relative, and of the squares of those of each pixel.
struct ReferenceShare {
  double plain = 0, relative = 0, plain_squares = 0, relative_squares = 0;
};
using ReferenceShares = std::map<std::uint32_t, ReferenceShare>;
ReferenceShares reference_shares(const PlannedScene& scene, const Reference& reference);

/// The regions of one cell, the whole image first; none where the scene has no parts, or replicates were not kept.
std::vector<RegionResult> region_results(const PlannedScene& scene, const FoldedCell& folded,
                                         const CellStatistics& whole, const ReferenceShares& shares);

}  // namespace halfslope
