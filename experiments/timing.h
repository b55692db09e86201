// What estimates take: every cell of a plan by itself, in turns.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/plan.h"
#include "samplers/catalogue.h"

namespace halfslope {

/// One timed run of a cell, in nanoseconds a sample.
struct TimedRun {
  double points_ns = 0;  ///< CPU time, of making the points alone
  double all_ns = 0;     ///< CPU time, of points, evaluation and sums
  double wall_ns = 0;    ///< as all_ns, by the clock on the wall
};

/// The timings of a cell; none where every pixel is known without sampling.
struct CellTimes {
  std::vector<TimedRun> runs;   ///< one a repetition, in the order in which they were taken
  int pixels = 0;               ///< that were timed
  std::uint64_t estimates = 0;  ///< of one integral, that a timed run makes: pixels × replicates
};

/// Times every cell of the plan on the calling thread, in isolation: an estimator evaluates its own heuristic alone, at
/// the one N, so nothing is shared with other estimators or with other N.
///
/// A timed run estimates at least 4 (for small N up to 32) pixels, a stratified choice that every cell of the scene at
/// this N shares, kLanes replicates at a time, as often as it takes to fill two milliseconds. All cells run once for
/// the machine to warm up and for their times to be known; then each repetition times each cell once, in a random order
/// of its own, each time after a run that is not timed. So a drift of the machine meets all cells alike. A pixel's
/// integral is made beforehand; what a sampler does for each pixel and group of replicates is among the points.
///
/// `label` is shown with the progress, unless `quiet`. Throws Error(kInterrupted) if a signal comes meanwhile.
std::vector<CellTimes> time_cells(const Plan& plan, const SamplerCatalogue& samplers, int repetitions,
                                  const std::string& label, bool quiet);

/// A line of --dry-run: how many runs, and about how long they take.
std::string describe_timing(const Plan& plan, int repetitions);

}  // namespace halfslope
