// From finished units to a cell's data: always in the order of units, so the bits depend on the spec alone.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/cell_statistics.h"
#include "experiments/journal.h"
#include "experiments/plan.h"
#include "experiments/reference.h"
#include "experiments/unit.h"

namespace halfslope {

/// One region's errors: means over its integrals, for each replicate.
struct RegionErrors {
  std::int64_t pixels = 0;
  std::vector<double> mse, relmse;  ///< per replicate; empty above kMostKept replicates
};

struct FoldedCell {
  CellData data;
  std::map<std::uint32_t, RegionErrors> regions;  ///< only where the scene has several
  std::vector<Moments> integrals;                 ///< where an image wants them: pixel-major, channels fastest
  std::uint64_t first_bad_replicate = 0, first_bad_pixel = 0;
};

/// Replicates whose own rows are kept and written.
inline constexpr std::int64_t kMostKept = 4096;

/// The first `replicates` of a cell: the end of a stage of its pass, whose units up to there are in the journal.
FoldedCell fold_cell(const Plan& plan, const Cell& cell, const Reference& reference, const Journal& journal,
                     std::int64_t replicates);

}  // namespace halfslope
