// The numbers of a finished run, cell by cell.
#pragma once

#include <optional>
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
  std::vector<ReplicateErrors> per_replicate;  ///< up to 4096
  double mse = 0;                              ///< mean over replicates
  std::vector<RegionResult> regions;           ///< where the scene has several
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

/// Calls `visit` with each folded cell as it is done (from several threads, each cell once), then keeps its statistics.
Results collect_results(const Plan& plan, std::span<const Reference> references, const Journal& journal,
                        const SamplerCatalogue& samplers, int threads,
                        const std::function<void(std::size_t cell, const FoldedCell& folded)>& visit);

}  // namespace halfslope
