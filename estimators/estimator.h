// Estimators by name: techniques, how many samples of each, and the heuristic that combines them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/integral.h"
#include "core/layout.h"
#include "estimators/kernels.h"

namespace halfslope {

/// Which techniques a round of samples draws, and how often: indices into the scene's techniques, ascending.
struct Allocation {
  std::vector<int> techniques;
  std::vector<int> counts;

  /// Samples of one round: N is a multiple of it.
  int round() const;
  /// The dimensions of the point that drives one round: each technique's layout, `counts` times, in order.
  Layout layout(std::span<const Technique> catalogue) const;
  bool operator==(const Allocation&) const = default;
};

struct Estimator {
  std::string name;
  Heuristic heuristic;
  Allocation allocation;
};

/// What `list estimators` says of one name.
struct EstimatorInfo {
  std::string name, description, reference;
};
std::vector<EstimatorInfo> estimator_catalogue();

/// HEURISTIC[:PARAMETER][@TECHNIQUE[*COUNT]+…], e.g. "balance@light+bsdf", "power:3@light*3+bsdf"; without '@' over
/// light+bsdf. The name of a technique alone is that technique's own estimator. Throws Error(kBadInput) that says what
/// is wrong and what the scene offers.
Estimator parse_estimator(const std::string& name, std::span<const Technique> techniques);

}  // namespace halfslope
