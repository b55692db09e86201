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

MeasuredPoints plan_points(const Spec& spec, const Sampler& sampler, std::span<const Measure> measures,
                           std::vector<std::string>& left_out) {
  const SamplerInfo& info = sampler.info();
  MeasuredPoints points = {info.name, kPair, info.sequence, {}, 1, stream_key(spec.seed, info.name, "run")};
  points.replicates = std::min(info.replicates_of(spec.replicates), kMostKept);
  if (info.max_dims < kPair.dims()) {
    left_out.push_back(fmt::format("discrepancy: sampler '{}' has no pairs of dimensions: left out", info.name));
    return points;
  }
  std::vector<std::uint64_t> illegal, too_many;
  for (const std::uint64_t count : spec.samples.counts) {
    if (count > kMostPoints) {
      too_many.push_back(count);
    } else if (sampler.illegal(count, kPair)) {
      illegal.push_back(count);
    } else {
      points.counts.push_back(measured_count(measures, count, static_cast<std::size_t>(kPair.dims())));
    }
  }
  if (!illegal.empty()) {
    left_out.push_back(
        fmt::format("discrepancy: sampler '{}' has no pairs at N = {}: left out", info.name, joined(illegal)));
  }
  if (!too_many.empty()) {
    left_out.push_back(fmt::format("discrepancy: N = {}: left out, since at most {} points are measured",
                                   joined(too_many), kMostPoints));
  }
  for (const Measure& measure : measures) {
    std::vector<std::uint64_t> refused;
    std::string why;
    for (const MeasuredCount& n : points.counts) {
      const std::string problem = measure.refusal(n.count, static_cast<std::size_t>(kPair.dims()));
      if (problem.empty()) continue;
      refused.push_back(n.count);
      why = problem;
    }
    if (!refused.empty()) {
      left_out.push_back(
          fmt::format("discrepancy: {} at N = {}: left out, since {}", measure.name, joined(refused), why));
    }
  }
  return points;
}

}  // namespace

MeasuredCount measured_count(std::span<const Measure> measures, std::uint64_t count, std::size_t dims) {
  MeasuredCount n = {count, {}, {}};
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (!measures[m].refusal(count, dims).empty()) continue;
    n.measures.push_back(m);
    for (std::string& row : measures[m].rows(count, dims)) n.rows.push_back(std::move(row));
  }
  return n;
}

std::size_t MeasuredPoints::rows() const {
  std::size_t rows = 0;
  for (const MeasuredCount& n : counts) rows += n.rows.size() * static_cast<std::size_t>(replicates);
  return rows;
}

std::size_t MeasuresPlan::rows() const {
  std::size_t rows = 0;
  for (const MeasuredPoints& p : points) rows += p.rows();
  return rows;
}

MeasuresPlan plan_measures(const Spec& spec, const SamplerCatalogue& samplers, std::vector<std::string>& left_out) {
  MeasuresPlan plan;
  for (const std::string& name : spec.measures) plan.measures.push_back(make_measure(name));
  if (plan.measures.empty()) return plan;
  bool fewer = false;
  for (const std::string& name : spec.samplers) {
    plan.points.push_back(plan_points(spec, *samplers.make(name), plan.measures, left_out));
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
  for (const Measure& measure : plan.measures) names += (names.empty() ? "" : " + ") + measure.name;
  for (const MeasuredPoints& p : plan.points) {
    if (p.counts.empty()) continue;
    text += fmt::format("  discrepancy, {}: {} at N = {}{}, {} replicate{}, {} dimensions\n", p.sampler, names,
                        p.counts.front().count, p.counts.size() > 1 ? fmt::format(" … {}", p.counts.back().count) : "",
                        p.replicates, p.replicates == 1 ? "" : "s", p.layout.dims());
  }
  return text;
}

}  // namespace halfslope
