// measure: discrepancies, spacings and spectra of samplers' points and of points from files.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/csv.h"
#include "core/error.h"
#include "experiments/command_flags.h"
#include "experiments/commands.h"
#include "experiments/fold.h"
#include "experiments/interrupt.h"
#include "experiments/measures.h"
#include "experiments/message.h"
#include "experiments/spec.h"
#include "experiments/spectrum_image.h"
#include "samplers/file_points.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

constexpr std::int64_t kSummaryReplicates = 64;

/// The measures that `all` stands for: those that are one number and take these points.
std::vector<std::string> all_measures(int dims) {
  std::vector<std::string> names;
  for (const MeasureInfo& info : measure_catalogue()) {
    const auto d = static_cast<std::size_t>(dims);
    if (!info.curve && info.min_dims <= d && d <= info.max_dims) names.push_back(info.name);
  }
  return names;
}

std::vector<std::string> sampler_names(const MeasureArguments& a, const Catalogue& catalogue) {
  Spec spec;
  if (!a.samplers.empty()) apply_flag(spec, "samplers", a.samplers, "sampler");
  const char* prefix = a.wrap ? "file-wrap:" : a.clamp ? "file-clamp:" : "file:";
  for (const std::string& path : a.files) spec.samplers.push_back(prefix + path);
  if (spec.samplers.empty()) {
    fail(ExitCode::kUsage,
         "nothing to measure: give --sampler NAME (`halfslope list samplers` names them) or --points FILE");
  }
  if ((a.wrap || a.clamp) && a.files.empty())
    fail(ExitCode::kUsage, "--{}: is about the points of --points FILE", a.wrap ? "wrap" : "clamp");
  for (const std::string& name : spec.samplers) make_sampler(catalogue, name, "--sampler");
  return spec.samplers;
}

/// The N of --count; of files alone all their points, unless it says otherwise.
SampleCounts counts_of(const MeasureArguments& a, const std::vector<std::string>& names,
                       const SamplerCatalogue& samplers) {
  Spec spec;
  if (!a.counts.empty()) {
    apply_flag(spec, "samples", a.counts, "count");
    return spec.samples;
  }
  for (const std::string& name : names) {
    const SamplerInfo info = samplers.make(name)->info();  // a copy: the sampler is gone after this line
    if (!info.replicates && a.files.empty())
      fail(ExitCode::kUsage, "--count is missing: how many points, such as 1024, 16:1024 or a list");
    if (!point_file_of(name).empty()) spec.samples.counts.push_back(info.max_count);
  }
  std::ranges::sort(spec.samples.counts);
  const auto repeated = std::ranges::unique(spec.samples.counts);
  spec.samples.counts.erase(repeated.begin(), repeated.end());
  spec.samples.is_range = spec.samples.counts.size() > 1;
  return spec.samples;
}

/// Where --dims is not given: the columns of files, else 2.
int dims_of(const MeasureArguments& a, const std::vector<std::string>& names, const SamplerCatalogue& samplers) {
  if (a.dims) {
    if (*a.dims < 1) fail(ExitCode::kUsage, "--dims: at least 1, found {}", *a.dims);
    for (const std::string& name : names) {
      const int most = samplers.make(name)->info().max_dims;
      if (*a.dims > most)
        fail(ExitCode::kUsage, "--dims: '{}' has at most {} dimensions, found {}", name, most, *a.dims);
    }
    return *a.dims;
  }
  if (a.files.empty()) return 2;
  int dims = std::numeric_limits<int>::max();
  for (const std::string& name : names) dims = std::min(dims, samplers.make(name)->info().max_dims);
  return dims;
}

/// In a list each N must be measured as asked; inside a range what cannot be is left out, and told.
void check_counts(const MeasuresRequest& request, const SamplerCatalogue& samplers, const MeasuresPlan& plan,
                  const std::vector<std::string>& left_out) {
  for (const std::string& name : request.samplers) {
    const auto sampler = samplers.make(name);
    for (const std::uint64_t count : request.counts.counts) {
      if (!request.counts.is_range) check_count(*sampler, count, pairs(request.dims), "--count");
    }
  }
  if (plan.rows() == 0 || (!left_out.empty() && !request.counts.is_range))
    fail(ExitCode::kUsage, "{}nothing was measured", left_out.empty() ? "" : left_out.front() + "; ");
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
    fail(ExitCode::kIo, "the measurements could not be written to standard output");
}

/// Prints rows as CSV or JSON, both with the same keys.
class Printer {
 public:
  Printer(std::vector<std::string> columns, bool json) : columns_(std::move(columns)), csv_(columns_), json_(json) {
    if (json_) print("[");
  }
  template <class... Values>
  void row(const Values&... values) {
    if (!json_) {
      csv_.row(values...);
      if (++rows_ % 4096 == 0) print(csv_.take_text());
      return;
    }
    nlohmann::ordered_json object;
    std::size_t k = 0;
    ((object[columns_[k++]] = values), ...);
    print((rows_++ == 0 ? "\n  " : ",\n  ") + object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  }
  void finish() { print(json_ ? "\n]\n" : csv_.take_text()); }

 private:
  std::vector<std::string> columns_;
  CsvWriter csv_;
  bool json_;
  std::size_t rows_ = 0;
};

void print_replicates(const MeasuresPlan& plan, const Measurements& measured, bool json) {
  const auto columns = discrepancy_columns();
  Printer printer({columns.begin(), columns.end()}, json);
  visit_measurements(plan, measured,
                     [&](const MeasuredPoints& p, std::uint64_t count, std::int64_t replicate, const std::string& name,
                         const MeasuredValue& value) {
                       printer.row(p.sampler, p.layout.dims(), count, replicate, name, value.value, value.lower,
                                   value.upper, value.method);
                     });
  printer.finish();
}

void print_summary(const MeasuresPlan& plan, const Measurements& measured, bool json) {
  Printer printer({"sampler", "dims", "count", "replicates", "measure", "value", "lower", "upper", "method"}, json);
  for (const MeasuredMean& mean : measured_means(plan, measured)) {
    printer.row(mean.points->sampler, mean.points->layout.dims(), mean.count, mean.points->replicates, mean.name,
                mean.value, mean.lower, mean.upper, mean.method);
  }
  printer.finish();
}

/// Tells of points that coincide, where distances were asked for.
void note_coincidences(const MeasuresPlan& plan, const Measurements& measured) {
  std::set<std::string> told;
  visit_measurements(plan, measured,
                     [&](const MeasuredPoints& p, std::uint64_t count, std::int64_t replicate, const std::string& name,
                         const MeasuredValue& value) {
                       if (!name.starts_with("min-distance") || value.value != 0) return;
                       if (!told.insert(fmt::format("{} {}", p.sampler, count)).second) return;
                       message("halfslope: {}, N = {}, replicate {}: points coincide, so their distance is 0\n",
                               p.sampler, count, replicate);
                     });
}

}  // namespace

int measure_command(const MeasureArguments& a, const Catalogue& catalogue) {
  const InterruptGuard guard;
  MeasuresRequest request;
  request.samplers = sampler_names(a, catalogue);
  request.counts = counts_of(a, request.samplers, catalogue.samplers);
  request.dims = dims_of(a, request.samplers, catalogue.samplers);
  if (a.measures == "all") {
    request.measures = all_measures(request.dims);
  } else {
    Spec spec;
    apply_flag(spec, "measures", a.measures);
    request.measures = spec.measures;
  }
  if (request.measures.empty()) fail(ExitCode::kUsage, "--measures: none is nothing to do");
  request.replicates = a.replicates.value_or(a.summary ? kSummaryReplicates : 1);
  if (request.replicates < 1 || request.replicates > kMostKept)
    fail(ExitCode::kUsage, "--replicates: from 1 to {}, found {}", kMostKept, request.replicates);
  request.seed = a.seed;
  std::vector<std::string> left_out;
  const MeasuresPlan plan = plan_measures(request, catalogue.samplers, left_out);
  if (a.measures == "all") request.counts.is_range = true;  // what some measures cannot do is told, and no mistake
  check_counts(request, catalogue.samplers, plan, left_out);
  if (!a.quiet) {
    for (const std::string& line : left_out) message("halfslope: {}\n", line);
  }
  const Measurements measured = measure_points(plan, catalogue.samplers, a.threads, "measure", a.quiet);
  if (!a.quiet) note_coincidences(plan, measured);
  if (!a.exr.empty()) write_spectrum_image(a.exr, plan, measured);
  a.summary ? print_summary(plan, measured, a.json) : print_replicates(plan, measured, a.json);
  return static_cast<int>(ExitCode::kDone);
}

}  // namespace halfslope
