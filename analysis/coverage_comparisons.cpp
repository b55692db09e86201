#include "analysis/coverage_comparisons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/comparison.h"

namespace halfslope {
namespace {

constexpr std::int64_t kPilotReplicates = 256;
constexpr double kPredictionError = 0.04;
constexpr std::uint32_t kMainExperiment = 1, kPilot = 2;  // purposes of random numbers

/// Nearly of one size. Errors of one size alone have no spread, and are not compared.
ErrorLaw four_point_errors() {
  return {"four-point",
          1,
          [](RunRandom& random) {
            const double size = std::sqrt(random.uniform() < 0.5 ? 0.5 : 1.5);
            return random.uniform() < 0.5 ? -size : size;
          },
          {}};
}

/// Squared errors, [cell][replicate].
using Table = std::vector<std::vector<double>>;

Table simulate(const ComparedFamily& family, std::int64_t replicates, RunRandom random) {
  Table table(family.laws.size(), std::vector<double>(static_cast<std::size_t>(replicates)));
  const double own = std::sqrt(1 - family.shared * family.shared);
  std::vector<double> factors;
  for (const ErrorLaw& law : family.laws) factors.push_back(own / std::sqrt(law.variance));
  for (std::size_t r = 0; r < table[0].size(); ++r) {
    for (int pixel = 0; pixel < family.pixels; ++pixel) {
      const double common = family.shared > 0 ? family.shared * random.normal() : 0;
      for (std::size_t k = 0; k < table.size(); ++k) {
        const double error = common + factors[k] * family.laws[k].draw(random);
        table[k][r] += error * error / family.pixels;
      }
    }
  }
  return table;
}

std::vector<Comparison> compare_with_first(const Table& table, std::uint64_t seed) {
  std::vector<ComparedErrors> cells;
  for (const auto& errors : table) cells.push_back({errors});
  return compare(cells, pairs_with(0, cells.size()), seed);
}

bool told(const Comparison& comparison) {
  return comparison.verdict == Verdict::kABetter || comparison.verdict == Verdict::kBBetter;
}

CoverageRow row_of(const ComparedFamily& family, std::int64_t replicates) {
  CoverageRow row;
  row.law = family.pixels == 1 ? family.name : fmt::format("{}, images of {} pixels", family.name, family.pixels);
  row.replicates = replicates;
  return row;
}

template <class Value>
Value sum_of(const std::vector<Value>& values) {
  Value sum = 0;
  for (const Value value : values) sum += value;
  return sum;
}

/// One law against the others by turns, eleven cells.
std::vector<ErrorLaw> eleven(const ErrorLaw& first, const std::vector<ErrorLaw>& others) {
  std::vector<ErrorLaw> laws = {first};
  for (std::size_t k = 0; k < 10; ++k) laws.push_back(others[k % others.size()]);
  return laws;
}

}  // namespace

std::vector<CoverageRow> measure_alarms(const ComparedFamily& family, std::int64_t replicates,
                                        const CoverageRequest& request, double share) {
  const auto runs = static_cast<std::size_t>(request.runs);
  std::vector<std::int64_t> covered(runs), quiet(runs);
  std::vector<double> widths(runs);
  const bool finished = for_each_run(request, share, [&](std::int64_t index) {
    const auto run = static_cast<std::size_t>(index);
    const Table table = simulate(family, replicates, RunRandom(request.seed, run, kMainExperiment));
    const auto comparisons = compare_with_first(table, run);
    for (const Comparison& comparison : comparisons) {
      if (!comparison.interval) continue;
      covered[run] += comparison.interval->lo <= 0 && 0 <= comparison.interval->hi;
      widths[run] += comparison.interval->hi - comparison.interval->lo;
    }
    quiet[run] = std::ranges::none_of(comparisons, told);
  });
  if (!finished) return {};
  CoverageRow ratios = row_of(family, replicates), alarms = ratios;
  ratios.number = "ratio";
  ratios.method = "bootstrap-t";
  ratios.runs = request.runs * (std::ssize(family.laws) - 1);
  ratios.covered = sum_of(covered);
  ratios.width = sum_of(widths) / static_cast<double>(ratios.runs);
  alarms.number = fmt::format("{} ratios", family.laws.size() - 1);
  alarms.method = "Romano-Wolf";
  alarms.runs = request.runs;
  alarms.covered = sum_of(quiet);
  alarms.coverage_least = 0.925;
  return {ratios, alarms};
}

std::vector<CoverageRow> measure_power(const ComparedFamily& family, std::int64_t replicates,
                                       const CoverageRequest& request, double share) {
  const auto runs = static_cast<std::size_t>(request.runs);
  std::vector<std::int64_t> found(runs);
  std::vector<double> predicted(runs);
  const auto comparison_of = [&](std::size_t run, std::int64_t count, std::uint32_t purpose) {
    Table table = simulate(family, count, RunRandom(request.seed, run, purpose));
    for (double& error : table.back()) error *= kDifferenceToTell;
    return compare_with_first(table, run).back();
  };
  const bool finished = for_each_run(request, share, [&](std::int64_t index) {
    const auto run = static_cast<std::size_t>(index);
    predicted[run] =
        predicted_power(comparison_of(run, kPilotReplicates, kPilot), static_cast<double>(replicates)).value;
    found[run] = comparison_of(run, replicates, kMainExperiment).verdict == Verdict::kABetter;
  });
  if (!finished) return {};
  const double mean = sum_of(predicted) / static_cast<double>(runs);
  CoverageRow row = row_of(family, replicates);
  row.law += fmt::format(", 10 % apart: {:.1f} % predicted", 100 * mean);
  row.number = family.laws.size() == 2 ? "told apart" : fmt::format("told, 1 of {}", family.laws.size() - 1);
  row.method = "Romano-Wolf";
  row.runs = request.runs;
  row.covered = sum_of(found);
  row.coverage_least = mean - kPredictionError;
  row.coverage_most = mean + kPredictionError;
  return {row};
}

std::vector<CoverageRow> comparison_coverage(const CoverageRequest& request) {
  const ErrorLaw gaussian = gaussian_errors(), uniform = uniform_errors(), laplace = laplace_errors(),
                 four_point = four_point_errors();
  const std::vector<ErrorLaw> like = eleven(gaussian, {gaussian}),
                              unlike = eleven(gaussian, {uniform, laplace, four_point});
  struct Part {
    ComparedFamily family;
    std::int64_t replicates;
    std::vector<CoverageRow> (*measure)(const ComparedFamily&, std::int64_t, const CoverageRequest&, double);
    double cost;
  };
  const Part parts[] = {
      {{"Gaussian", like}, 64, measure_alarms, 1},
      {{"uniform, Laplace, four-point against Gaussian", unlike}, 64, measure_alarms, 1},
      {{"Laplace against four-point", eleven(four_point, {laplace})}, 64, measure_alarms, 1},
      {{"four-point against Laplace", eleven(laplace, {four_point})}, 64, measure_alarms, 1},
      {{"unlike, on common samples", unlike, 0.9}, 64, measure_alarms, 1},
      {{"Gaussian", like, 0, 256}, 16, measure_alarms, 1},
      {{"unlike", unlike, 0, 256}, 16, measure_alarms, 1},
      {{"unlike, on common samples", unlike, 0.9, 256}, 16, measure_alarms, 1},
      {{"Gaussian on common samples", {gaussian, gaussian}, 0.97}, 256, measure_power, 0.5},
      {{"Laplace on common samples", {laplace, laplace}, 0.97}, 512, measure_power, 0.8},
      {{"Laplace", {laplace, laplace}}, 1024, measure_power, 1.2},
      {{"unlike", unlike, 0, 64}, 64, measure_power, 5},
  };
  double total = 0;
  for (const Part& part : parts) total += part.cost;
  std::vector<CoverageRow> rows;
  for (const Part& part : parts) {
    const auto measured = part.measure(part.family, part.replicates, request, part.cost / total);
    if (measured.empty()) break;
    rows.insert(rows.end(), measured.begin(), measured.end());
  }
  return rows;
}

}  // namespace halfslope
