// What the fits of rates found, in sentences.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/normal.h"
#include "analysis/status.h"
#include "experiments/tables.h"

namespace halfslope {
namespace {

/// The fits of one line.
struct LineFits {
  const RateResult* plain = nullptr;
  const RateResult* window = nullptr;
  /// The one that says most of large N: the window's, else that over every N, with an interval that can be trusted.
  const RateResult* best() const {
    if (window && is_certified(window->fit)) return window;
    return plain && is_certified(plain->fit) ? plain : nullptr;
  }
};

std::vector<LineFits> line_fits(const Results& results) {
  std::vector<LineFits> lines;
  for (const RateResult& rate : results.rates) {
    if (rate.kind == RateKind::kPlain) lines.push_back({&rate, nullptr});
    if (rate.kind == RateKind::kWindow) lines.back().window = &rate;
  }
  return lines;
}

/// `widening` is what 95 % intervals are multiplied by.
std::string theory_remark(const std::string& line, const RateResult& rate, double widening) {
  const RateFit& fit = rate.fit;
  const double difference = *rate.theory - *fit.rate;
  if (widening * (fit.interval->lo - *fit.rate) <= difference &&
      difference <= widening * (fit.interval->hi - *fit.rate))
    return "";
  return fmt::format(
      "{}: measured and theory disagree: over N = {} to {} the RMSE falls {} than theory's N^{} (logarithms aside), "
      "with a rate of {:.2f} [{:.3f}, {:.3f}]{}.\n",
      line, fit.samples_lo, fit.samples_hi, difference < 0 ? "more slowly" : "faster", *rate.theory, *fit.rate,
      fit.interval->lo, fit.interval->hi, has_mark(fit.status, "pre-asymptotic") ? ", and follows no line" : "");
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
  const std::vector<LineFits> lines = line_fits(results);
  const auto judged = [](const LineFits& line) { return line.best() && line.best()->theory; };
  const auto count = static_cast<double>(std::ranges::count_if(lines, judged));
  const double widening = count > 0 ? normal_quantile(1 - 0.025 / count) / kNormal975 : 1;  // Bonferroni
  std::string text;
  for (const LineFits& line : lines) {
    const std::string name = line_text(results.cells[line.plain->first_cell].name);
    if (line.window) text += floor_remark(name, line.window->fit);
    if (judged(line)) text += theory_remark(name, *line.best(), widening);
  }
  return text;
}

}  // namespace halfslope
