#include "analysis/interval_methods.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
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
      {IntervalMethod::kReciprocalT, "reciprocal-t",
       "studentised bootstrap of 1/MSE, half-widths × (1 + (1.5 + skewness²/2)/R)", ""},
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

std::vector<std::optional<Interval>> log_mean_intervals(std::span<const IntervalMethod> methods,
                                                        std::span<const double> values, std::uint64_t seed,
                                                        double level) {
  const auto resamples = [](IntervalMethod method) {
    return method != IntervalMethod::kChi2 && method != IntervalMethod::kDelta;
  };
  std::optional<MeanBootstrap> bootstrap;
  if (std::ranges::any_of(methods, resamples)) bootstrap = bootstrap_mean(values, seed);
  Moments moments;
  if (std::ranges::all_of(values, [](double value) { return value >= 0; })) moments.add(values);
  std::vector<std::optional<Interval>> intervals;
  for (const IntervalMethod method : methods) {
    if (!resamples(method)) {
      intervals.push_back(log_mean_interval(method, moments, level));
    } else if (!bootstrap) {
      intervals.emplace_back();
    } else if (method == IntervalMethod::kBca) {
      intervals.push_back(log_mean_bca(*bootstrap, level));
    } else {
      intervals.push_back(method == IntervalMethod::kBootstrapT ? log_mean_bootstrap_t(*bootstrap, level)
                                                                : log_mean_reciprocal_t(*bootstrap, level));
    }
  }
  return intervals;
}

std::optional<Interval> log_mean_interval(IntervalMethod method, std::span<const double> values, std::uint64_t seed,
                                          double level) {
  return log_mean_intervals(std::span(&method, 1), values, seed, level).front();
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

std::optional<Interval> log_mean_bca(const MeanBootstrap& bootstrap, double level) {
  const Moments& moments = bootstrap.moments;
  std::vector<double> means;
  for (const MeanBootstrap::Resample& resample : bootstrap.resamples) means.push_back(resample.mean);
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

// With the values in units of their mean, m = 1: T* = (1 − 1/m*) √n m*²/s* = m* (m* − 1)/(s*/√n).
std::optional<Interval> log_mean_reciprocal_t(const MeanBootstrap& bootstrap, double level) {
  const Moments& moments = bootstrap.moments;
  std::vector<double> studentised;
  studentised.reserve(bootstrap.resamples.size());
  for (const auto& [mean, se] : bootstrap.resamples) {
    if (se > 0) studentised.push_back(mean * (mean - 1) / se);
  }
  const double n = static_cast<double>(moments.count);
  const double skewness = moments.m3() / std::pow(moments.m2(), 1.5);
  const double widening = 1 + (1.5 + skewness * skewness / 2) / n;
  // Of −1/μ, which grows with μ.
  const std::optional<Interval> interval = bootstrap_t_interval(-1, bootstrap.se, widening, studentised, level);
  if (!interval) return std::nullopt;
  const auto end = [&](double negated) {
    return negated < 0 ? std::log(moments.mean) - std::log(-negated) : std::numeric_limits<double>::infinity();
  };
  return Interval{end(interval->lo), end(interval->hi)};
}

}  // namespace halfslope
