#include "analysis/coverage_intervals.h"

#include <algorithm>
#include <cmath>

#include "analysis/tails.h"

namespace halfslope {
namespace {

/// One run: R images, as a cell's statistics see them.
struct SimulatedRun {
  std::vector<double> mse, mean;  ///< of each replicate
  double sum_m2_squared = 0, sum_m4 = 0;
};

SimulatedRun simulate(const ErrorImages& images, std::int64_t replicates, RunRandom random) {
  const std::size_t pixels = images.scales.size();
  const auto p = static_cast<double>(pixels), r = static_cast<double>(replicates);
  SimulatedRun run;
  std::vector<double> sums(4 * pixels);  // of each pixel's powers; errors are about 0, so these lose no digits
  double* powers[] = {sums.data(), sums.data() + pixels, sums.data() + 2 * pixels, sums.data() + 3 * pixels};
  for (std::int64_t i = 0; i < replicates; ++i) {
    double sum = 0, squares = 0;
    for (std::size_t k = 0; k < pixels; ++k) {
      const double e = images.scales[k] * images.law.draw(random), square = e * e;
      sum += e;
      squares += square;
      powers[0][k] += e;
      powers[1][k] += square;
      powers[2][k] += square * e;
      powers[3][k] += square * square;
    }
    run.mean.push_back(sum / p);
    run.mse.push_back(squares / p);
  }
  for (std::size_t k = 0; k < pixels; ++k) {
    const double m = powers[0][k] / r, s2 = powers[1][k] / r, s3 = powers[2][k] / r, s4 = powers[3][k] / r;
    const double m2 = s2 - m * m;
    run.sum_m2_squared += m2 * m2;
    run.sum_m4 += s4 - m * (4 * s3 - m * (6 * s2 - 3 * m * m));
  }
  return run;
}

/// The intervals of all runs: [interval][run].
struct Outcomes {
  std::vector<std::vector<std::optional<Interval>>> intervals;
  std::vector<char> marked;
};

CoverageRow count_row(const std::vector<std::optional<Interval>>& intervals, double truth, double scale) {
  CoverageRow row;
  double width = 0;
  std::int64_t found = 0;
  for (const std::optional<Interval>& interval : intervals) {
    if (!interval) continue;
    ++found;
    width += scale * (interval->hi - interval->lo);
    row.covered += interval->lo <= truth && truth <= interval->hi;
  }
  row.width = found > 0 ? width / static_cast<double>(found) : 0;
  return row;
}

}  // namespace

double ErrorImages::mse() const {
  double squares = 0;
  for (const double scale : scales) squares += scale * scale;
  return law.variance * squares / static_cast<double>(scales.size());
}

std::vector<CoverageRow> measure_intervals(const ErrorImages& images, std::int64_t replicates,
                                           std::span<const IntervalMethod> methods, const CoverageRequest& request,
                                           double share) {
  const auto runs = static_cast<std::size_t>(request.runs);
  Outcomes outcomes = {std::vector(methods.size() + 1, std::vector<std::optional<Interval>>(runs)),
                       std::vector<char>(runs)};
  const auto body = [&](std::int64_t index) {
    const auto run = static_cast<std::size_t>(index);
    const SimulatedRun simulated =
        simulate(images, replicates, RunRandom(request.seed, run, static_cast<std::uint32_t>(replicates)));
    for (std::size_t m = 0; m < methods.size(); ++m)
      outcomes.intervals[m][run] = log_mean_interval(methods[m], simulated.mse, run);
    Moments mean;
    mean.add(simulated.mean);
    outcomes.intervals.back()[run] = t_interval(mean);
    const auto kurtosis = corrected_kurtosis(simulated.sum_m2_squared, simulated.sum_m4, replicates);
    outcomes.marked[run] = kurtosis && *kurtosis > kurtosis_limit(replicates);
  };
  if (!for_each_run(request, share, body)) return {};

  std::vector<CoverageRow> rows;
  const auto marked = static_cast<double>(std::ranges::count(outcomes.marked, 1)) / static_cast<double>(runs);
  const auto finish = [&](CoverageRow row, const char* number, std::string_view method) {
    row.number = number;
    row.method = method;
    row.law = images.name;
    row.replicates = replicates;
    row.runs = request.runs;
    row.marked = marked;
    rows.push_back(std::move(row));
  };
  for (std::size_t m = 0; m < methods.size(); ++m) {
    // Half of what it is for the MSE.
    finish(count_row(outcomes.intervals[m], std::log(images.mse()), 0.5), "rmse", to_string(methods[m]));
  }
  finish(count_row(outcomes.intervals.back(), 0, 1), "mean", "t");
  return rows;
}

}  // namespace halfslope
