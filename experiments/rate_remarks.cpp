// What the fits of rates found, in sentences.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "experiments/tables.h"

namespace halfslope {
namespace {

/// A line's fit that says most of large N: its window's, else that over every N, with an interval.
struct LineFits {
  const RateResult* plain = nullptr;
  const RateResult* window = nullptr;
  const RateResult* best() const {
    if (window && window->fit.interval) return window;
    return plain && plain->fit.interval ? plain : nullptr;
  }
};

std::string theory_remark(const std::string& line, const RateResult& rate) {
  const RateFit& fit = rate.fit;
  if (!rate.theory || (fit.interval->lo <= *rate.theory && *rate.theory <= fit.interval->hi)) return "";
  const bool slower = fit.interval->lo > *rate.theory;
  return fmt::format(
      "{}: measured and theory disagree: the RMSE falls {} than theory's N^{}, with a rate of {:.2f} "
      "[{:.3f}, {:.3f}] over N = {} to {}.\n",
      line, slower ? "more slowly" : "faster", *rate.theory, *fit.rate, fit.interval->lo, fit.interval->hi,
      fit.samples_lo, fit.samples_hi);
}

std::string floor_remark(const std::string& line, const RateFit& fit) {
  if (!fit.floor_mse) return "";
  const std::string text = fmt::format(
      "{}: errors stop falling at an RMSE near {:.2g}, a floor that no rate is "
      "fitted through",
      line, std::sqrt(*fit.floor_mse));
  if (!fit.rate) return text + ".\n";
  return text + fmt::format("; before it, to N = {}, the rate is {:.2f}.\n", fit.samples_hi, *fit.rate);
}

}  // namespace

std::string rate_remarks(const Results& results) {
  std::string text;
  for (std::size_t i = 0; i < results.rates.size();) {
    LineFits line;
    const std::size_t first = results.rates[i].first_cell;
    for (; i < results.rates.size() && results.rates[i].first_cell == first; ++i) {
      const RateResult& rate = results.rates[i];
      if (rate.kind == RateKind::kPlain) line.plain = &rate;
      if (rate.kind == RateKind::kWindow) line.window = &rate;
    }
    const CellName& cell = results.cells[first].name;
    const std::string name = fmt::format("{}, {}, {}, {}", cell.scene, cell.estimator, cell.sampler, cell.precision);
    if (line.window) text += floor_remark(name, line.window->fit);
    if (const RateResult* best = line.best()) text += theory_remark(name, *best);
  }
  return text;
}

}  // namespace halfslope
