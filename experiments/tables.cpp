#include "experiments/tables.h"

#include <cmath>

#include "analysis/tails.h"
#include "core/csv.h"

namespace halfslope {
namespace {

// The first columns of every table.
void key_cells(CsvWriter& csv, const CellName& name) {
  csv.cell(name.scene).cell(name.estimator).cell(name.sampler).cell(name.precision);
}

// A number that is not finite is an empty cell.
std::optional<double> if_finite(double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; }

}  // namespace

std::string convergence_csv(const Results& results) {
  CsvWriter csv({"scene",     "estimator", "sampler",      "precision",     "samples", "replicates", "pixels",
                 "mean",      "reference", "reference_se", "reference_mse", "bias",    "bias_se",    "variance",
                 "rmse",      "rmse_lo",   "rmse_hi",      "mae",           "relmse",  "kurtosis",   "median_abs_error",
                 "nonfinite", "status"});
  for (const CellResult& cell : results.cells) {
    const CellStatistics& s = cell.statistics;
    key_cells(csv, cell.name);
    csv.cell(cell.name.samples).cell(cell.replicates).cell(cell.pixels);
    const auto if_known = [&](double x) { return cell.facts.reference_known ? if_finite(x) : std::nullopt; };
    csv.cell(s.mean).cell(if_finite(s.reference)).cell(if_known(s.reference_se)).cell(if_known(s.reference_mse));
    csv.cell(s.bias).cell(s.bias_se);
    csv.cell(s.variance).cell(s.rmse).cell(s.rmse_lo).cell(s.rmse_hi).cell(s.mae).cell(s.relmse).cell(s.kurtosis);
    csv.cell(s.median_abs_error).cell(s.nonfinite).cell(s.status).end_row();
  }
  return csv.text();
}

ReplicatesTable::ReplicatesTable()
    : csv_({"scene", "estimator", "sampler", "precision", "samples", "replicate", "mean", "mse", "mae",
            "max_abs_error"}) {}

void ReplicatesTable::add(const CellName& cell, const std::vector<ReplicateErrors>& replicates,
                          std::span<const std::uint64_t> numbers) {
  for (std::size_t r = 0; r < replicates.size(); ++r) {
    key_cells(csv_, cell);
    csv_.cell(cell.samples)
        .cell(numbers.empty() ? r : numbers[r])
        .cell(if_finite(replicates[r].mean))
        .cell(if_finite(replicates[r].mse));
    csv_.cell(if_finite(replicates[r].mae)).cell(if_finite(replicates[r].max_abs_error)).end_row();
  }
}

std::string rates_csv(const Results& results) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "rate", "rate_lo", "rate_hi", "samples_lo", "samples_hi",
                 "theory", "status"});
  for (const RateResult& rate : results.rates) {
    key_cells(csv, results.cells[rate.first_cell].name);
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

std::string local_rates_csv(const Results& results) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "samples_lo", "samples_hi", "rate", "rate_lo", "rate_hi",
                 "status"});
  for (const LocalRateResult& rate : results.local_rates) {
    key_cells(csv, results.cells[rate.first_cell].name);
    csv.cell(rate.fit.samples_lo).cell(rate.fit.samples_hi).cell(rate.fit.rate);
    csv.cell(rate.fit.interval ? std::optional(rate.fit.interval->lo) : std::nullopt);
    csv.cell(rate.fit.interval ? std::optional(rate.fit.interval->hi) : std::nullopt).cell(rate.fit.status).end_row();
  }
  return csv.text();
}

std::string tails_csv(const Results& results) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "samples", "kurtosis", "kurtosis_corrected",
                 "kurtosis_limit", "median_abs_error", "worst_share", "certified", "relmse_lo", "relmse_hi"});
  for (const CellResult& cell : results.cells) {
    const CellStatistics& s = cell.statistics;
    key_cells(csv, cell.name);
    csv.cell(cell.name.samples).cell(s.kurtosis);
    csv.cell(s.kurtosis_corrected ? if_finite(*s.kurtosis_corrected) : std::nullopt);
    csv.cell(s.kurtosis ? std::optional(kurtosis_limit(cell.replicates)) : std::nullopt);
    csv.cell(s.median_abs_error).cell(s.worst_share);
    csv.cell(s.rmse_lo || s.rmse_hi ? (s.certified ? "yes" : "no") : "");
    csv.cell(s.relmse_lo).cell(s.relmse_hi).end_row();
  }
  return csv.text();
}

std::string comparisons_csv(const Results& results) {
  CsvWriter csv({"scene",
                 "precision",
                 "samples",
                 "estimator_a",
                 "sampler_a",
                 "estimator_b",
                 "sampler_b",
                 "replicates",
                 "mse_ratio",
                 "mse_ratio_lo",
                 "mse_ratio_hi",
                 "p",
                 "p_adjusted",
                 "verdict",
                 "power_10_percent",
                 "power_10_percent_lo",
                 "power_10_percent_hi",
                 "replicates_10_percent",
                 "replicates_10_percent_lo",
                 "replicates_10_percent_hi",
                 "status"});
  const auto exp_of = [](const std::optional<double>& x) {
    return x && std::isnormal(std::exp(*x)) ? std::optional(std::exp(*x)) : std::nullopt;
  };
  const auto predicted = [&](const std::optional<Prediction>& prediction) {
    for (double Prediction::*end : {&Prediction::value, &Prediction::lo, &Prediction::hi})
      csv.cell(prediction ? if_finite((*prediction).*end) : std::nullopt);
  };
  bool any = false;
  for (const ComparisonFamily& family : results.comparisons) {
    for (const auto& [a, b, c] : family.rows) {
      any = true;
      const CellName &x = results.cells[a].name, &y = results.cells[b].name;
      csv.cell(x.scene).cell(x.precision).cell(x.samples);
      csv.cell(x.estimator).cell(x.sampler).cell(y.estimator).cell(y.sampler).cell(c.replicates);
      csv.cell(exp_of(c.log_ratio));
      csv.cell(exp_of(c.interval ? std::optional(c.interval->lo) : std::nullopt));
      csv.cell(exp_of(c.interval ? std::optional(c.interval->hi) : std::nullopt));
      csv.cell(c.p).cell(c.p_adjusted).cell(to_string(c.verdict));
      predicted(c.power);
      predicted(c.replicates_needed);
      csv.cell(c.status).end_row();
    }
  }
  return any ? csv.text() : "";
}

std::string regions_csv(const Results& results) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "samples", "region", "pixels", "rmse", "rmse_lo",
                 "rmse_hi", "relmse", "relmse_lo", "relmse_hi"});
  bool any = false;
  for (const CellResult& cell : results.cells) {
    for (const RegionResult& region : cell.regions) {
      any = true;
      key_cells(csv, cell.name);
      csv.cell(cell.name.samples).cell(region.region).cell(region.pixels);
      csv.cell(region.rmse).cell(region.rmse_lo).cell(region.rmse_hi);
      csv.cell(region.relmse).cell(region.relmse_lo).cell(region.relmse_hi).end_row();
    }
  }
  return any ? csv.text() : "";
}

}  // namespace halfslope
