#include "analysis/comparison.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/compensated_sum.h"
#include "analysis/normal.h"
#include "analysis/status.h"

namespace halfslope {
namespace {

double mean_of(std::span<const double> values) {
  CompensatedSum sum;
  for (const double value : values) sum.add(value);
  return sum.value() / static_cast<double>(values.size());
}

/// Squared errors as the comparisons see them: (e² − M)/c, c = M − V̄.
struct Column {
  double measured, corrected;
  std::vector<double> deviations;
};

Column column_of(const ComparedErrors& cell, std::size_t rows) {
  const auto errors = cell.squared_errors.first(rows);
  Column column;
  column.measured = mean_of(errors);
  column.corrected = column.measured - cell.reference_mse;
  for (const double error : errors) column.deviations.push_back((error - column.measured) / column.corrected);
  return column;
}

/// Whether two errors differ by no more than rounding. Estimates that are off by ε each have squares, and means of
/// squares over an image, that differ by 2 ε times the root of the larger one and ε² at most.
bool equal_but_for_rounding(double a, double b, double epsilon) {
  return std::abs(a - b) <= epsilon * (2 * std::sqrt(std::max(a, b)) + epsilon);
}

bool equal_but_for_rounding(const ComparedErrors& a, const ComparedErrors& b, std::size_t rows) {
  const double epsilon = kRoundings * std::sqrt(std::min(a.rounding_mse, b.rounding_mse));
  return std::ranges::equal(a.squared_errors.first(rows), b.squared_errors.first(rows),
                            [&](double x, double y) { return equal_but_for_rounding(x, y, epsilon); });
}

/// Whether a mean of squared errors may be rounding alone.
bool is_rounding(const Column& column, const ComparedErrors& cell) {
  return column.measured < kRoundingReach * cell.rounding_mse;
}

/// Whether squared errors differ by more than rounding.
bool has_spread(const Column& column) {
  const double rounding = 1e-13 * column.measured / column.corrected;
  return std::ranges::any_of(column.deviations, [&](double x) { return std::abs(x) > rounding; });
}

bool usable(std::span<const double> errors) {
  return std::ranges::all_of(errors, [](double error) { return std::isfinite(error) && error >= 0; });
}

/// The replicates that both sides have.
std::size_t common_rows(std::span<const ComparedErrors> cells, const ColumnPair& pair) {
  return std::min(cells[pair.a].squared_errors.size(), cells[pair.b].squared_errors.size());
}

/// Fills what needs no resampling; true where the comparison goes on.
bool begin_comparison(Comparison& comparison, std::span<const ComparedErrors> cells,
                      const std::map<std::size_t, Column>& columns) {
  const auto [a, b] = comparison.pair;
  const Column &x = columns.at(a), &y = columns.at(b);
  const std::size_t rows = x.deviations.size();
  const auto errors_a = cells[a].squared_errors.first(rows), errors_b = cells[b].squared_errors.first(rows);
  Status status;
  status.mark_if(!usable(errors_a) || !usable(errors_b), "invalid");
  status.mark_if(status.ok() && (x.measured == 0 || y.measured == 0), "exact");
  status.mark_if(status.ok() && equal_but_for_rounding(cells[a], cells[b], rows), "equal");
  status.mark_if(status.ok() && (is_rounding(x, cells[a]) || is_rounding(y, cells[b])), "floor");
  const bool measured = status.ok();
  status.mark_if(measured && (cells[a].reference_mse > kReferenceShare * x.measured ||
                              cells[b].reference_mse > kReferenceShare * y.measured),
                 "reference-limited");
  const bool positive = measured && x.corrected > 0 && y.corrected > 0;
  bool spread = false;
  if (positive) {
    comparison.log_ratio = std::log(x.corrected) - std::log(y.corrected);
    std::vector<double> influences(rows);
    double largest = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      influences[r] = x.deviations[r] - y.deviations[r];
      largest = std::max({largest, std::abs(x.deviations[r]), std::abs(y.deviations[r])});
    }
    const InfluenceSpread found = influence_spread(influences);
    spread = has_spread(x) && has_spread(y) && found.deviation > 1e-13 * largest;  // less is rounding
    if (spread) comparison.spread = found;
    status.mark_if(!spread, "no-spread");
  }
  status.mark_if(rows < kCertifiedReplicates, "few-replicates");
  comparison.status = status.text();
  return spread;
}

/// A comparison that goes on, with its |T*| and its own |t|.
struct Tested {
  Comparison* comparison;
  std::vector<float> resampled;
  double statistic;
};

// Comparisons over the same rows, resampled together.
void test_group(std::span<const ComparedErrors> cells, std::size_t rows, std::span<Comparison* const> group,
                std::uint64_t seed, std::vector<Tested>& tested) {
  std::map<std::size_t, Column> columns;
  for (const Comparison* comparison : group) {
    for (const std::size_t k : {comparison->pair.a, comparison->pair.b}) {
      if (!columns.contains(k)) columns.emplace(k, column_of(cells[k], rows));
    }
  }
  std::vector<std::vector<double>> deviations;
  std::map<std::size_t, std::size_t> place;
  std::vector<ColumnPair> pairs;
  std::vector<Comparison*> compared;
  for (Comparison* comparison : group) {
    if (!begin_comparison(*comparison, cells, columns)) continue;
    for (const std::size_t k : {comparison->pair.a, comparison->pair.b}) {
      if (place.emplace(k, deviations.size()).second) deviations.push_back(columns.at(k).deviations);
    }
    pairs.push_back({place.at(comparison->pair.a), place.at(comparison->pair.b)});
    compared.push_back(comparison);
  }
  if (compared.empty()) return;
  auto resampled = ComparisonBootstrap(deviations, pairs).studentised(seed + rows, kComparisonResamples);
  const auto n = static_cast<double>(rows);
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const double se = compared[i]->spread->deviation / std::sqrt(n);
    tested.push_back({compared[i], std::move(resampled[i]), std::abs(*compared[i]->log_ratio) / se});
  }
}

double p_value(std::int64_t as_large) {
  return static_cast<double>(1 + as_large) / static_cast<double>(kComparisonResamples + 1);
}

void single_results(Tested& tested) {
  Comparison& comparison = *tested.comparison;
  comparison.p = p_value(std::ranges::count_if(tested.resampled, [&](float t) { return t >= tested.statistic; }));
  std::vector<float> sorted = tested.resampled;
  const auto rank = std::lround((kComparisonResamples + 1) * (1 - kFamilyLevel));  // from 1
  const auto at = sorted.begin() + (rank - 1);
  std::nth_element(sorted.begin(), at, sorted.end());
  if (!std::isfinite(*at)) return;
  const auto n = static_cast<double>(comparison.replicates);
  const double half_width = comparison.spread->deviation / std::sqrt(n) * *at;
  if (half_width > std::log(kFarthestEnd)) return;
  comparison.interval = Interval{*comparison.log_ratio - half_width, *comparison.log_ratio + half_width};
}

/// The largest |T*| over the family of each resample, in the end; on the way, from the least significant comparison
/// up, over those so far.
std::vector<float> stepdown(std::vector<Tested>& tested) {
  std::ranges::stable_sort(tested, {}, &Tested::statistic);
  std::vector<float> largest(kComparisonResamples, 0.0F);
  for (const Tested& one : tested) {
    std::int64_t as_large = 0;
    for (std::size_t i = 0; i < largest.size(); ++i) {
      largest[i] = std::max(largest[i], one.resampled[i]);
      as_large += largest[i] >= one.statistic;
    }
    one.comparison->p_adjusted = p_value(as_large);
  }
  double least = 0;
  for (auto one = tested.rbegin(); one != tested.rend(); ++one) {
    Comparison& comparison = *one->comparison;
    comparison.p_adjusted = least = std::max(least, *comparison.p_adjusted);
    if (least > kFamilyLevel) {
      comparison.verdict = Verdict::kUndecided;
    } else {
      comparison.verdict = *comparison.log_ratio < 0 ? Verdict::kABetter : Verdict::kBBetter;
    }
  }
  return largest;
}

/// What a comparison must exceed to be told first: with these replicates, and with many, the normal number that is as
/// improbable.
struct CriticalValues {
  double now, normal;
};

CriticalValues critical_values(const std::vector<Tested>& tested, std::vector<float> largest) {
  const auto at = largest.begin() + (std::lround((kComparisonResamples + 1) * (1 - kFamilyLevel)) - 1);
  std::nth_element(largest.begin(), at, largest.end());
  double share = 0;
  for (const Tested& one : tested)
    share += p_value(std::ranges::count_if(one.resampled, [&](float t) { return t >= *at; }));
  return {*at, normal_quantile(1 - share / static_cast<double>(tested.size()) / 2)};
}

void predict(Comparison& comparison, const CriticalValues& critical) {
  const double difference = std::log(kDifferenceToTell);
  comparison.power =
      predicted_power(*comparison.spread, difference, critical.now, static_cast<double>(comparison.replicates));
  comparison.critical = critical.normal;
  comparison.replicates_needed = predicted_replicates(*comparison.spread, difference, critical.normal, kPowerToTell);
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kUndecided:
      return "undecided";
    case Verdict::kABetter:
      return "a-better";
    case Verdict::kBBetter:
      return "b-better";
    case Verdict::kNone:
      break;
  }
  return "";
}

std::vector<Comparison> compare(std::span<const ComparedErrors> cells, std::span<const ColumnPair> pairs,
                                std::uint64_t seed) {
  std::vector<Comparison> comparisons(pairs.size());
  std::map<std::size_t, std::vector<Comparison*>> groups;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    comparisons[i].pair = pairs[i];
    const std::size_t rows = common_rows(cells, pairs[i]);
    comparisons[i].replicates = static_cast<std::int64_t>(rows);
    if (rows < 2) {
      comparisons[i].status = rows == 0 ? "many-replicates" : "deterministic";
    } else {
      groups[rows].push_back(&comparisons[i]);
    }
  }
  std::vector<Tested> tested;
  for (const auto& [rows, group] : groups) test_group(cells, rows, group, seed, tested);
  if (tested.empty()) return comparisons;
  for (Tested& one : tested) single_results(one);
  const CriticalValues critical = critical_values(tested, stepdown(tested));
  for (const Tested& one : tested) predict(*one.comparison, critical);
  return comparisons;
}

Prediction predicted_power(const Comparison& pilot, double replicates) {
  return predicted_power(*pilot.spread, std::log(kDifferenceToTell), pilot.critical, replicates);
}

std::vector<ColumnPair> all_pairs(std::size_t count) {
  std::vector<ColumnPair> pairs;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) pairs.push_back({a, b});
  }
  return pairs;
}

std::vector<ColumnPair> pairs_with(std::size_t baseline, std::size_t count) {
  std::vector<ColumnPair> pairs;
  for (std::size_t b = 0; b < count; ++b) {
    if (b != baseline) pairs.push_back({baseline, b});
  }
  return pairs;
}

}  // namespace halfslope
