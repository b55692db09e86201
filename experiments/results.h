// The numbers of a finished run, cell by cell.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/cell_statistics.h"
#include "analysis/rates.h"
#include "experiments/cell_name.h"
#include "experiments/comparison_results.h"
#include "experiments/fold.h"
#include "experiments/plan.h"
#include "experiments/region_results.h"

namespace halfslope {

/// What is known of a cell before anything is measured.
struct CellFacts {
  bool deterministic = false;      ///< the sampler has one replicate
  bool unbiased = false;           ///< it declares that its estimates are
  bool infinite_variance = false;  ///< of the integrand: no squared error has an expectation
  bool reference_known = true;     ///< how sure the reference is
  double rounding_mse = 0;         ///< square of the rounding error of values as large as these; 0: not known
  std::optional<double> theory;    ///< the rate that theory gives
};

/// A row of convergence.csv with all that other tables are made of. It stands on its own: no plan, no journal, so
/// images that another renderer wrote give one too.
struct CellResult {
  CellName name;
  std::int64_t replicates = 0, pixels = 0;
  CellFacts facts;
  CellStatistics statistics;
  std::vector<double> replicate_mse;       ///< mean squared error of each, the reference's variance in it; empty above
                                           ///< kMostKept replicates
  double mse = 0;                          ///< their mean
  std::vector<double> replicate_variance;  ///< what each adds to the sample variance, as ReplicateErrors; likewise
  double reference_mse_variance = 0;       ///< of the reference's mean δ² (analysis/reference_noise.h)
  std::vector<RegionResult> regions;       ///< where the scene has several
  std::uint64_t first_bad_replicate = 0, first_bad_pixel = 0;
};

/// What a fit is over.
enum class RateKind {
  kPlain,    ///< every N of the line, by ordinary least squares: the first of a line's fits, and always there
  kWindow,   ///< the N from which on the errors follow a line, weighted
  kVariance  ///< every N, to the sample variance
};

/// A fit to a line of convergence: the cells that differ in N only.
struct RateResult {
  std::size_t first_cell;  ///< index into the results' cells
  RateFit fit;
  std::optional<double> theory;
  RateKind kind = RateKind::kPlain;
};

/// The slope between two neighbouring N of a line.
struct LocalRateResult {
  std::size_t first_cell;  ///< of the line
  LocalRate fit;
};

/// All that is fitted to lines, in the order of the cells.
struct RateResults {
  std::vector<RateResult> rates;
  std::vector<LocalRateResult> local;
};

struct Results {
  std::vector<CellResult> cells;  ///< in the order of the tables; the cells of a line side by side
  std::vector<RateResult> rates;  ///< in the order of the cells
  std::vector<LocalRateResult> local_rates;
  std::vector<ComparisonFamily> comparisons;
};

/// The rates of every line of `cells`, on so many threads (0: all). A line of an unbiased sampler whose plain fit the
/// reference limits has that of its sample variance too.
RateResults fit_rates(const std::vector<CellResult>& cells, int threads);

/// What is done with a folded cell beside keeping its statistics: its memory is given back at once, so that a run's
/// does not grow with replicates or pixels.
struct CellVisitor {
  /// From several threads, each cell once: images.
  std::function<void(const Cell& cell, const FoldedCell& folded)> as_folded;
  /// From one thread, in the plan's order: rows of replicates.
  std::function<void(const Cell& cell, const FoldedCell& folded)> in_order;
};

/// The cells and rates of a plan whose units are all in the journal. Throws Error(kInterrupted) if a signal comes
/// meanwhile.
Results collect_results(const Plan& plan, std::span<const Reference> references, const Journal& journal,
                        const SamplerCatalogue& samplers, int threads, const CellVisitor& visitor);

}  // namespace halfslope
