#include "analysis/rates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "analysis/bootstrap.h"
#include "analysis/compensated_sum.h"
#include "analysis/status.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

/// The coefficients c_j of the least-squares slope on log N; empty if all N are one.
std::vector<double> slope_coefficients(std::span<const double> samples) {
  std::vector<double> x(samples.size());
  CompensatedSum sum, squares;
  for (std::size_t j = 0; j < x.size(); ++j) sum.add(x[j] = std::log(samples[j]));
  for (double& value : x) {
    value -= sum.value() / static_cast<double>(x.size());
    squares.add(value * value);
  }
  for (double& value : x) value /= squares.value();
  return x;
}

double mean_of(std::span<const double> values) {
  CompensatedSum sum;
  for (const double value : values) sum.add(value);
  return sum.value() / static_cast<double>(values.size());
}

double dot(std::span<const double> a, std::span<const double> b) {
  std::array<double, 4> sum{};  // four chains: one would wait for each addition to finish
  std::size_t i = 0;
  for (; i + 4 <= a.size(); i += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) sum[lane] += a[i + lane] * b[i + lane];
  }
  for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// The replicates as the bootstrap sees them: deviations (mse[j][r] − mean_r) / MSE_j, so a resample with weights w has
/// MSE*_j / MSE_j = 1 + Σ_r w_r deviations[j][r] / R.
class RateBootstrap {
 public:
  RateBootstrap(std::vector<double> coefficients, std::vector<std::vector<double>> deviations)
      : c_(std::move(coefficients)),
        deviations_(std::move(deviations)),
        influence_(replicates()),
        ratio_(c_.size(), 1.0) {}

  std::size_t replicates() const { return deviations_[0].size(); }

  /// Standard error of the rate with these weights; 0 if all influences drawn are equal. Uses the MSE ratios that
  /// slope_change left, 1 before its first call.
  double standard_error(std::span<const double> weights) {
    std::ranges::fill(influence_, 0.0);
    for (std::size_t j = 0; j < c_.size(); ++j) {
      const double factor = 0.5 * c_[j] / ratio_[j];
      for (std::size_t r = 0; r < influence_.size(); ++r) influence_[r] += factor * deviations_[j][r];
    }
    // About an influence that was drawn, so that equal ones give exact zeros.
    const auto drawn = std::ranges::find_if(weights, [](double weight) { return weight > 0; }) - weights.begin();
    const double shift = influence_[static_cast<std::size_t>(drawn)], n = static_cast<double>(replicates());
    double sum = 0, squares = 0;
    for (std::size_t r = 0; r < influence_.size(); ++r) {
      const double d = influence_[r] - shift;
      sum += weights[r] * d;
      squares += weights[r] * d * d;
    }
    return squares > 0 ? std::sqrt((squares - sum * sum / n) / (n * (n - 1))) : 0.0;
  }

  /// Rate of the weighted replicates less the rate of all; empty where an MSE*_j is not positive.
  std::optional<double> slope_change(std::span<const double> weights) {
    double change = 0;
    for (std::size_t j = 0; j < c_.size(); ++j) {
      ratio_[j] = 1 + dot(weights, deviations_[j]) / static_cast<double>(replicates());
      if (!(ratio_[j] > 0)) return std::nullopt;
      change += c_[j] * 0.5 * std::log(ratio_[j]);
    }
    return change;
  }

 private:
  std::vector<double> c_;
  std::vector<std::vector<double>> deviations_;
  std::vector<double> influence_, ratio_;
};

std::optional<Interval> rate_interval(double rate, RateBootstrap bootstrap, std::uint64_t seed) {
  const std::size_t replicates = bootstrap.replicates();
  std::vector<double> weights(replicates, 1.0), studentised;
  const double se = replicates < 2 ? 0 : bootstrap.standard_error(weights);
  if (!(se > 0)) return std::nullopt;
  std::vector<std::uint32_t> indices(replicates);
  studentised.reserve(kBootstrapResamples);
  for (std::uint32_t resample = 0; resample < kBootstrapResamples; ++resample) {
    draw_resample(seed, resample, static_cast<std::uint32_t>(replicates), indices);
    std::ranges::fill(weights, 0.0);
    for (const std::uint32_t index : indices) weights[index] += 1;
    const std::optional<double> change = bootstrap.slope_change(weights);
    const double resample_se = change ? bootstrap.standard_error(weights) : 0;
    if (resample_se > 0) studentised.push_back(*change / resample_se);
  }
  return bootstrap_t_interval(rate, se, 1 + 1.5 / static_cast<double>(replicates), studentised, 0.95);
}

}  // namespace

RateFit fit_rate(std::span<const double> samples, std::span<const std::vector<double>> mse,
                 std::span<const double> reference_mse, std::uint64_t seed, double rounding_mse) {
  assert_equal(mse.size(), samples.size(), "sample counts that have errors");
  assert_equal(reference_mse.size(), samples.size(), "sample counts that have a reference variance");
  RateFit fit;
  const auto [least, largest] = std::ranges::minmax_element(samples);
  if (samples.empty() || *least == *largest) {
    fit.status = "too-few-points";
    return fit;
  }
  fit.samples_lo = *least;
  fit.samples_hi = *largest;

  std::vector<double> measured(samples.size());
  bool invalid = false, exact = false, reference_limited = false, rounding_limited = false, no_spread = true;
  for (std::size_t j = 0; j < samples.size(); ++j) {
    assert_equal(mse[j].size(), mse[0].size(), "replicates at each sample count");
    measured[j] = mean_of(mse[j]);
    invalid |= !std::isfinite(measured[j]);
    exact |= measured[j] == 0;
    no_spread = no_spread && std::ranges::adjacent_find(mse[j], std::not_equal_to<>()) == mse[j].end();
    reference_limited |= reference_mse[j] > kReferenceShare * measured[j];
    rounding_limited |= measured[j] > 0 && measured[j] < 100 * rounding_mse;
  }
  assert_equal(mse[0].empty(), false, "no replicates");
  Status status;
  status.mark_if(invalid, "invalid");
  status.mark_if(exact, "exact");
  status.mark_if(reference_limited, "reference-limited");
  status.mark_if(rounding_limited, "rounding-limited");
  const std::size_t replicates = mse[0].size();
  status.mark_if(no_spread && replicates > 1 && !invalid && !exact, "no-spread");
  const bool refused = !status.ok();
  status.mark_if(replicates == 1, "deterministic");
  status.mark_if(replicates > 1 && replicates < kCertifiedReplicates, "few-replicates");
  fit.status = status.text();
  if (refused) return fit;

  const std::vector<double> c = slope_coefficients(samples);
  CompensatedSum rate;
  std::vector<std::vector<double>> deviations(mse.begin(), mse.end());
  for (std::size_t j = 0; j < samples.size(); ++j) {
    const double corrected = measured[j] - reference_mse[j];
    rate.add(c[j] * 0.5 * std::log(corrected));
    for (double& value : deviations[j]) value = (value - measured[j]) / corrected;
  }
  fit.rate = rate.value();
  fit.interval = rate_interval(*fit.rate, RateBootstrap(c, std::move(deviations)), seed);
  return fit;
}

}  // namespace halfslope
