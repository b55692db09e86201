#include "experiments/plan_references.h"

#include <algorithm>
#include <cmath>

#include "experiments/joined.h"
#include "experiments/message.h"
#include "experiments/pilot.h"

namespace halfslope {
namespace {

constexpr double kMostShare = 0.01;
constexpr double kShareOfSpread = 0.25;
constexpr std::uint64_t kLeastSamples = 256, kTimesLargest = 4, kMostGrowth = 64;
constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 30;  // halton-owen has twice that many points

std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

std::vector<std::string> unique(std::vector<std::string> names) {
  std::vector<std::string> once;
  for (std::string& name : names) {
    if (std::ranges::find(once, name) == once.end()) once.push_back(std::move(name));
  }
  return once;
}

// "halton-owen stands in for halton", "file:p.txt has one replicate": what the pilot does not measure itself.
std::vector<std::string> remarks(const Pilot& pilot) {
  std::vector<std::string> stood_for, all;
  for (const PilotPass& pass : pilot.passes) {
    if (!pass.in_place_of.empty()) stood_for.push_back(pass.in_place_of);
  }
  if (!stood_for.empty()) all.push_back("halton-owen stands in for " + joined(unique(std::move(stood_for))));
  for (const std::string& reason : unique(pilot.left_out)) all.push_back(reason + ", so it has no say");
  return all;
}

// What the pilot allows; tells what it found.
AllowedVariance allowed_variance(const Plan& plan, std::size_t scene, std::span<const double> variances,
                                 const SamplerCatalogue& samplers, const ReferenceOptions& options) {
  const ExpectedError expected =
      run_pilot(plan, scene, plan_pilot(plan, scene, samplers), variances, samplers, options.threads, options.quiet);
  const double share = reference_share(plan, scene);
  const AllowedVariance allowed = {share * expected.mse, expected.cell};
  if (options.quiet) return allowed;
  const std::string& name = plan.scenes[scene].name;
  if (expected.mse > 0) {
    message("{}: its reference may have a variance of {:.3g}, {} of the smallest error expected ({})\n", name,
            allowed.most, percent(share), expected.cell);
  } else {
    message("{}: the pilot met no error, so nothing is asked of its reference\n", name);
  }
  if (expected.mse > 0 && expected.without_error > 0) {
    message("{}: {} of {} cells showed no error above rounding and had no say in that\n", name, expected.without_error,
            expected.cells);
  }
  return allowed;
}

}  // namespace

double reference_share(const Plan& plan, std::size_t scene) {
  std::int64_t replicates = 1;
  for (const Pass& pass : plan.passes) {
    if (pass.scene == scene) replicates = std::max(replicates, pass.replicates);
  }
  return std::min(kMostShare, kShareOfSpread / std::sqrt(static_cast<double>(replicates)));
}

ReferenceGoal reference_goal(const Plan& plan, std::size_t scene) {
  std::uint64_t largest = 1;
  for (const Cell& cell : plan.cells) {
    if (cell.scene == scene) largest = std::max(largest, cell.samples);
  }
  ReferenceGoal goal;
  goal.samples = std::clamp(kTimesLargest * std::min(largest, kMostSamples), kLeastSamples, kMostSamples);
  goal.most_samples = std::min(kMostGrowth * goal.samples, kMostSamples);
  return goal;
}

std::vector<Reference> make_references(const Plan& plan, const SamplerCatalogue& samplers,
                                       const ReferenceOptions& options) {
  std::vector<Reference> references;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s) {
    const PlannedScene& scene = plan.scenes[s];
    ReferenceGoal goal = reference_goal(plan, s);
    goal.allowed = [&](std::span<const double> variances) {
      return allowed_variance(plan, s, variances, samplers, options);
    };
    references.push_back(make_reference(*scene.source, scene.name, scene.pixels, goal, options, samplers));
  }
  return references;
}

std::vector<std::string> describe_references(const Plan& plan, const SamplerCatalogue& samplers) {
  std::vector<std::string> lines;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s) {
    const PlannedScene& scene = plan.scenes[s];
    if (has_closed_form(*scene.source, scene.pixels)) continue;
    const ReferenceGoal goal = reference_goal(plan, s);
    const Pilot pilot = plan_pilot(plan, s, samplers);
    std::string line = fmt::format("{}: 16 replicates of N = {} or more", scene.name, goal.samples);
    if (!pilot.passes.empty() && pilot.pixels > 0) {
      line += fmt::format(
          ", until their variance is at most {} of the smallest error of a pilot: {} {} x {} replicates of {} {}, "
          "{:.3g} "
          "integrand evaluations",
          percent(reference_share(plan, s)), pilot.pixels, pilot.pixels == 1 ? "pixel" : "pixels", kPilotReplicates,
          pilot.passes.size(), pilot.passes.size() == 1 ? "pass" : "passes", pilot.evaluations());
    }
    for (const std::string& remark : remarks(pilot)) line += "; " + remark;
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::string> describe_cached_references(const Plan& plan, const SamplerCatalogue& samplers,
                                                    const std::filesystem::path& cache) {
  std::vector<std::string> lines;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s) {
    const PlannedScene& scene = plan.scenes[s];
    const CachedReplicates held =
        cached_replicates(*scene.source, scene.pixels, reference_goal(plan, s), cache, samplers);
    if (held.replicates == 0) continue;
    lines.push_back(fmt::format("{}: {} replicates of N = {} of its reference are in {}: not rendered again",
                                scene.name, held.replicates, held.samples, cache.string()));
  }
  return lines;
}

}  // namespace halfslope
