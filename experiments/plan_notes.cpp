#include "experiments/plan_notes.h"

#include <algorithm>
#include <span>

#include "estimators/skip_worth.h"
#include "experiments/joined.h"

namespace halfslope {
namespace {

// What skips are worth was measured on these.
bool is_rendered(const PlannedScene& scene) { return !scene.source->regions().empty(); }

}  // namespace

void note_unused_techniques(Plan& plan) {
  for (const PlannedScene& scene : plan.scenes) {
    const auto techniques = scene.source->techniques();
    std::vector<std::string> unused;
    for (std::size_t t = 0; t < techniques.size(); ++t) {
      const bool used = std::any_of(scene.estimators.begin(), scene.estimators.end(), [&](const Estimator& e) {
        const auto& drawn = e.allocation.techniques;
        return std::find(drawn.begin(), drawn.end(), static_cast<int>(t)) != drawn.end();
      });
      if (!used) unused.push_back(techniques[t].name);
    }
    if (unused.empty() || scene.estimators.empty()) continue;
    plan.skips.push_back(fmt::format("{}: no estimator draws {}: none of their samples, and none of their densities{}",
                                     scene.name, joined(unused),
                                     unused.size() > 2 && is_rendered(scene) ? worth(kWorthNoUnusedTechniques) : ""));
  }
}

void note_sharing(Plan& plan) {
  for (const Pass& pass : plan.passes) {
    if (pass.estimators.size() > 1) {
      std::vector<std::string> names;
      for (const std::size_t e : pass.estimators) names.push_back(plan.scenes[pass.scene].estimators[e].name);
      plan.skips.push_back(
          fmt::format("{}, {}, {}: {} share one pass over the same samples{}", plan.scenes[pass.scene].name,
                      pass.sampler, to_string(pass.precision), joined(names),
                      names.size() > 2 && is_rendered(plan.scenes[pass.scene]) ? worth(kWorthSharedPass) : ""));
    }
    if (pass.sequence && pass.samples.size() > 1) {
      const std::span smaller(pass.samples.data(), pass.samples.size() - 1);
      plan.skips.push_back(fmt::format(
          "{}, {}, {}: a sequence, so N = {} {} of one pass to {}", plan.scenes[pass.scene].name, pass.sampler,
          to_string(pass.precision), smaller.front(),
          smaller.size() > 1 ? fmt::format("… {} are prefixes", smaller.back()) : "is a prefix", pass.samples.back()));
    }
  }
}

void note_optimal(Plan& plan) {
  for (const PlannedScene& scene : plan.scenes) {
    for (const Estimator& e : scene.estimators) {
      if (e.heuristic.kind != HeuristicKind::kOptimal) continue;
      plan.skips.push_back(fmt::format(
          "{}: its weights are solved for from the samples that they weight, so it is biased at small N, as 1/N: see "
          "column bias; optimal-progressive is not, at independent samples",
          e.name));
    }
  }
}

}  // namespace halfslope
