#include "analysis/intervals.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

#include "analysis/bootstrap.h"

namespace halfslope {
double t_quantile(double p, double dof) { return boost::math::quantile(boost::math::students_t(dof), p); }

std::optional<Interval> t_interval(const Moments& moments, double level) {
  if (moments.count < 2 || !std::isfinite(moments.mean) || !std::isfinite(moments.standard_error()))
    return std::nullopt;
  const double t = t_quantile(0.5 + level / 2, static_cast<double>(moments.count - 1));
  const double half_width = t * moments.standard_error();
  return Interval{moments.mean - half_width, moments.mean + half_width};
}

std::optional<Interval> log_mean_t(const Moments& moments, double level) {
  if (moments.count < 2 || !(moments.mean > 0)) return std::nullopt;
  const double se = moments.standard_error() / moments.mean;
  if (!std::isfinite(se) || se <= 0) return std::nullopt;
  const double half_width = t_quantile(0.5 + level / 2, static_cast<double>(moments.count - 1)) * se;
  return Interval{std::log(moments.mean) - half_width, std::log(moments.mean) + half_width};
}

std::optional<Interval> log_mean_bootstrap_t(std::span<const double> values, std::uint64_t seed, double level) {
  const std::optional<MeanBootstrap> bootstrap = bootstrap_mean(values, seed);
  return bootstrap ? log_mean_bootstrap_t(*bootstrap, level) : std::nullopt;
}

std::optional<Interval> log_mean_bootstrap_t(const MeanBootstrap& bootstrap, double level) {
  std::vector<double> studentised;
  studentised.reserve(bootstrap.resamples.size());
  for (const auto& [mean, se] : bootstrap.resamples) {
    if (se > 0) studentised.push_back(std::log(mean) / (se / mean));
  }
  const double n = static_cast<double>(bootstrap.moments.count);
  return bootstrap_t_interval(std::log(bootstrap.moments.mean), bootstrap.se, 1 + 1.5 / n, studentised, level);
}

}  // namespace halfslope
