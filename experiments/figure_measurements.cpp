#include "experiments/figure_measurements.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/parameters.h"
#include "experiments/command_flags.h"
#include "experiments/figure_samplers.h"
#include "experiments/joined.h"
#include "experiments/message.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

// 40 bytes each, so 1.3 GB.
constexpr std::size_t kMostValues = std::size_t{1} << 25;

void append(MeasuresPlan& plan, MeasuresPlan more) {
  for (MeasuredPoints& points : more.points) {
    for (MeasuredCount& n : points.counts) {
      for (std::size_t& m : n.measures) m += plan.measures.size();
    }
    plan.points.push_back(std::move(points));
  }
  for (Measure& measure : more.measures) plan.measures.push_back(std::move(measure));
}

}  // namespace

FigureMeasurements measure_for_figure(const FigureRequest& request, const Catalogue& catalogue,
                                      const std::vector<MeasuresRequest>& requests) {
  FigureMeasurements measured;
  for (const MeasuresRequest& r : requests) {
    for (const std::string& name : r.samplers) {
      const auto sampler = catalogue.samplers.make(name);
      for (const std::uint64_t count : r.counts.counts) {
        if (!r.counts.is_range) check_count(*sampler, count, pairs(r.dims), "--samples");
      }
    }
    std::vector<std::string> left_out;
    MeasuresPlan plan = flag("--measures", [&] { return plan_measures(r, catalogue.samplers, left_out); });
    const bool nothing = std::ranges::any_of(plan.points, [](const MeasuredPoints& p) { return p.rows() == 0; });
    if (!left_out.empty() && (nothing || !r.counts.is_range)) fail(ExitCode::kUsage, "{}", left_out.front());
    for (const std::string& line : left_out) {
      if (!request.quiet) message("halfslope: {}\n", line);
    }
    append(measured.plan, std::move(plan));
  }
  if (const std::size_t rows = measured.plan.rows(); rows > kMostValues) {
    fail(ExitCode::kUsage, "{} values are more than the {} that are held; ask for fewer replicates, samplers or bins",
         rows, kMostValues);
  }
  try {
    measured.values = measure_points(measured.plan, catalogue.samplers, request.threads, request.name, request.quiet);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kInterrupted) throw;
    fail(ExitCode::kInterrupted, "interrupted while the samplers' points were measured; nothing was drawn");
  }
  measured.means = measured_means(measured.plan, measured.values);
  return measured;
}

std::vector<std::string> figure_measures(const FigureRequest& request, std::vector<std::string> usual,
                                         const std::vector<std::string>& allowed, const std::string& parameters) {
  std::vector<std::string> names = request.spec.measures.empty() ? std::move(usual) : request.spec.measures;
  std::vector<std::string> heads;
  for (std::string& name : names) {
    const std::string head(split_name(name).head);
    if (std::ranges::find(allowed, head) == allowed.end()) {
      fail(ExitCode::kUsage, "--measures: the figure '{}' does not draw '{}'; allowed: {}", request.name, name,
           joined(allowed));
    }
    if (std::ranges::find(heads, head) != heads.end()) fail(ExitCode::kUsage, "--measures: '{}' once at a time", head);
    heads.push_back(head);
    if (name == head && !parameters.empty()) name += ":" + parameters;
  }
  return names;
}

bool same_count(const std::vector<MeasuredMean>& means) {
  return std::ranges::all_of(means, [&](const MeasuredMean& m) { return m.count == means.front().count; });
}

std::string measured_subtitle(const std::vector<MeasuredMean>& means, std::uint64_t seed) {
  std::int64_t fewest = std::numeric_limits<std::int64_t>::max(), replicates = 1;
  for (const MeasuredMean& mean : means) {
    fewest = std::min(fewest, mean.points->replicates);
    replicates = std::max(replicates, mean.points->replicates);
  }
  std::string text;
  if (!means.empty() && same_count(means)) text += fmt::format("N = {}, ", means.front().count);
  if (!means.empty() && means.front().points->layout.dims() != 2) {
    const int dims = means.front().points->layout.dims();
    text += fmt::format("{} dimension{}, ", dims, dims == 1 ? "" : "s");
  }
  return text + fmt::format("{}{} replicate{}, seed {}", fewest < replicates ? "up to " : "", replicates,
                            replicates == 1 ? "" : "s", seed);
}

}  // namespace halfslope
