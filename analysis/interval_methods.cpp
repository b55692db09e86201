#include "analysis/interval_methods.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <vector>

#include "analysis/bootstrap.h"

namespace halfslope {

std::span<const IntervalMethodInfo> interval_methods() {
  static constexpr IntervalMethodInfo kMethods[] = {
      {IntervalMethod::kBootstrapT, "bootstrap-t", "studentised bootstrap of log MSE, half-widths × (1 + 1.5/R)",
       "Efron and Tibshirani 1993, section 12.5"},
      {IntervalMethod::kChi2, "chi2", "scaled chi-squared, its degrees of freedom from the spread over replicates",
       "Satterthwaite 1946"},
      {IntervalMethod::kDelta, "delta", "Student's t on log MSE by the delta method", ""},
      {IntervalMethod::kBca, "bca", "bootstrap percentiles, bias-corrected and accelerated", "Efron 1987"},
  };
  return kMethods;
}

std::string_view to_string(IntervalMethod method) {
  return std::ranges::find(interval_methods(), method, &IntervalMethodInfo::method)->name;
}

std::optional<IntervalMethod> parse_interval_method(std::string_view name) {
  const auto found = std::ranges::find(interval_methods(), name, &IntervalMethodInfo::name);
  return found == interval_methods().end() ? std::nullopt : std::optional(found->method);
}

namespace {

bool usable(std::span<const double> values) {
  return values.size() >= 2 &&
         std::ranges::all_of(values, [](double value) { return std::isfinite(value) && value >= 0; });
}

Moments moments_of(std::span<const double> values) {
  Moments moments;
  moments.add(values);
  return moments;
}

}  // namespace

std::optional<Interval> log_mean_interval(IntervalMethod method, std::span<const double> values, std::uint64_t seed,
                                          double level) {
  switch (method) {
    case IntervalMethod::kBootstrapT:
      return log_mean_bootstrap_t(values, seed, level);
    case IntervalMethod::kBca:
      return log_mean_bca(values, seed, level);
    case IntervalMethod::kChi2:
    case IntervalMethod::kDelta:
      break;
  }
  return usable(values) ? log_mean_interval(method, moments_of(values), level) : std::nullopt;
}

std::optional<Interval> log_mean_interval(IntervalMethod method, const Moments& moments, double level) {
  return method == IntervalMethod::kChi2 ? log_mean_chi2(moments, level) : log_mean_t(moments, level);
}

std::optional<Interval> log_mean_chi2(const Moments& moments, double level) {
  if (moments.count < 2 || !(moments.mean > 0)) return std::nullopt;
  const double se = moments.standard_error() / moments.mean;
  if (!std::isfinite(se) || se <= 0) return std::nullopt;
  const double dof = 2 / (se * se), centre = std::log(moments.mean);
  // Beyond this the law is normal to 1e-7 of its width, and its quantiles' iterations no longer converge.
  if (dof > 1e12) return log_mean_t(moments, level);
  const boost::math::chi_squared law(dof);
  return Interval{centre + std::log(dof / boost::math::quantile(law, 0.5 + level / 2)),
                  centre + std::log(dof / boost::math::quantile(law, 0.5 - level / 2))};
}

std::optional<Interval> log_mean_bca(std::span<const double> values, std::uint64_t seed, double level) {
  if (!usable(values)) return std::nullopt;
  const Moments moments = moments_of(values);
  if (!(moments.mean > 0) || !std::isfinite(moments.central2) || !(moments.central2 > 0)) return std::nullopt;
  const double n = static_cast<double>(values.size());
  std::vector<double> relative(values.begin(), values.end());  // mean 1, as in log_mean_bootstrap_t
  for (double& value : relative) value /= moments.mean;

  std::vector<std::uint32_t> indices(values.size());
  std::vector<double> means(kBootstrapResamples);
  for (std::uint32_t resample = 0; resample < kBootstrapResamples; ++resample) {
    draw_resample(seed, resample, static_cast<std::uint32_t>(values.size()), indices);
    double sum = 0;
    for (const std::uint32_t index : indices) sum += relative[index];
    means[resample] = sum / n;
  }
  std::ranges::sort(means);
  const auto below = std::ranges::lower_bound(means, 1.0), above = std::ranges::upper_bound(means, 1.0);
  const double share =
      (static_cast<double>(below - means.begin()) + 0.5 * static_cast<double>(above - below)) / kBootstrapResamples;
  if (!(share > 0 && share < 1)) return std::nullopt;

  const boost::math::normal normal;
  const double z0 = boost::math::quantile(normal, share);
  const double acceleration = moments.central3 / (6 * std::pow(moments.central2, 1.5));
  const auto end = [&](double tail) {
    const double z = z0 + boost::math::quantile(normal, tail), slowed = 1 - acceleration * z;
    // Past the pole the formula would come back from the other side.
    const double p = slowed > 0 ? boost::math::cdf(normal, z0 + z / slowed) : (z > 0 ? 1.0 : 0.0);
    const double rank = std::clamp(p * (kBootstrapResamples + 1), 1.0, 1.0 * kBootstrapResamples) - 1;
    const auto lower = static_cast<std::size_t>(rank);
    const std::size_t upper = std::min(lower + 1, means.size() - 1);
    return std::log(moments.mean) + std::log(std::lerp(means[lower], means[upper], rank - static_cast<double>(lower)));
  };
  const Interval interval = {end(0.5 - level / 2), end(0.5 + level / 2)};
  return std::isfinite(interval.lo) ? std::optional(interval) : std::nullopt;  // a resample of zeros has no logarithm
}

}  // namespace halfslope
