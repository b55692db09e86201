#include "experiments/convergence_lines.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/status.h"
#include "core/atomic_file.h"
#include "core/csv_reader.h"
#include "core/error.h"
#include "experiments/joined.h"

namespace halfslope {
namespace {

ConvergenceLine* find_line(std::vector<ConvergenceLine>& lines, const CsvReader& table, std::size_t row) {
  for (ConvergenceLine& line : lines) {
    if (line.scene == table.text(row, "scene") && line.estimator == table.text(row, "estimator") &&
        line.sampler == table.text(row, "sampler") && line.precision == table.text(row, "precision"))
      return &line;
  }
  return nullptr;
}

/// Refuses a name that no row has: a typing error would otherwise draw less than was asked for.
void check_names(const char* flag, const std::vector<std::string>& wanted, const CsvReader& table, const char* column) {
  std::vector<std::string> found;
  for (std::size_t r = 0; r < table.size(); ++r) {
    const std::string& name = table.text(r, column);
    if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
  }
  for (const std::string& name : wanted) {
    if (std::find(found.begin(), found.end(), name) == found.end()) {
      const std::string nearest = did_you_mean(name, found);
      fail(ExitCode::kUsage, "{}: the run has no {} '{}'{} it has {}", flag, column, name,
           nearest.empty() ? ";" : nearest, joined(found));
    }
  }
}

bool wanted(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

bool certified(const std::string& status) { return status == "ok" || status == "deterministic"; }

void add_row(ConvergenceLine& line, const CsvReader& table, std::size_t row) {
  const auto rmse = table.number(row, "rmse");
  const std::string& status = table.text(row, "status");
  if (!rmse || !(*rmse > 0)) {
    if (line.left_out++ == 0) line.status = status;
    return;
  }
  const auto positive = [](std::optional<double> x) { return x && *x > 0 ? x : std::nullopt; };
  line.points.push_back({table.required_number(row, "samples"), *rmse, positive(table.number(row, "rmse_lo")),
                         positive(table.number(row, "rmse_hi")), certified(status)});
}

void read_rates(const std::filesystem::path& path, std::vector<ConvergenceLine>& lines) {
  if (!std::filesystem::exists(path)) return;
  const CsvReader table = CsvReader::open(path);
  std::vector<double> widest(lines.size(), -1);
  for (std::size_t r = 0; r < table.size(); ++r) {
    ConvergenceLine* line = find_line(lines, table, r);
    if (!line) continue;
    const auto from = table.number(r, "samples_lo"), to = table.number(r, "samples_hi");
    const double width = from && to && *from > 0 ? *to / *from : 0;
    const std::string& status = table.text(r, "status");
    const bool further = has_mark(status, "asymptotic") || has_mark(status, "floor");
    if (further && width > 0 && table.number(r, "rate")) line->window = {*from, *to};
    double& best = widest[static_cast<std::size_t>(line - lines.data())];
    if (width <= best) continue;
    best = width;
    line->rate = table.number(r, "rate");
    line->rate_status = status;
    line->theory = table.number(r, "theory");
    const auto lo = table.number(r, "rate_lo"), hi = table.number(r, "rate_hi");
    line->rate_interval = lo && hi ? std::optional(Interval{*lo, *hi}) : std::nullopt;
  }
}

}  // namespace

std::vector<ConvergenceLine> read_convergence_lines(const std::filesystem::path& folder, const LineFilter& filter) {
  const std::filesystem::path path = folder / "convergence.csv";
  if (!std::filesystem::is_directory(folder)) {
    fail(ExitCode::kBadInput, "{}: there is no such run folder; make one with `halfslope run EXPERIMENT --out {}`",
         folder.string(), folder.string());
  }
  if (!std::filesystem::exists(path)) {
    fail(ExitCode::kBadInput,
         "{}: there is no convergence.csv; if a run was interrupted, repeat its command and it goes on",
         folder.string());
  }
  const CsvReader table = CsvReader::open(path);
  if (table.size() == 0) fail(ExitCode::kBadInput, "{}: has no rows; nothing was measured", path.string());
  check_names("--scene", filter.scenes, table, "scene");
  check_names("--estimators", filter.estimators, table, "estimator");
  check_names("--samplers", filter.samplers, table, "sampler");
  check_names("--precision", filter.precisions, table, "precision");
  std::vector<ConvergenceLine> lines;
  for (std::size_t r = 0; r < table.size(); ++r) {
    if (!wanted(filter.scenes, table.text(r, "scene")) || !wanted(filter.estimators, table.text(r, "estimator")) ||
        !wanted(filter.samplers, table.text(r, "sampler")) || !wanted(filter.precisions, table.text(r, "precision")))
      continue;
    ConvergenceLine* line = find_line(lines, table, r);
    if (!line) {
      lines.push_back(
          {table.text(r, "scene"), table.text(r, "estimator"), table.text(r, "sampler"), table.text(r, "precision")});
      line = &lines.back();
    }
    if (!(table.required_number(r, "samples") > 0)) {
      fail(ExitCode::kBadInput, "{}: column 'samples': found {}; a positive number is allowed", path.string(),
           table.text(r, "samples"));
    }
    add_row(*line, table, r);
  }
  if (lines.empty()) {
    fail(ExitCode::kUsage, "{}: no row has all of --scene, --estimators, --samplers and --precision that were asked",
         path.string());
  }
  for (ConvergenceLine& line : lines) {
    std::sort(line.points.begin(), line.points.end(),
              [](const LinePoint& a, const LinePoint& b) { return a.samples < b.samples; });
  }
  read_rates(folder / "rates.csv", lines);
  return lines;
}

void read_times(const std::filesystem::path& folder, std::vector<ConvergenceLine>& lines) {
  const std::filesystem::path path = folder / "timing.csv";
  if (!std::filesystem::exists(path)) {
    fail(ExitCode::kBadInput,
         "{}: there is no timing.csv: run the experiment again with the key `timing`, e.g. --timing 15; what is "
         "measured "
         "already is not measured again",
         folder.string());
  }
  const CsvReader table = CsvReader::open(path);
  for (std::size_t r = 0; r < table.size(); ++r) {
    ConvergenceLine* line = find_line(lines, table, r);
    if (!line) continue;
    const double samples = table.required_number(r, "samples");
    const auto point = std::ranges::find(line->points, samples, &LinePoint::samples);
    if (point == line->points.end()) continue;
    const auto seconds = [&](const char* column) { return samples * 1e-9 * table.required_number(r, column); };
    point->seconds = seconds("ns_per_sample");
    point->seconds_lo = seconds("ns_lo");
    point->seconds_hi = seconds("ns_hi");
    if (!(*point->seconds_lo > 0)) {
      fail(ExitCode::kBadInput, "{}: column 'ns_lo': found {}; a positive number is allowed", path.string(),
           table.text(r, "ns_lo"));
    }
  }
  for (ConvergenceLine& line : lines) {
    const std::size_t untimed = std::erase_if(line.points, [](const LinePoint& p) { return !p.seconds; });
    line.left_out += untimed;
    if (untimed > 0 && line.status.empty()) line.status = "not timed";
  }
}

void read_local_rates(const std::filesystem::path& folder, std::vector<ConvergenceLine>& lines) {
  const std::filesystem::path path = folder / "local_rates.csv";
  if (!std::filesystem::exists(path)) {
    fail(ExitCode::kBadInput, "{}: there is no local_rates.csv; repeat the run's command with --overwrite to make one",
         folder.string());
  }
  const CsvReader table = CsvReader::open(path);
  for (std::size_t r = 0; r < table.size(); ++r) {
    ConvergenceLine* line = find_line(lines, table, r);
    const auto rate = table.number(r, "rate");
    if (!line || !rate) continue;
    const double from = table.required_number(r, "samples_lo"), to = table.required_number(r, "samples_hi");
    if (!(from > 0 && to > from)) {
      fail(ExitCode::kBadInput, "{}: found samples_lo {} and samples_hi {}; two rising positive numbers are allowed",
           path.string(), table.text(r, "samples_lo"), table.text(r, "samples_hi"));
    }
    line->local_rates.push_back(
        {from, to, *rate, table.number(r, "rate_lo"), table.number(r, "rate_hi"), certified(table.text(r, "status"))});
  }
}

std::string run_name(const std::filesystem::path& folder) {
  std::error_code ignored;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(folder, ignored);
  const std::string own = whole.filename().empty() ? folder.string() : whole.filename().string();
  try {
    return nlohmann::json::parse(read_file(folder / "manifest.json")).at("name").get<std::string>();
  } catch (const std::exception&) {
    return own;  // a title is no reason to refuse a figure
  }
}

}  // namespace halfslope
