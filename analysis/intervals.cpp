#include "analysis/intervals.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

#include "analysis/bootstrap.h"

namespace halfslope {
namespace {

/// Sum and sum of squares of what a resample holds, about its first value, so that equal values give exact zeros.
struct ShiftedSums {
  double shift, sum, squares;
};

ShiftedSums shifted_sums(std::span<const double> values, std::span<const std::uint32_t> indices) {
  const double shift = values[indices[0]];
  std::array<double, 4> sum{}, squares{};  // four chains: one would wait for each addition to finish
  const auto add = [&](std::size_t lane, std::size_t i) {
    const double d = values[indices[i]] - shift;
    sum[lane] += d;
    squares[lane] += d * d;
  };
  std::size_t i = 0;
  for (; i + 4 <= indices.size(); i += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) add(lane, i + lane);
  }
  for (; i < indices.size(); ++i) add(0, i);
  return {shift, (sum[0] + sum[1]) + (sum[2] + sum[3]), (squares[0] + squares[1]) + (squares[2] + squares[3])};
}

}  // namespace

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
  const auto usable = [](double value) { return std::isfinite(value) && value >= 0; };
  if (values.size() < 2 || !std::ranges::all_of(values, usable)) return std::nullopt;
  Moments moments;
  moments.add(values);
  const double n = static_cast<double>(values.size()), se = moments.standard_error() / moments.mean;
  if (!(moments.mean > 0) || !std::isfinite(se) || se <= 0) return std::nullopt;
  std::vector<double> relative(values.begin(),
                               values.end());  // mean 1: the errors of one cell may be 1e-12, of another 1e9
  for (double& value : relative) value /= moments.mean;

  std::vector<std::uint32_t> indices(values.size());
  std::vector<double> studentised;
  studentised.reserve(kBootstrapResamples);
  for (std::uint32_t resample = 0; resample < kBootstrapResamples; ++resample) {
    draw_resample(seed, resample, static_cast<std::uint32_t>(values.size()), indices);
    const auto [shift, sum, squares] = shifted_sums(relative, indices);
    if (squares <= 0) continue;
    const double mean_ratio = shift + sum / n;
    const double resample_se = std::sqrt((squares - sum * sum / n) / (n * (n - 1))) / mean_ratio;
    studentised.push_back(std::log(mean_ratio) / resample_se);
  }
  return bootstrap_t_interval(std::log(moments.mean), se, 1 + 1.5 / n, studentised, level);
}

}  // namespace halfslope
