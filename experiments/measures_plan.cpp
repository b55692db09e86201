// What is measured, and what is left out.
#include <algorithm>

#include "experiments/fold.h"
#include "experiments/joined.h"
#include "experiments/measures.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

// A set of these and the tree over it take 200 MB, and some seconds.
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 20;
// Of one set; as many as there are threads may be held at once.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 31;

/// Positions in `measures` of those that can measure so many points, and what their values are called.
MeasuredCount measured_count(std::span<const Measure> measures, std::uint64_t count, std::size_t dims) {
  MeasuredCount n = {count, {}, {}};
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (!measures[m].refusal(count, dims).empty()) continue;
    n.measures.push_back(m);
    for (std::string& row : measures[m].rows(count, dims)) n.rows.push_back(std::move(row));
  }
  return n;
}

MeasuredPoints plan_points(const MeasuresRequest& request, const Sampler& sampler, std::span<const Measure> measures,
                           std::vector<std::string>& left_out) {
  const SamplerInfo& info = sampler.info();
  const Layout layout = pairs(request.dims);
  const auto dims = static_cast<std::size_t>(request.dims);
  MeasuredPoints points = {info.name, layout, info.sequence, {}, 1, stream_key(request.seed, info.name, "run")};
  points.replicates = std::min(info.replicates_of(request.replicates), kMostKept);
  if (info.max_dims < request.dims) {
    left_out.push_back(fmt::format("discrepancy: sampler '{}' has at most {} dimension{}, not {}: left out", info.name,
                                   info.max_dims, info.max_dims == 1 ? "" : "s", request.dims));
    return points;
  }
  std::vector<std::uint64_t> illegal, too_many, too_large;
  for (const std::uint64_t count : request.counts.counts) {
    if (count > kMostPoints) {
      too_many.push_back(count);
    } else if (count * dims * sizeof(double) > kMostBytes) {
      too_large.push_back(count);
    } else if (sampler.illegal(count, layout)) {
      illegal.push_back(count);
    } else {
      points.counts.push_back(measured_count(measures, count, dims));
    }
  }
  if (!illegal.empty()) {
    left_out.push_back(fmt::format("discrepancy: sampler '{}' cannot make N = {} points in {} dimensions: left out",
                                   info.name, joined(illegal), request.dims));
  }
  if (!too_many.empty()) {
    left_out.push_back(fmt::format("discrepancy: N = {}: left out, since at most {} points are measured",
                                   joined(too_many), kMostPoints));
  }
  if (!too_large.empty()) {
    left_out.push_back(
        fmt::format("discrepancy: N = {}: left out, since the points would take {:.3g} GB in {} dimensions; at most "
                    "{:.3g} are held",
                    joined(too_large), static_cast<double>(too_large.front() * dims * sizeof(double)) * 1e-9, dims,
                    static_cast<double>(kMostBytes) * 1e-9));
  }
  for (const Measure& measure : measures) {
    std::vector<std::uint64_t> refused;
    std::string why;
    for (const MeasuredCount& n : points.counts) {
      const std::string problem = measure.refusal(n.count, dims);
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

MeasuresPlan plan_measures(const MeasuresRequest& request, const SamplerCatalogue& samplers,
                           std::vector<std::string>& left_out) {
  MeasuresPlan plan;
  for (const std::string& name : request.measures) plan.measures.push_back(make_measure(name));
  if (plan.measures.empty()) return plan;
  std::int64_t most = 0;
  for (const std::string& name : request.samplers) {
    const auto sampler = samplers.make(name);
    plan.points.push_back(plan_points(request, *sampler, plan.measures, left_out));
    most = std::max(most, sampler->info().replicates_of(request.replicates));
  }
  if (most > kMostKept) {
    left_out.push_back(fmt::format("discrepancy: replicates {} to {} left out: the first {} are measured", kMostKept,
                                   most - 1, kMostKept));
  }
  return plan;
}

MeasuresPlan plan_measures(const Spec& spec, const SamplerCatalogue& samplers, std::vector<std::string>& left_out) {
  return plan_measures({spec.samplers, spec.samples, 2, spec.measures, spec.replicates, spec.seed}, samplers, left_out);
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
