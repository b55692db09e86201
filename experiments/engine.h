// Runs a plan: references, units of work in parallel, the journal, the tables.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/catalogue.h"
#include "experiments/plan.h"
#include "experiments/results.h"
#include "experiments/theory.h"
#include "experiments/timing_results.h"

namespace halfslope {

struct RunOptions {
  std::filesystem::path out;
  int threads = 0;  ///< 0: every core
  bool quiet = false;
  bool overwrite = false;
};

struct RunOutcome {
  Plan plan;
  Results results;
  Measurements measured;
  std::vector<TimingResult> timed;
  TheoryReport theory;
  std::size_t invalid_cells = 0;
};

/// Plans, measures what the folder's journal does not already hold, and writes the tables and images. Interrupted by a
/// signal it throws Error(kInterrupted), and the same call goes on from there to the same bytes.
RunOutcome run_experiment(const Spec& spec, const Catalogue& catalogue, const RunOptions& options);

/// Adds to the plan's skips what an earlier run left: units in the journal of `out`, replicates of references.
void note_finished_work(Plan& plan, const Spec& spec, const Catalogue& catalogue, const std::filesystem::path& out);

/// What --dry-run prints: the work, what the references will be asked for, and what is skipped and why.
std::string describe_plan(const Spec& spec, const Plan& plan, const Catalogue& catalogue);

}  // namespace halfslope
