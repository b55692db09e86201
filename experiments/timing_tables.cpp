#include "experiments/timing_tables.h"

#include "core/csv.h"

namespace halfslope {
namespace {

void line_cells(CsvWriter& csv, const CellName& name) {
  csv.cell(name.scene).cell(name.estimator).cell(name.sampler).cell(name.precision);
}

void median_cells(CsvWriter& csv, const MedianEstimate& estimate) {
  csv.cell(estimate.median).cell(estimate.interval.lo).cell(estimate.interval.hi);
}

void estimate_cells(CsvWriter& csv, const std::optional<PositiveEstimate>& estimate) {
  if (!estimate) {
    csv.empty_cell().empty_cell().empty_cell();
    return;
  }
  csv.cell(estimate->value).cell(estimate->lo).cell(estimate->hi);
}

std::string equal_csv(const std::vector<EqualWork>& table, std::vector<std::string> columns) {
  CsvWriter csv{std::span<const std::string>(columns)};
  for (const EqualWork& work : table) {
    for (const LineAnswer& line : work.lines) {
      const WorkAnswer& answer = line.answer;
      const bool inside = answer.reach == Reach::kInside;
      line_cells(csv, line.line);
      csv.cell(work.at).cell(inside ? std::optional(answer.samples) : std::nullopt);
      estimate_cells(csv, inside ? std::optional(answer.value) : std::nullopt);
      csv.cell(line.status()).end_row();
    }
  }
  return csv.text();
}

}  // namespace

std::string timing_csv(const std::vector<TimingResult>& rows) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "samples", "ns_per_sample", "ns_lo", "ns_hi",
                 "efficiency", "efficiency_lo", "efficiency_hi"});
  for (const TimingResult& row : rows) {
    line_cells(csv, row.name);
    csv.cell(row.name.samples);
    median_cells(csv, row.all);
    estimate_cells(csv, row.efficiency);
    csv.end_row();
  }
  return csv.text();
}

std::string timing_parts_csv(const std::vector<TimingResult>& rows) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "samples", "points_ns", "points_ns_lo", "points_ns_hi",
                 "evaluation_ns", "evaluation_ns_lo", "evaluation_ns_hi", "coverage", "repetitions", "pixels",
                 "estimates", "status"});
  for (const TimingResult& row : rows) {
    line_cells(csv, row.name);
    csv.cell(row.name.samples);
    median_cells(csv, row.points);
    median_cells(csv, row.evaluation);
    csv.cell(row.all.coverage).cell(row.times.runs.size()).cell(row.times.pixels).cell(row.times.estimates);
    csv.cell(row.status).end_row();
  }
  return csv.text();
}

std::string equal_time_csv(const std::vector<TimingResult>& rows) {
  return equal_csv(equal_times(rows), {"scene", "estimator", "sampler", "precision", "seconds", "samples", "rmse",
                                       "rmse_lo", "rmse_hi", "status"});
}

std::string equal_error_csv(const std::vector<TimingResult>& rows) {
  return equal_csv(equal_errors(rows), {"scene", "estimator", "sampler", "precision", "rmse", "samples", "seconds",
                                        "seconds_lo", "seconds_hi", "status"});
}

}  // namespace halfslope
