// The keys that let a run decide how many replicates it takes: how they are written.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "experiments/spec.h"

namespace halfslope {

/// "rmse ±5%", "rmse +-5 %" or "rmse 5%" is 0.05; empty for anything else, and unless 0 < percentage < 100.
std::optional<double> parse_target(std::string_view text);

/// "60 s", "2 min" or "1.5h" in seconds; empty for anything else, and unless 0 < time ≤ 1000 h.
std::optional<double> parse_budget(std::string_view text);

/// "rmse ±5%", "60 s": as they are shown, whatever the way they were written.
std::string target_text(double target);
std::string budget_text(double seconds);

/// In how many stages replicates are doubled (analysis/stopping.h). A target looks at its intervals after every
/// doubling, since each look costs coverage; a budget is spent in quarters of them, so that little of it is left over.
int stages_per_doubling(const Spec& spec);

}  // namespace halfslope
