#include "analysis/coverage_intervals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/tails.h"

namespace halfslope {
namespace {

constexpr std::string_view kImageLaw = "256 pixels, means of 64 lognormal(1.5)";
constexpr std::string_view kUnequalLaw = "256 unequal pixels, means of 64 lognormal(1.5)";

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
    if (std::isfinite(interval->hi)) ++found, width += scale * (interval->hi - interval->lo);
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
    const auto intervals = log_mean_intervals(methods, simulated.mse, run);
    for (std::size_t m = 0; m < methods.size(); ++m) outcomes.intervals[m][run] = intervals[m];
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

namespace {

struct Promise {
  std::string_view number, method, law;
  std::int64_t replicates;  ///< 0: any
  double least, most;
};

// docs/errors.md states these. Images of lognormal means are where the heavy tails that a renderer meets begin.
constexpr Promise kPromises[] = {
    {"rmse", "bootstrap-t", "Gaussian", 0, 0.935, 0.965}, {"rmse", "reciprocal-t", "Gaussian", 0, 0.935, 0.965},
    {"mean", "t", "Gaussian", 0, 0.935, 0.965},           {"rmse", "bootstrap-t", "uniform", 0, 0.935, 0.99},
    {"rmse", "reciprocal-t", "uniform", 0, 0.935, 0.99},  {"rmse", "bootstrap-t", kImageLaw, 0, 0.905, 1},
    {"rmse", "reciprocal-t", kImageLaw, 0, 0.905, 1},     {"rmse", "bootstrap-t", kUnequalLaw, 0, 0.8, 1},
    {"rmse", "reciprocal-t", kUnequalLaw, 0, 0.8, 1},
};

void promise(CoverageRow& row) {
  for (const Promise& p : kPromises) {
    if (row.number != p.number || row.method != p.method || row.law != p.law) continue;
    if (p.replicates != 0 && p.replicates != row.replicates) continue;
    row.coverage_least = p.least;
    row.coverage_most = p.most;
  }
  // Of the heavy-tail mark.
  if (row.replicates == 64 && row.law == "lognormal(1.5)") row.marked_least = 0.95;
  if (row.replicates == 64 && row.law == "Pareto(2.5)") row.marked_least = 0.9;
  if (row.replicates == 64 && row.law == "Gaussian") row.marked_most = 0.02;
  if (row.replicates == 1024 && row.law == "Laplace") row.marked_most = 0;
}

}  // namespace

std::vector<CoverageRow> interval_coverage(const CoverageRequest& request) {
  constexpr int kPixels = 256, kSamples = 64;
  const ErrorLaw lognormal = lognormal_errors(1.5), pareto = pareto_errors(2.5);
  const std::vector<double> equal(kPixels, 1.0);
  const ErrorImages gaussian = {std::string("Gaussian"), gaussian_errors()}, uniform = {"uniform", uniform_errors()},
                    laplace = {"Laplace", laplace_errors()}, one_lognormal = {lognormal.name, lognormal},
                    one_pareto = {pareto.name, pareto},
                    image = {std::string(kImageLaw), mean_errors(lognormal, kSamples), equal},
                    unequal = {std::string(kUnequalLaw), image.law, lognormal_scales(kPixels, 1)},
                    pareto_image = {fmt::format("{} pixels, {}", kPixels, mean_errors(pareto, kSamples).name),
                                    mean_errors(pareto, kSamples), equal};
  std::vector<IntervalMethod> all, quick;
  for (const IntervalMethodInfo& info : interval_methods()) {
    all.push_back(info.method);
    const bool resamples = info.method != IntervalMethod::kChi2 && info.method != IntervalMethod::kDelta;
    if (!resamples) quick.push_back(info.method);
  }
  struct Part {
    const ErrorImages& images;
    std::int64_t replicates;
    std::span<const IntervalMethod> methods;
    std::int64_t runs;
    double cost;  ///< in random numbers, roughly
  };
  // What is promised for so many runs takes them all; what would take longest and is shown for comparison, a fifth.
  const std::int64_t fifth = std::max<std::int64_t>(1, request.runs / 5);
  std::vector<Part> parts;
  const auto add = [&](const ErrorImages& images, std::int64_t replicates, std::span<const IntervalMethod> methods,
                       std::int64_t runs, int samples) {
    const double resamples = methods.size() == all.size() ? 1.0 * kBootstrapResamples : 0;
    const auto errors = static_cast<double>(images.scales.size()) * samples;
    parts.push_back(
        {images, replicates, methods, runs, static_cast<double>(runs * replicates) * (resamples + 4 * errors)});
  };
  for (const ErrorImages* images : {&gaussian, &uniform, &laplace, &one_lognormal, &one_pareto}) {
    const std::int64_t runs = images == &gaussian ? request.runs : fifth;
    for (const std::int64_t replicates : {16, 64, 256}) add(*images, replicates, all, runs, 1);
    add(*images, 1024, quick, fifth, 1);
  }
  add(image, 16, all, request.runs, kSamples);
  add(image, 64, all, fifth, kSamples);
  for (const ErrorImages* images : {&unequal, &pareto_image}) {
    for (const std::int64_t replicates : {16, 64}) add(*images, replicates, all, fifth, kSamples);
  }
  double total = 0;
  for (const Part& part : parts) total += part.cost;
  std::vector<CoverageRow> rows;
  for (const Part& part : parts) {
    CoverageRequest of_part = request;
    of_part.runs = part.runs;
    const auto measured = measure_intervals(part.images, part.replicates, part.methods, of_part, part.cost / total);
    if (measured.empty()) return rows;  // stopped
    rows.insert(rows.end(), measured.begin(), measured.end());
  }
  for (CoverageRow& row : rows) promise(row);
  return rows;
}

}  // namespace halfslope
