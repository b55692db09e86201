#include "analysis/coverage_timing.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "analysis/timing.h"
#include "core/random.h"

namespace halfslope {
namespace {

/// Random numbers of one run of one row, which depend on nothing else.
class Draws {
 public:
  Draws(StreamKey key, std::int64_t run) : key_(key), run_(static_cast<std::uint64_t>(run)) {}

  /// In (0, 1), the middles of 2³² cells.
  double uniform() {
    const std::uint32_t word = random_word(key_, Draw::kHigh, 0, next_++, static_cast<std::uint32_t>(run_),
                                           static_cast<std::uint32_t>(run_ >> 32));
    return (word + 0.5) * 0x1p-32;
  }
  double normal() {  // Box and Muller; half of what they give suffices here
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  StreamKey key_;
  std::uint64_t run_;
  std::uint32_t next_ = 0;
};

/// A law of times, and its median.
struct TimeLaw {
  std::string name;
  double median;
  std::function<double(Draws&)> draw;
};

TimeLaw lognormal_times(double sigma) {
  return {fmt::format("lognormal({})", sigma), 1, [sigma](Draws& random) { return std::exp(sigma * random.normal()); }};
}

std::vector<TimeLaw> time_laws() {
  const double spread = 0.02;
  return {
      {"normal", 1, [](Draws& random) { return 1 + 0.05 * random.normal(); }},
      {"1 + exponential", 1 + std::log(2), [](Draws& random) { return 1 - std::log(random.uniform()); }},
      // Three in five are fast, so half of all are below the quantile 5/6 of the fast.
      {"two speeds", std::exp(0.967421566101701 * spread),
       [](Draws& random) { return (random.uniform() < 0.6 ? 1 : 1.3) * std::exp(0.02 * random.normal()); }},
  };
}

struct Outcome {
  bool covered = false;
  double width = 0;  ///< log(hi / lo)
};

/// A row of runs, each of which `simulate` makes with random numbers of its own. False where it was stopped.
bool add_row(std::vector<CoverageRow>& rows, CoverageRow row, const CoverageRequest& request, double share,
             const std::function<Outcome(std::uint64_t run, Draws& random)>& simulate) {
  const StreamKey key = stream_key(request.seed, fmt::format("{},{}", row.law, row.replicates), "coverage of times");
  row.runs = request.runs;
  for (std::int64_t run = 0; run < request.runs; ++run) {
    Draws random(key, run);
    const Outcome outcome = simulate(static_cast<std::uint64_t>(run), random);
    row.covered += outcome.covered ? 1 : 0;
    row.width += outcome.width / static_cast<double>(request.runs);
    if (request.progress && !request.progress(share / static_cast<double>(request.runs))) return false;
  }
  rows.push_back(std::move(row));
  return true;
}

std::vector<double> draw_times(const TimeLaw& law, std::size_t count, Draws& random) {
  std::vector<double> times(count);
  for (double& time : times) time = law.draw(random);
  return times;
}

Outcome median_run(const TimeLaw& law, std::size_t count, Draws& random) {
  const Interval interval = median_estimate(draw_times(law, count, random)).interval;
  return {interval.lo <= law.median && law.median <= interval.hi, std::log(interval.hi / interval.lo)};
}

/// Gaussian errors with an RMSE of 1.
Outcome efficiency_run(const TimeLaw& law, std::uint64_t run, Draws& random) {
  std::vector<double> squares(64);
  double sum = 0;
  for (double& square : squares) {
    const double error = random.normal();
    sum += square = error * error;
  }
  const auto interval = log_mean_bootstrap_t(squares, run);
  if (!interval) return {};
  const PositiveEstimate rmse = {std::sqrt(sum / 64), std::exp(interval->lo / 2), std::exp(interval->hi / 2)};
  const MedianEstimate time = median_estimate(draw_times(law, 15, random));
  const PositiveEstimate e = efficiency(rmse, {time.median, time.interval.lo, time.interval.hi});
  return {*e.lo <= 1 && 1 <= *e.hi, std::log(*e.hi / *e.lo)};
}

}  // namespace

std::vector<CoverageRow> timing_coverage(const CoverageRequest& request) {
  std::vector<CoverageRow> rows;
  // A bootstrap takes about as long as fifty medians.
  constexpr double kMedianShare = 0.02 / 9, kEfficiencyShare = 0.98 / 2;
  for (const TimeLaw& law : time_laws()) {
    for (const std::size_t count : {6, 15, 51}) {
      CoverageRow row;
      row.number = "time";
      row.method = "order statistics";
      row.law = law.name;
      row.replicates = static_cast<std::int64_t>(count);
      const auto simulate = [&](std::uint64_t, Draws& random) { return median_run(law, count, random); };
      if (!add_row(rows, std::move(row), request, kMedianShare, simulate)) return rows;
    }
  }
  for (const double sigma : {0.05, 0.5}) {
    CoverageRow row;
    row.number = "efficiency";
    row.method = "quadrature";
    row.law = fmt::format("Gaussian, 15 times lognormal({})", sigma);
    row.replicates = 64;
    const TimeLaw law = lognormal_times(sigma);
    const auto simulate = [&](std::uint64_t run, Draws& random) { return efficiency_run(law, run, random); };
    if (!add_row(rows, std::move(row), request, kEfficiencyShare, simulate)) return rows;
  }
  return rows;
}

}  // namespace halfslope
