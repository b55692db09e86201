// What is measured, and what is left out.
#include <algorithm>
#include <iterator>

#include "experiments/fold.h"
#include "experiments/joined.h"
#include "experiments/measures.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

// A set of these and the tree over it take 200 MB, and some seconds.
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 20;
// Of one set; up to four are held at once.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 31;
// 32 bytes each, so 1 GB.
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 25;

/// What is left out of one sampler's measures, a line for each reason.
class LeftOut {
 public:
  explicit LeftOut(std::vector<std::string>& lines) : lines_(lines) {}
  ~LeftOut() {
    for (const Reason& r : reasons_)
      lines_.push_back(fmt::format("measures: {}N = {}{}", r.before, joined(r.counts), r.after));
  }
  LeftOut(const LeftOut&) = delete;
  LeftOut& operator=(const LeftOut&) = delete;
  /// What stands before the counts tells reasons apart; what stands after them is that of the last one.
  void add(const std::string& before, std::uint64_t count, const std::string& after) {
    const auto known = std::ranges::find(reasons_, before, &Reason::before);
    Reason& reason = known == reasons_.end() ? reasons_.emplace_back(Reason{before, {}, ""}) : *known;
    reason.counts.push_back(count);
    reason.after = after;
  }

 private:
  struct Reason {
    std::string before;
    std::vector<std::uint64_t> counts;
    std::string after;
  };
  std::vector<std::string>& lines_;
  std::vector<Reason> reasons_;
};

/// The generator matrices of the sampler's points up to `count`, if they are a digital net.
std::optional<GeneratorMatrices> matrices_of(const Sampler& sampler, int dims, std::uint64_t count) {
  const auto one = sampler.generator_matrices(dims, 1);
  if (!one) return std::nullopt;
  int digits = 1;
  for (std::uint64_t power = one->base; power < count; power *= one->base) ++digits;
  return sampler.generator_matrices(dims, digits);
}

/// The measures that `count` of the points have, and what their values are called.
MeasuredCount measured_count(const MeasuredPoints& points, std::span<const Measure> measures, std::uint64_t count,
                             LeftOut& left_out) {
  const auto dims = static_cast<std::size_t>(points.layout.dims());
  MeasuredCount n = {count, {}, {}};
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const std::string problem = measures[m].refusal(count, dims);
    if (!problem.empty() && !points.net_gives(measures[m], count)) {
      left_out.add(measures[m].name + " at ", count, ": left out, since " + problem);
      continue;
    }
    std::vector<std::string> rows = measures[m].rows(count, dims);
    const std::uint64_t values = rows.size() * static_cast<std::uint64_t>(points.replicates);
    if (values > kMostValues) {
      left_out.add(measures[m].name + " at ", count,
                   fmt::format(": left out, since its {} values of all replicates are more than the {} that are held",
                               values, kMostValues));
      continue;
    }
    n.measures.push_back(m);
    std::ranges::move(rows, std::back_inserter(n.rows));
  }
  return n;
}

MeasuredPoints plan_points(const MeasuresRequest& request, const Sampler& sampler, std::span<const Measure> measures,
                           std::vector<std::string>& lines) {
  const SamplerInfo& info = sampler.info();
  const Layout layout = pairs(request.dims);
  const auto dims = static_cast<std::size_t>(request.dims);
  MeasuredPoints points = {info.name, layout, info.sequence, {}, 1, stream_key(request.seed, info.name, "run")};
  points.replicates = std::min(info.replicates_of(request.replicates), kMostKept);
  if (info.max_dims < request.dims) {
    lines.push_back(fmt::format("measures: sampler '{}' has at most {} dimension{}, not {}: left out", info.name,
                                info.max_dims, info.max_dims == 1 ? "" : "s", request.dims));
    return points;
  }
  LeftOut left_out(lines);
  const auto gigabytes = [](std::uint64_t bytes) {
    return fmt::format("{:.3g} GB", static_cast<double>(bytes) * 1e-9);
  };
  for (const std::uint64_t count : request.counts.counts) {
    if (const std::uint64_t bytes = count * dims * sizeof(double); count > kMostPoints) {
      left_out.add("", count, fmt::format(": left out, since at most {} points are measured", kMostPoints));
    } else if (bytes > kMostBytes) {
      left_out.add("", count,
                   fmt::format(": left out, since the points would take {} in {} dimensions; at most {} are held",
                               gigabytes(bytes), dims, gigabytes(kMostBytes)));
    } else if (sampler.illegal(count, layout)) {
      left_out.add(fmt::format("sampler '{}' cannot make ", info.name), count,
                   fmt::format(" points in {} dimensions: left out", dims));
    } else {
      points.matrices = matrices_of(sampler, request.dims, count);
      points.counts.push_back(measured_count(points, measures, count, left_out));
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
    left_out.push_back(fmt::format("measures: replicates {} to {} left out: the first {} are measured", kMostKept,
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
