// Measuring in stages: with a target each pass stops once all of its cells are known well enough.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/results.h"
#include "experiments/runner.h"

namespace halfslope {

/// Numbers of the units of one pass between two ends of its stages.
std::vector<std::uint64_t> units_between(const Pass& pass, std::int64_t first_replicate, std::int64_t last_replicate);

/// Measures what the spec asks for and the journal lacks; how many replicates each pass came to. Without target and
/// budget they are the plan's. With a target they are a function of the experiment alone: after each stage they are
/// decided from the journal's first units, and a pass, whose cells share their points, goes on until none of them is
/// open. Throws what Runner::run does.
std::vector<std::int64_t> measure(const Spec& spec, const Plan& plan, std::span<const Reference> references,
                                  Runner& runner);

/// Makes them the plan's, which is then the plan of what was done.
void set_replicates(Plan& plan, const std::vector<std::int64_t>& replicates);

/// Adds `target-missed` to the status of the cells that did not get there.
void mark_missed(Results& results, double target);

/// Integrand evaluations where every pass stops after its first stage.
double least_evaluations(const Plan& plan);

/// The stages and what is to be expected of them, a line; empty for a plain run.
std::string describe_stopping(const Spec& spec, const Plan& plan);

/// What came of it, a line; empty for a plain run.
std::string report_stopping(const Spec& spec, const Plan& plan, const Results& results);

}  // namespace halfslope
