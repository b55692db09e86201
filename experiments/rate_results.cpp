// From the cells of lines of convergence to their rates.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "analysis/status.h"
#include "core/random.h"
#include "experiments/parallel.h"
#include "experiments/results.h"

namespace halfslope {
namespace {

/// Cells [begin, end) differ in N only, which rises.
struct Line {
  std::size_t begin, end;
};

/// The replicates that every cell of the line has kept, the first so many: with a target, cells have different numbers.
std::size_t common_replicates(const std::vector<CellResult>& cells, Line line) {
  std::size_t common = cells[line.begin].replicate_mse.size();
  for (std::size_t c = line.begin; c < line.end; ++c) common = std::min(common, cells[c].replicate_mse.size());
  return common;
}

std::vector<double> first_of(const std::vector<double>& values, std::size_t count) {
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)};
}

RateData data_of(const std::vector<CellResult>& cells, Line line) {
  const CellResult& first = cells[line.begin];
  const std::size_t common = common_replicates(cells, line);
  RateData data;
  bool varied = true;
  for (std::size_t c = line.begin; c < line.end; ++c) {
    data.samples.push_back(static_cast<double>(cells[c].name.samples));
    data.mse.push_back(common == 0 ? std::vector<double>{cells[c].mse} : first_of(cells[c].replicate_mse, common));
    data.variance.push_back(cells[c].statistics.variance.value_or(0));
    varied = varied && cells[c].statistics.variance;
    data.heavy_tailed.push_back(has_mark(cells[c].statistics.status, "heavy-tailed"));
  }
  if (!varied) data.variance.clear();
  data.reference = {first.statistics.reference_mse, first.reference_mse_variance};
  data.rounding_mse = first.facts.rounding_mse;
  return data;
}

/// The rate of the sample variance, where every cell has what its replicates add to it.
std::optional<RateFit> variance_fit(const std::vector<CellResult>& cells, Line line, std::uint64_t seed) {
  const std::size_t common = common_replicates(cells, line);
  RateData data;
  for (std::size_t c = line.begin; c < line.end; ++c) {
    if (common < 2 || cells[c].replicate_variance.size() < common) return {};
    const std::vector<double> spread = first_of(cells[c].replicate_variance, common);
    if (!std::ranges::all_of(spread, [](double x) { return std::isfinite(x); })) return {};
    data.samples.push_back(static_cast<double>(cells[c].name.samples));
    data.mse.push_back(spread);
    data.heavy_tailed.push_back(has_mark(cells[c].statistics.status, "heavy-tailed"));
  }
  data.rounding_mse = cells[line.begin].facts.rounding_mse;
  RateFit fit = fit_rate(data, seed);
  fit.status = fit.status == "ok" ? "variance" : "variance;" + fit.status;
  return fit;
}

/// One number at each N is not a sign of a deterministic sampler where replicates are not kept.
void name_unkept(std::string& status) {
  const std::string found = "deterministic";
  if (const auto mark = status.find(found); mark != std::string::npos)
    status.replace(mark, found.size(), "many-replicates");
}

RateResults fit_line(const std::vector<CellResult>& cells, Line line) {
  const CellResult& first = cells[line.begin];
  const std::uint64_t seed = hash_text(line_text(first.name), 1);
  LineRates fits = analyse_rates(data_of(cells, line), seed);
  RateFit& plain = fits.plain;
  if (common_replicates(cells, line) == 0) {
    name_unkept(plain.status);
    for (LocalRate& local : fits.local) name_unkept(local.status);
  }
  if (first.facts.infinite_variance) {
    // The slope would be that of the largest values that happened to be met.
    plain.rate.reset();
    plain.interval.reset();
    plain.status = has_mark(plain.status, "invalid") ? "invalid;infinite-variance" : "infinite-variance";
    return {{{line.begin, plain, std::nullopt, RateKind::kPlain}}, {}};
  }
  RateResults results;
  const auto add = [&](const RateFit& fit, RateKind kind) {
    results.rates.push_back({line.begin, fit, first.facts.theory, kind});
  };
  add(plain, RateKind::kPlain);
  // Where the line is straight over every N its window says nothing new.
  const bool narrower = fits.window && (!plain.rate || fits.window->samples_lo > plain.samples_lo ||
                                        fits.window->samples_hi < plain.samples_hi);
  if (narrower) add(*fits.window, RateKind::kWindow);
  if (first.facts.unbiased && has_mark(plain.status, "reference-limited")) {
    if (const auto fit = variance_fit(cells, line, seed)) add(*fit, RateKind::kVariance);
  }
  for (const LocalRate& local : fits.local) results.local.push_back({line.begin, local});
  return results;
}

}  // namespace

RateResults fit_rates(const std::vector<CellResult>& cells, int threads) {
  std::vector<Line> lines;
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
    while (end < cells.size() && same_line(cells[begin].name, cells[end].name)) ++end;
    lines.push_back({begin, end});
  }
  std::vector<RateResults> fitted(lines.size());
  with_threads(threads, [&](int) {
    tbb::parallel_for(
        std::size_t{0}, lines.size(), [&](std::size_t i) { fitted[i] = fit_line(cells, lines[i]); },
        tbb::simple_partitioner());
  });
  RateResults all;
  for (const RateResults& line : fitted) {
    all.rates.insert(all.rates.end(), line.rates.begin(), line.rates.end());
    all.local.insert(all.local.end(), line.local.begin(), line.local.end());
  }
  return all;
}

}  // namespace halfslope
