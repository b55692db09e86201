#include "analysis/rates.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <functional>

#include "analysis/compensated_sum.h"
#include "analysis/rate_floor.h"
#include "analysis/rate_line.h"
#include "analysis/status.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

/// V̄ is at most this share of V̄ + MSE.
constexpr double kMostReference = 0.3;
/// A window whose errors fall no faster, after errors that fell, is a floor.
constexpr double kFlat = -0.1;
/// Errors this many times a floor's mean squared error are above it.
constexpr double kAboveFloor = 10;

double mean_of(std::span<const double> values) {
  CompensatedSum sum;
  for (const double value : values) sum.add(value);
  return sum.value() / static_cast<double>(values.size());
}

/// What δ² of the reference stays below in 999 of 1000 cases.
double largest_reference_error(const ReferenceNoise& reference) {
  if (!(reference.mse_variance > 0)) return reference.mse;
  const double shape = reference.mse * reference.mse / reference.mse_variance;
  return reference.mse_variance / reference.mse * boost::math::gamma_p_inv(shape, 0.999);
}

/// What a line's N are worth.
struct Marks {
  bool invalid = false, exact = false, reference_limited = false, rounding_limited = false, no_spread = false,
       heavy_tailed = false;

  bool usable() const { return !(invalid || exact || reference_limited || rounding_limited || no_spread); }
  void add(const Marks& other) {
    invalid |= other.invalid;
    exact |= other.exact;
    reference_limited |= other.reference_limited;
    rounding_limited |= other.rounding_limited;
    no_spread |= other.no_spread;
    heavy_tailed |= other.heavy_tailed;
  }
  Status status() const {
    Status status;
    status.mark_if(invalid, "invalid");
    status.mark_if(exact, "exact");
    status.mark_if(reference_limited, "reference-limited");
    status.mark_if(rounding_limited, "rounding-limited");
    status.mark_if(no_spread, "no-spread");
    return status;
  }
};

/// The marks of each N, and which can be used.
struct Usable {
  std::vector<Marks> marks;
  std::vector<std::size_t> counts;  ///< indices of the N
  Marks any;                        ///< of all together
};

Marks marks_of(const RateData& data, std::size_t j, double largest_reference_error) {
  const std::vector<double>& errors = data.mse[j];
  const double measured = mean_of(errors), reference = data.reference.mse;
  const double least =
      data.variance.empty() ? measured - reference : std::max(data.variance[j], measured - largest_reference_error);
  Marks marks;
  marks.invalid = !std::isfinite(measured);
  marks.exact = measured == 0;
  marks.reference_limited = !marks.invalid && reference > 0 &&
                            (measured <= reference || !(reference * (1 - kMostReference) <= kMostReference * least));
  marks.rounding_limited = measured > 0 && measured < kRoundingReach * data.rounding_mse;
  marks.no_spread = !marks.invalid && !marks.exact && errors.size() > 1 &&
                    std::ranges::adjacent_find(errors, std::not_equal_to<>()) == errors.end();
  marks.heavy_tailed = !data.heavy_tailed.empty() && data.heavy_tailed[j] != 0;
  return marks;
}

Usable find_usable(const RateData& data) {
  Usable usable;
  const double largest_error = largest_reference_error(data.reference);
  for (std::size_t j = 0; j < data.samples.size(); ++j) {
    assert_equal(data.mse[j].size(), data.mse[0].size(), "replicates at each sample count");
    Marks& marks = usable.marks.emplace_back(marks_of(data, j, largest_error));
    if (marks.usable()) usable.counts.push_back(j);
    marks.heavy_tailed = marks.heavy_tailed && marks.usable();
    usable.any.add(marks);
  }
  return usable;
}

/// Marks of how many replicates there are, and of tails.
void mark_trust(Status& status, std::size_t replicates, bool heavy_tailed) {
  status.mark_if(replicates == 1, "deterministic");
  status.mark_if(replicates > 1 && replicates < kCertifiedReplicates, "few-replicates");
  status.mark_if(heavy_tailed, "heavy-tailed");
}

RateFit linear_fit(const LineBootstrap& line, std::span<const double> samples, std::span<const double> weights,
                   std::string status) {
  const std::vector<double> c = slope_coefficients(samples, weights);
  RateFit fit{line.value(c), line.interval(c), 0, 0, std::move(status)};
  for (std::size_t j = 0; j < samples.size(); ++j) {
    if (weights[j] == 0) continue;
    if (fit.samples_lo == 0) fit.samples_lo = samples[j];
    fit.samples_hi = samples[j];
  }
  return fit;
}

/// What is found beyond the plain line.
struct Search {
  bool bent = false;
  std::optional<RateFit> window;
};

Search search_window(const LineBootstrap& line, std::span<const double> samples) {
  std::vector<double> weights = line.variances();
  for (double& weight : weights) weight = 1 / weight;
  const std::size_t counts = line.counts();
  Search search;
  if (counts < kFewestInWindow) return search;
  search.bent = is_bent(line, samples, weights, 0, counts);
  if (!search.bent) {
    search.window = linear_fit(line, samples, weights, "asymptotic");
    return search;
  }
  if (const std::optional<Floor> floor = find_floor(line, samples, weights)) {
    const FloorFit& fit = floor->fit;
    RateFit row{fit.rate,     line.interval(fit.coefficients), samples[floor->first], samples[floor->last - 1], "floor",
                fit.floor_mse};
    const double shift = fit.rate - line.value(fit.coefficients);  // the model is not linear, its change nearly is
    if (row.interval) row.interval = Interval{row.interval->lo + shift, row.interval->hi + shift};
    search.window = row;
    return search;
  }
  std::optional<std::size_t> first = straight_from(line, samples, weights, counts);
  if (!first) return search;
  RateFit tail = linear_fit(line, samples, weights_within(weights, *first, counts), "asymptotic");
  if (!(tail.rate > kFlat) || !(line.log_rmse()[0] > line.log_rmse()[*first])) {
    if (2 * (counts - *first) >= counts) search.window = tail;
    return search;
  }
  // Flat, after errors that fell: what is above it may still follow a line.
  double sum = 0, total = 0;
  for (std::size_t j = *first; j < counts; ++j) {
    sum += weights[j] * line.log_rmse()[j];
    total += weights[j];
  }
  const double floor_mse = std::exp(2 * sum / total);
  std::size_t last = 0;
  while (last < *first && std::exp(2 * line.log_rmse()[last]) > kAboveFloor * floor_mse) ++last;
  first = straight_from(line, samples, weights, last);
  search.window = first ? linear_fit(line, samples, weights_within(weights, *first, last), "floor")
                        : RateFit{{}, {}, tail.samples_lo, tail.samples_hi, "floor"};
  search.window->floor_mse = floor_mse;
  return search;
}

std::vector<LocalRate> local_rates(const RateData& data, const std::optional<LineBootstrap>& line,
                                   const Usable& usable) {
  std::vector<LocalRate> rates;
  const std::vector<std::size_t>& used = usable.counts;
  for (std::size_t j = 0; j + 1 < data.samples.size(); ++j) {
    Marks marks = usable.marks[j];
    marks.add(usable.marks[j + 1]);
    Status status = marks.status();
    mark_trust(status, data.mse[j].size(), marks.heavy_tailed);
    LocalRate rate{data.samples[j], data.samples[j + 1], {}, {}, status.text()};
    if (line && marks.usable()) {
      std::vector<double> c(used.size());
      const auto i = static_cast<std::size_t>(std::ranges::find(used, j) - used.begin());
      c[i + 1] = 1 / std::log(data.samples[j + 1] / data.samples[j]);
      c[i] = -c[i + 1];
      rate.rate = line->value(c);
      rate.interval = line->interval(c);
    }
    rates.push_back(rate);
  }
  return rates;
}

/// A line with those of its N that can be used.
struct UsedLine {
  Usable usable;
  std::vector<double> samples;
  std::vector<std::vector<double>> mse;
  std::optional<LineBootstrap> bootstrap;  ///< empty below two N
};

UsedLine used_line(const RateData& data, std::uint64_t seed) {
  UsedLine line{find_usable(data), {}, {}, {}};
  for (const std::size_t j : line.usable.counts) {
    line.samples.push_back(data.samples[j]);
    line.mse.push_back(data.mse[j]);
  }
  if (line.mse.size() >= 2) line.bootstrap.emplace(line.mse, data.reference, seed);
  return line;
}

/// The search over as many N as have their covariances kept: of more, those nearest to equal steps of log N.
Search search_line(const RateData& data, const UsedLine& line, std::uint64_t seed) {
  if (line.samples.size() <= LineBootstrap::kMostPaired) return search_window(*line.bootstrap, line.samples);
  const double first = std::log(line.samples.front()), last = std::log(line.samples.back());
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < LineBootstrap::kMostPaired; ++i) {
    const double at = first + (last - first) * static_cast<double>(i) / (LineBootstrap::kMostPaired - 1);
    const auto nearest =
        std::ranges::min_element(line.samples, {}, [&](double n) { return std::abs(std::log(n) - at); });
    const auto index = static_cast<std::size_t>(nearest - line.samples.begin());
    if (chosen.empty() || chosen.back() != index) chosen.push_back(index);
  }
  std::vector<double> samples;
  std::vector<std::vector<double>> mse;
  for (const std::size_t j : chosen) samples.push_back(line.samples[j]), mse.push_back(line.mse[j]);
  return search_window(LineBootstrap(mse, data.reference, seed), samples);
}

RateFit plain_fit(const RateData& data, const UsedLine& line, const Search& search) {
  Status status = line.usable.any.status();
  status.mark_if(search.window && search.window->floor_mse, "floor");
  const bool refused = !status.ok();
  mark_trust(status, data.mse[0].size(), line.usable.any.heavy_tailed);
  status.mark_if(!refused && search.bent, "pre-asymptotic");
  if (!refused) {
    return linear_fit(*line.bootstrap, line.samples, std::vector<double>(line.samples.size(), 1.0), status.text());
  }
  return {{}, {}, data.samples.front(), data.samples.back(), status.text()};
}

/// Whether there are two different N, with errors of the shapes that RateData promises.
bool has_line(const RateData& data) {
  assert_equal(data.mse.size(), data.samples.size(), "sample counts that have errors");
  assert_equal(data.variance.empty() || data.variance.size() == data.samples.size(), true,
               "sample counts that have a variance");
  if (data.samples.empty() || data.samples.front() == data.samples.back()) return false;
  assert_equal(std::ranges::is_sorted(data.samples, std::less_equal<>()), true, "sample counts that rise");
  assert_equal(data.mse[0].empty(), false, "no replicates");
  return true;
}

constexpr const char* kTooFew = "too-few-points";

}  // namespace

bool is_certified(const RateFit& fit) { return fit.interval && is_certified(fit.status); }

LineRates analyse_rates(const RateData& data, std::uint64_t seed) {
  if (!has_line(data)) return {{{}, {}, 0, 0, kTooFew}, {}, {}};
  const UsedLine line = used_line(data, seed);
  const bool certified = line.bootstrap && data.mse[0].size() >= kCertifiedReplicates;
  Search search = certified ? search_line(data, line, seed) : Search();
  if (search.window && line.usable.any.heavy_tailed) search.window->status += ";heavy-tailed";
  return {plain_fit(data, line, search), search.window, local_rates(data, line.bootstrap, line.usable)};
}

RateFit fit_rate(const RateData& data, std::uint64_t seed) {
  if (!has_line(data)) return {{}, {}, 0, 0, kTooFew};
  return plain_fit(data, used_line(data, seed), {});
}

}  // namespace halfslope
