#include "analysis/rate_line.h"

#include <Eigen/Dense>
#include <cmath>

#include "analysis/compensated_sum.h"
#include "analysis/weighted_residuals.h"

namespace halfslope {

std::vector<double> slope_coefficients(std::span<const double> samples, std::span<const double> weights) {
  std::vector<double> c(samples.size());
  CompensatedSum total, sum, squares;
  for (std::size_t j = 0; j < c.size(); ++j) {
    total.add(weights[j]);
    sum.add(weights[j] * std::log(samples[j]));
  }
  for (std::size_t j = 0; j < c.size(); ++j) {
    const double x = std::log(samples[j]) - sum.value() / total.value();
    c[j] = weights[j] * x;
    squares.add(weights[j] * x * x);
  }
  for (double& value : c) value /= squares.value();
  return c;
}

std::vector<double> weights_within(std::span<const double> weights, std::size_t first, std::size_t last) {
  std::vector<double> within(weights.size());
  for (std::size_t j = first; j < last; ++j) within[j] = weights[j];
  return within;
}

bool is_bent(const LineBootstrap& line, std::span<const double> samples, std::span<const double> weights,
             std::size_t first, std::size_t last, double level) {
  const auto count = static_cast<Eigen::Index>(last - first);
  Eigen::MatrixXd powers(count, 3);  // 1, x, x², x about the middle so that they are far from collinear
  const double middle = 0.5 * (std::log(samples[first]) + std::log(samples[last - 1]));
  for (Eigen::Index i = 0; i < count; ++i) {
    const double x = std::log(samples[first + static_cast<std::size_t>(i)]) - middle;
    powers.row(i) << 1, x, x * x;
  }
  const auto used = weights.subspan(first, last - first);
  const auto y = line.log_rmse().subspan(first, last - first);
  const Eigen::MatrixXd lines = powers.leftCols(2), parabola = least_squares(powers, used);
  const Eigen::VectorXd measured = Eigen::Map<const Eigen::VectorXd>(y.data(), count),
                        residuals = measured - lines * (least_squares(lines, used) * measured);
  std::vector<Combination> combinations = residual_combinations(lines, used, residuals, first, line.counts());
  Combination curvature{std::vector<double>(line.counts()), 0};
  for (Eigen::Index i = 0; i < count; ++i) curvature.c[first + static_cast<std::size_t>(i)] = parabola(2, i);
  curvature.value = line.value(curvature.c);
  // Apart, because the largest of many has quantiles that would hide the curvature from few replicates.
  return line.differ_from_zero(std::span(&curvature, 1), level / 2) || line.differ_from_zero(combinations, level / 2);
}

std::optional<std::size_t> straight_from(const LineBootstrap& line, std::span<const double> samples,
                                         std::span<const double> weights, std::size_t last) {
  for (std::size_t first = 0; first + kFewestInWindow <= last; ++first) {
    if (!is_bent(line, samples, weights, first, last)) return first;
  }
  return std::nullopt;
}

}  // namespace halfslope
