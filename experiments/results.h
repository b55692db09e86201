// The numbers of a finished run, cell by cell.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/cell_statistics.h"
#include "analysis/rates.h"
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

struct CellResult {
  CellStatistics statistics;
  std::vector<RegionResult> regions;  ///< where the scene has several
  std::uint64_t first_bad_replicate = 0, first_bad_pixel = 0;
};

/// One line of convergence: the cells of a plan that differ in N only.
struct RateResult {
  std::size_t first_cell;  ///< index into the plan's cells
  RateFit fit;
  std::optional<double> theory;
};

struct Results {
  std::vector<CellResult> cells;  ///< as the plan's
  std::vector<RateResult> rates;
};

/// What is done with a folded cell beside keeping its statistics: its memory is given back at once, so that a run's
/// does not grow with replicates or pixels.
struct CellVisitor {
  /// From several threads, each cell once: images.
  std::function<void(const Cell& cell, const FoldedCell& folded)> as_folded;
  /// From one thread, in the plan's order: rows of replicates.
  std::function<void(const Cell& cell, const FoldedCell& folded)> in_order;
};

/// Throws Error(kInterrupted) if a signal comes meanwhile.
Results collect_results(const Plan& plan, std::span<const Reference> references, const Journal& journal,
                        const SamplerCatalogue& samplers, int threads, const CellVisitor& visitor);

}  // namespace halfslope
