// From the cells of a line of convergence to its rate.
#include "core/random.h"
#include "experiments/results.h"

namespace halfslope {
namespace {

RateResult fit_line(const std::vector<CellResult>& cells, std::size_t begin, std::size_t end) {
  const CellResult& first = cells[begin];
  std::vector<double> samples, reference_mse;
  std::vector<std::vector<double>> mse;
  const bool kept = !first.replicate_mse.empty();
  for (std::size_t c = begin; c < end; ++c) {
    samples.push_back(static_cast<double>(cells[c].name.samples));
    reference_mse.push_back(cells[c].statistics.reference_mse);
    mse.push_back(kept ? cells[c].replicate_mse : std::vector<double>{cells[c].mse});
  }
  RateResult rate;
  rate.first_cell = begin;
  rate.fit = fit_rate(samples, mse, reference_mse, hash_text(line_text(first.name), 1), first.facts.rounding_mse);
  if (const auto mark = rate.fit.status.find("deterministic"); !kept && mark != std::string::npos) {
    // One number at each N not because there was one replicate: they are not kept, so there is no interval.
    rate.fit.status.replace(mark, std::string("deterministic").size(), "many-replicates");
  }
  if (first.facts.infinite_variance) {
    // The slope would be that of the largest values that happened to be met.
    rate.fit.rate.reset();
    rate.fit.interval.reset();
    rate.fit.status = rate.fit.status.starts_with("invalid") ? "invalid;infinite-variance" : "infinite-variance";
    return rate;
  }
  rate.theory = first.facts.theory;
  return rate;
}

}  // namespace

std::vector<RateResult> fit_rates(const std::vector<CellResult>& cells) {
  std::vector<RateResult> rates;
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
    while (end < cells.size() && same_line(cells[begin].name, cells[end].name)) ++end;
    rates.push_back(fit_line(cells, begin, end));
  }
  return rates;
}

}  // namespace halfslope
