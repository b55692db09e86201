// What is measured, and what is left out.
#include <algorithm>

#include "experiments/fold.h"
#include "experiments/joined.h"
#include "experiments/measures.h"
#include "experiments/measures_layout.h"

namespace halfslope {
namespace {

// A set of these and the tree over it take 200 MB, and some seconds.
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 20;

MeasuredPoints plan_points(const Spec& spec, const Sampler& sampler, std::vector<std::string>& left_out) {
  const SamplerInfo& info = sampler.info();
  MeasuredPoints points = {info.name, info.sequence, {}, 1, stream_key(spec.seed, info.name, "run")};
  if (info.randomised) points.replicates = std::min(spec.replicates, kMostKept);
  if (info.max_dims < kPair.dims()) {
    left_out.push_back(fmt::format("discrepancy: sampler '{}' has no pairs of dimensions: left out", info.name));
    return points;
  }
  std::vector<std::uint64_t> illegal, too_many;
  for (const std::uint64_t count : spec.samples.counts) {
    auto& list = count > kMostPoints ? too_many : sampler.illegal(count, kPair) ? illegal : points.counts;
    list.push_back(count);
  }
  if (!illegal.empty()) {
    left_out.push_back(
        fmt::format("discrepancy: sampler '{}' has no pairs at N = {}: left out", info.name, joined(illegal)));
  }
  if (!too_many.empty()) {
    left_out.push_back(fmt::format("discrepancy: N = {}: left out, since at most {} points are measured",
                                   joined(too_many), kMostPoints));
  }
  return points;
}

}  // namespace

std::size_t MeasuresPlan::rows() const {
  std::size_t rows = 0;
  for (const MeasuredPoints& p : points)
    rows += p.counts.size() * static_cast<std::size_t>(p.replicates) * measures.size();
  return rows;
}

MeasuresPlan plan_measures(const Spec& spec, const SamplerCatalogue& samplers, std::vector<std::string>& left_out) {
  MeasuresPlan plan;
  for (const MeasureInfo& info : measure_catalogue()) {
    if (std::find(spec.measures.begin(), spec.measures.end(), info.name) != spec.measures.end())
      plan.measures.push_back(&info);
  }
  if (plan.measures.empty()) return plan;
  bool fewer = false;
  for (const std::string& name : spec.samplers) {
    plan.points.push_back(plan_points(spec, *samplers.make(name), left_out));
    fewer |= plan.points.back().replicates == kMostKept && spec.replicates > kMostKept;
  }
  if (fewer) {
    left_out.push_back(fmt::format("discrepancy: replicates {} to {} left out: the first {} are measured", kMostKept,
                                   spec.replicates - 1, kMostKept));
  }
  return plan;
}

std::string describe_measures(const MeasuresPlan& plan) {
  std::string names, text;
  for (const MeasureInfo* info : plan.measures) names += (names.empty() ? "" : " + ") + info->name;
  for (const MeasuredPoints& p : plan.points) {
    if (p.counts.empty()) continue;
    text += fmt::format("  discrepancy, {}: {} at N = {}{}, {} replicate{}, {} dimensions\n", p.sampler, names,
                        p.counts.front(), p.counts.size() > 1 ? fmt::format(" … {}", p.counts.back()) : "",
                        p.replicates, p.replicates == 1 ? "" : "s", kPair.dims());
  }
  return text;
}

}  // namespace halfslope
