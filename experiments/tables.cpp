#include "experiments/tables.h"

#include <cmath>

#include "core/csv.h"

namespace halfslope {
namespace {

// The first columns of every table.
void key_cells(CsvWriter& csv, const Plan& plan, const Cell& cell) {
  const PlannedScene& scene = plan.scenes[cell.scene];
  csv.cell(scene.name).cell(scene.estimators[cell.estimator].name).cell(cell.sampler).cell(to_string(cell.precision));
}

std::optional<double> if_finite(double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; }

}  // namespace

std::string convergence_csv(const Plan& plan, const Results& results) {
  CsvWriter csv({"scene",     "estimator", "sampler",      "precision",     "samples", "replicates", "pixels",
                 "mean",      "reference", "reference_se", "reference_mse", "bias",    "bias_se",    "variance",
                 "rmse",      "rmse_lo",   "rmse_hi",      "mae",           "relmse",  "kurtosis",   "median_abs_error",
                 "nonfinite", "status"});
  for (std::size_t c = 0; c < plan.cells.size(); ++c) {
    const Cell& cell = plan.cells[c];
    const CellStatistics& s = results.cells[c].statistics;
    key_cells(csv, plan, cell);
    csv.cell(cell.samples).cell(plan.passes[cell.pass].replicates).cell(plan.scenes[cell.scene].pixels.size());
    csv.cell(s.mean).cell(if_finite(s.reference)).cell(if_finite(s.reference_se)).cell(if_finite(s.reference_mse));
    csv.cell(s.bias).cell(s.bias_se);
    csv.cell(s.variance).cell(s.rmse).cell(s.rmse_lo).cell(s.rmse_hi).cell(s.mae).cell(s.relmse).cell(s.kurtosis);
    csv.cell(s.median_abs_error).cell(s.nonfinite).cell(s.status).end_row();
  }
  return csv.text();
}

ReplicatesTable::ReplicatesTable()
    : csv_({"scene", "estimator", "sampler", "precision", "samples", "replicate", "mean", "mse", "mae",
            "max_abs_error"}) {}

namespace {

// A number that is not finite is an empty cell, as in the other tables.
std::optional<double> finite(double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; }

}  // namespace

void ReplicatesTable::add(const Plan& plan, const Cell& cell, const std::vector<ReplicateErrors>& replicates) {
  for (std::size_t r = 0; r < replicates.size(); ++r) {
    key_cells(csv_, plan, cell);
    csv_.cell(cell.samples).cell(r).cell(finite(replicates[r].mean)).cell(finite(replicates[r].mse));
    csv_.cell(finite(replicates[r].mae)).cell(finite(replicates[r].max_abs_error)).end_row();
  }
}

std::string rates_csv(const Plan& plan, const Results& results) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "rate", "rate_lo", "rate_hi", "samples_lo", "samples_hi",
                 "theory", "status"});
  for (const RateResult& rate : results.rates) {
    key_cells(csv, plan, plan.cells[rate.first_cell]);
    csv.cell(rate.fit.rate);
    csv.cell(rate.fit.interval ? std::optional(rate.fit.interval->lo) : std::nullopt);
    csv.cell(rate.fit.interval ? std::optional(rate.fit.interval->hi) : std::nullopt);
    const bool window = rate.fit.samples_hi > 0;
    csv.cell(window ? std::optional(rate.fit.samples_lo) : std::nullopt);
    csv.cell(window ? std::optional(rate.fit.samples_hi) : std::nullopt);
    csv.cell(rate.theory).cell(rate.fit.status).end_row();
  }
  return csv.text();
}

std::string regions_csv(const Plan& plan, const Results& results) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "samples", "region", "pixels", "rmse", "rmse_lo",
                 "rmse_hi", "relmse", "relmse_lo", "relmse_hi"});
  bool any = false;
  for (std::size_t c = 0; c < plan.cells.size(); ++c) {
    for (const RegionResult& region : results.cells[c].regions) {
      any = true;
      key_cells(csv, plan, plan.cells[c]);
      csv.cell(plan.cells[c].samples).cell(region.region).cell(region.pixels);
      csv.cell(region.rmse).cell(region.rmse_lo).cell(region.rmse_hi);
      csv.cell(region.relmse).cell(region.relmse_lo).cell(region.relmse_hi).end_row();
    }
  }
  return any ? csv.text() : "";
}

}  // namespace halfslope
