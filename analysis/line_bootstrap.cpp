#include "analysis/line_bootstrap.h"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

#include "analysis/bootstrap.h"
#include "analysis/compensated_sum.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Variances are differences of squares: below this share of the squares they are rounding.
constexpr double kRounding = 1e-13;
/// As many replicates as the common relative variance counts for beside an N's own. The variance of a relative variance
/// is near (κ − 1)/R, κ = 15 the kurtosis of squared normal errors.
constexpr double kCommonReplicates = 1024;

double mean_of(std::span<const double> values) {
  CompensatedSum sum;
  for (const double value : values) sum.add(value);
  return sum.value() / static_cast<double>(values.size());
}

/// Four dot products with one vector at once: each number of it is read once, and no sum waits for another.
std::array<double, 4> dot_four(std::span<const double> weights, const std::array<const double*, 4>& columns) {
  double sums[4][2] = {};  // [column][even or odd]
  std::size_t r = 0;
  for (; r + 2 <= weights.size(); r += 2) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t lane = 0; lane < 2; ++lane) sums[k][lane] += weights[r + lane] * columns[k][r + lane];
    }
  }
  std::array<double, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) {
    result[k] = sums[k][0] + sums[k][1];
    if (r < weights.size()) result[k] += weights[r] * columns[k][r];
  }
  return result;
}

/// δ*² − V̄ at the quantiles (b + ½)/B: resamples are independent of their numbers, so no random numbers are needed.
std::vector<double> reference_draws(const ReferenceNoise& reference) {
  std::vector<double> draws;
  if (!(reference.mse_variance > 0)) return draws;
  const double shape = reference.mse * reference.mse / reference.mse_variance,
               scale = reference.mse_variance / reference.mse;
  for (int b = 0; b < kBootstrapResamples; ++b) {
    draws.push_back(scale * boost::math::gamma_p_inv(shape, (b + 0.5) / kBootstrapResamples) - reference.mse);
  }
  return draws;
}

}  // namespace

LineBootstrap::LineBootstrap(std::span<const std::vector<double>> mse, const ReferenceNoise& reference,
                             std::uint64_t seed)
    : replicates_(mse.front().size()), reference_sd_(std::sqrt(reference.mse_variance)) {
  const std::size_t counts = mse.size(), pairs = counts * (counts + 1) / 2, n = replicates_;
  std::vector<double> deviations(counts * n);
  for (std::size_t j = 0; j < counts; ++j) {
    assert_equal(mse[j].size(), n, "replicates at each sample count");
    const double mean = mean_of(mse[j]), corrected = mean - reference.mse;
    assert_equal(corrected > 0, true, "a mean squared error above the reference's");
    corrected_.push_back(corrected);
    log_rmse_.push_back(0.5 * std::log(corrected));
    for (std::size_t r = 0; r < n; ++r) deviations[j * n + r] = (mse[j][r] - mean) / corrected;
  }
  // Columns whose means over a resample are wanted: the deviations and, of not too many N, their products.
  const bool paired = counts <= kMostPaired;
  const std::size_t wanted = counts + (paired ? pairs : 0);
  std::vector<double> columns = deviations, product(n);
  columns.resize((wanted + 3) * n);  // three of zeros, for the last four at once
  covariance_.resize(counts * counts);
  for (std::size_t j = 0, column = counts; j < counts; ++j) {
    for (std::size_t k = j; k < counts; ++k, ++column) {
      for (std::size_t r = 0; r < n; ++r) product[r] = deviations[j * n + r] * deviations[k * n + r];
      if (paired) std::ranges::copy(product, &columns[column * n]);
      covariance_[j * counts + k] = covariance_[k * counts + j] = mean_of(product);
    }
  }
  if (n < 2) return;

  reference_draws_ = reference_draws(reference);
  log_ratio_.resize(kBootstrapResamples * counts);
  if (paired) {
    resample_.resize(kBootstrapResamples * pairs);
  } else {
    deviations_ = deviations;
    weights_.resize(kBootstrapResamples * n);
  }
  std::vector<std::uint32_t> indices(n);
  std::vector<double> weights(n), means(wanted + 3), ratio(counts);
  for (std::uint32_t b = 0; b < kBootstrapResamples; ++b) {
    draw_resample(seed, b, static_cast<std::uint32_t>(n), indices);
    std::ranges::fill(weights, 0.0);
    for (const std::uint32_t index : indices) weights[index] += 1;
    for (std::size_t column = 0; column < wanted; column += 4) {
      const double* first = &columns[column * n];
      const auto four = dot_four(weights, {first, first + n, first + 2 * n, first + 3 * n});
      for (std::size_t k = 0; k < 4 && column + k < means.size(); ++k) {
        means[column + k] = four[k] / static_cast<double>(n);
      }
    }
    std::ranges::transform(std::span(means).first(counts), ratio.begin(), [](double mean) { return 1 + mean; });
    for (std::size_t r = 0; !paired && r < n; ++r) weights_[b * n + r] = static_cast<std::uint16_t>(weights[r]);
    const auto covariance = [&](std::size_t j, std::size_t k, std::size_t p) {
      const double squares = means[counts + p], difference = squares - means[j] * means[k];
      return (j == k && difference <= kRounding * squares ? 0.0 : difference) / (ratio[j] * ratio[k]);
    };
    for (std::size_t j = 0, p = 0; j < counts; ++j) {
      log_ratio_[b * counts + j] = ratio[j] > 0 ? 0.5 * std::log(ratio[j]) : kNone;
      for (std::size_t k = j; paired && k < counts; ++k, ++p) resample_[b * pairs + p] = covariance(j, k, p);
    }
  }
}

std::vector<double> LineBootstrap::variances() const {
  const auto n = static_cast<double>(replicates_);
  if (replicates_ < 2) return std::vector<double>(counts(), 1.0);
  // Of the mean squared error beside its own mean, reference included: alike over N, whatever share is subtracted.
  std::vector<double> result(counts());
  double common = 0;
  for (std::size_t j = 0; j < counts(); ++j) {
    result[j] = covariance_[j * counts() + j] / (n - 1);
    common += result[j] / static_cast<double>(counts());
  }
  for (std::size_t j = 0; j < counts(); ++j) {
    const double share = reference_sd_ / corrected_[j];
    result[j] = ((n * result[j] + kCommonReplicates * common) / (n + kCommonReplicates) + share * share) / 4;
    if (!(common > 0)) result[j] = 1;
  }
  return result;
}

double LineBootstrap::value(std::span<const double> c) const {
  CompensatedSum sum;
  for (std::size_t j = 0; j < c.size(); ++j) sum.add(c[j] * log_rmse_[j]);
  return sum.value();
}

double LineBootstrap::standard_error(std::span<const double> c) const {
  double variance = 0, scale = 0;
  for (std::size_t j = 0; j < c.size(); ++j) {
    scale += std::abs(c[j]) * std::sqrt(covariance_[j * counts() + j]);
    for (std::size_t k = 0; k < c.size(); ++k) variance += c[j] * c[k] * covariance_[j * counts() + k];
  }
  if (replicates_ < 2 || !(variance > kRounding * scale * scale)) return 0;
  return 0.5 * std::sqrt(variance / static_cast<double>(replicates_ - 1));
}

std::optional<LineBootstrap::Deviation> LineBootstrap::deviation(std::size_t resample,
                                                                 std::span<const double> c) const {
  if (resample_.empty()) return drawn_deviation(resample, c);
  const double* log_ratio = &log_ratio_[resample * counts()];
  const double* covariance = &resample_[resample * counts() * (counts() + 1) / 2];
  double change = 0, variance = 0, scale = 0;
  for (std::size_t j = 0; j < c.size(); covariance += counts() - j, ++j) {
    if (c[j] == 0) continue;
    if (std::isnan(log_ratio[j])) return std::nullopt;
    change += c[j] * log_ratio[j];
    double row = c[j] * covariance[0] / 2;
    for (std::size_t k = j + 1; k < c.size(); ++k) {
      if (c[k] != 0) row += c[k] * covariance[k - j];
    }
    variance += 2 * c[j] * row;
    scale += std::abs(c[j]) * std::sqrt(covariance[0]);
  }
  if (!(variance > kRounding * scale * scale)) return std::nullopt;
  return Deviation{change, 0.5 * std::sqrt(variance / static_cast<double>(replicates_ - 1))};
}

std::optional<LineBootstrap::Deviation> LineBootstrap::drawn_deviation(std::size_t resample,
                                                                       std::span<const double> c) const {
  const double* log_ratio = &log_ratio_[resample * counts()];
  const std::uint16_t* weights = &weights_[resample * replicates_];
  std::vector<double> influences(replicates_);
  double change = 0;
  for (std::size_t j = 0; j < c.size(); ++j) {
    if (c[j] == 0) continue;
    if (std::isnan(log_ratio[j])) return std::nullopt;
    change += c[j] * log_ratio[j];
    const double factor = c[j] * std::exp(-2 * log_ratio[j]), *deviations = &deviations_[j * replicates_];
    for (std::size_t r = 0; r < replicates_; ++r) influences[r] += factor * deviations[r];
  }
  // About one that was drawn, so that equal ones give an exact 0.
  const auto first =
      static_cast<std::size_t>(std::find_if(weights, weights + replicates_, [](auto w) { return w > 0; }) - weights);
  double sum = 0, squares = 0;
  for (std::size_t r = 0; r < replicates_; ++r) {
    const double d = influences[r] - influences[first];
    sum += weights[r] * d;
    squares += weights[r] * d * d;
  }
  const auto n = static_cast<double>(replicates_);
  const double variance = (squares - sum * sum / n) / n;
  if (!(variance > kRounding * squares / n)) return std::nullopt;
  return Deviation{change, 0.5 * std::sqrt(variance / (n - 1))};
}

double LineBootstrap::reference_change(std::size_t resample, std::span<const double> c) const {
  double change = 0;
  if (reference_draws_.empty()) return change;
  for (std::size_t j = 0; j < c.size(); ++j) {
    if (c[j] != 0) change += c[j] * 0.5 * std::log(1 + reference_draws_[resample] / corrected_[j]);
  }
  return change;
}

std::optional<Interval> LineBootstrap::interval(std::span<const double> c) const {
  const double se = standard_error(c);
  if (!(se > 0)) return std::nullopt;
  const double widened = se * (1 + 3 / static_cast<double>(replicates_));
  std::vector<double> changes;
  changes.reserve(kBootstrapResamples);
  for (std::size_t b = 0; b < kBootstrapResamples; ++b) {
    const std::optional<Deviation> drawn = deviation(b, c);
    const double change = drawn ? widened * drawn->change / drawn->error + reference_change(b, c) : kNone;
    if (std::isfinite(change)) changes.push_back(change);
  }
  return bootstrap_t_interval(value(c), 1, 1, changes, 0.95);
}

bool LineBootstrap::differ_from_zero(std::span<const Combination> combinations, double level) const {
  if (replicates_ < 2) return false;
  struct Tested {
    std::span<const double> c;
    double scale;  // standard error, the reference's part included
    double reference;
  };
  std::vector<Tested> tested;
  double largest = 0;
  for (const auto& [c, x] : combinations) {
    const double se = standard_error(c);
    double size = 0, reference = 0;
    for (std::size_t j = 0; j < c.size(); ++j) {
      size += std::abs(c[j] * log_rmse_[j]);
      reference += 0.5 * c[j] * reference_sd_ / corrected_[j];
    }
    if (se > 0) {
      tested.push_back({c, std::hypot(se, reference), reference});
      largest = std::max(largest, std::abs(x) / tested.back().scale);
    } else if (std::abs(x) > 1e-10 * size) {
      return true;
    }
  }
  if (tested.empty()) return false;
  std::ptrdiff_t as_large = 0;  // resamples without a value among them
  for (std::size_t b = 0; b < kBootstrapResamples; ++b) {
    double most = 0;
    for (const Tested& test : tested) {
      const std::optional<Deviation> drawn = deviation(b, test.c);
      const double change = drawn ? drawn->change + reference_change(b, test.c) : kNone,
                   t = std::abs(change) / (drawn ? std::hypot(drawn->error, test.reference) : 1);
      most = std::isfinite(t) ? std::max(most, t) : std::numeric_limits<double>::infinity();
      if (most >= largest) break;
    }
    as_large += most >= largest;
  }
  return static_cast<double>(as_large + 1) <= level * (kBootstrapResamples + 1);
}

}  // namespace halfslope
