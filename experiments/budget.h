// Sharing a time over the passes of a plan.
#pragma once

#include <span>
#include <vector>

#include "experiments/runner.h"

namespace halfslope {

/// What the next stage of a pass would give and take.
struct StageOffer {
  std::size_t pass = 0;
  std::size_t units = 1;  ///< of work
  double seconds = 0;     ///< expected, > 0
  double narrowing = 0;   ///< of the worst log half-width among its cells, expected
};

/// The offers to take next: those with the most narrowing for their time that fit into `seconds` one after the other,
/// until they have `units` units together, so that every thread has work. Their passes, ascending; none if none fits.
std::vector<std::size_t> choose_stages(std::vector<StageOffer> offers, double seconds, std::size_t units);

/// Measures the first stage of every pass, then stage by stage what is expected to narrow most for its time: a pass
/// with the worst log half-width h of its cells' rmse at R replicates has it at h √(R/R') at R', and what that takes is
/// known from the pass's own samples per second. Stages that would not end in time are not begun, but the first is
/// measured in any case. How many replicates each pass came to.
///
/// What each round took is kept in the journal, so a run that was interrupted goes on with the time that it has left,
/// one that is done does nothing, and a larger budget goes on from there. Throws what Runner::run does.
std::vector<std::int64_t> measure_within_budget(double seconds, const Plan& plan, std::span<const Reference> references,
                                                Runner& runner);

}  // namespace halfslope
