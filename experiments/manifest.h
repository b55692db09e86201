#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "experiments/plan.h"
#include "experiments/reference.h"
#include "experiments/results.h"

namespace halfslope {

/// manifest.json: what ran, on what, and what was skipped. The one file of a run folder that tells the time.
std::string manifest_json(const Spec& spec, const Plan& plan, const Results& results,
                          const std::vector<Reference>& references, std::chrono::system_clock::time_point started);

/// The summary as JSON: a list of objects with convergence.csv's column names.
std::string cells_json(const Results& results);

}  // namespace halfslope
