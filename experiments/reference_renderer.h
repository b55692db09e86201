// Replicates of a rendered reference, and their cache.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/moments.h"
#include "estimators/estimator.h"
#include "experiments/reference.h"

namespace halfslope {

/// A reference in the making: the moments over replicates of every integral.
struct ReferenceState {
  std::vector<Moments> moments;
  std::vector<double> half;            ///< each integral's mean over the first half of the replicates
  std::vector<double> replicate_sums;  ///< Σ over integrals, a number for each replicate

  std::int64_t replicates() const { return static_cast<std::int64_t>(replicate_sums.size()); }
};

/// Renders replicates of a reference: balance heuristic, halton-owen, binary64; or finds them in the cache.
class ReferenceRenderer {
 public:
  /// Replicates of `goal.samples` each. Throws Error(kBadInput) for more samples than the points have.
  ReferenceRenderer(const IntegralSource& source, const std::string& name, const std::vector<int>& pixels,
                    const ReferenceGoal& goal, const ReferenceOptions& options, const SamplerCatalogue& samplers);

  std::uint64_t samples() const { return rounds_ * static_cast<std::uint64_t>(allocation_.round()); }
  std::size_t channels() const { return static_cast<std::size_t>(source_.channels()); }

  bool cached(std::int64_t replicates) const {
    return !options_.cache.empty() && std::filesystem::exists(file(replicates));
  }
  /// Brings the state to `replicates`, from the cache if it is there: 16, or twice what the state has.
  void extend(ReferenceState& state, std::int64_t replicates) {
    if (load(state, replicates)) return;
    render(state, replicates);
    save(state);
  }

 private:
  void render(ReferenceState& state, std::int64_t replicates);
  std::filesystem::path file(std::int64_t replicates) const;
  std::string full_key(std::int64_t replicates) const {
    return fmt::format("{}\nreplicates {}\n", key_text_, replicates);
  }
  bool load(ReferenceState& state, std::int64_t replicates) const;
  void save(const ReferenceState& state) const;

  const IntegralSource& source_;
  const std::string& name_;
  const std::vector<int>& pixels_;
  const ReferenceOptions& options_;
  const SamplerCatalogue& samplers_;
  Allocation allocation_;
  std::uint64_t rounds_;
  std::string key_text_;
};

}  // namespace halfslope
