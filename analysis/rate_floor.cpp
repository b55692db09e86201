#include "analysis/rate_floor.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/rate_line.h"
#include "analysis/weighted_residuals.h"

namespace halfslope {
namespace {

constexpr std::size_t kFewestForFloor = 5;
constexpr double kDominated = 0.5;
/// Where the floor dominates, errors may fall this much as fast as above it.
constexpr double kMostTail = 1.0 / 3;
constexpr std::size_t kFewestBeforeFloor = 3, kFewestInFloor = 2;

/// log a, rate, log f.
using Parameters = Eigen::Vector3d;

/// The model at x_j = log N_j beside measured y_j.
struct Model {
  Eigen::VectorXd x, y, root_weights;

  double share(const Parameters& p, double at) const { return 1 / (1 + std::exp(p[0] + 2 * p[1] * at - p[2])); }
  Eigen::VectorXd residuals(const Parameters& p) const {
    Eigen::VectorXd r(x.size());
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const double line = p[0] + 2 * p[1] * x[j], larger = std::max(line, p[2]);
      r[j] = y[j] - 0.5 * (larger + std::log1p(std::exp(-std::abs(line - p[2]))));
    }
    return r;
  }
  Eigen::MatrixXd jacobian(const Parameters& p) const {
    Eigen::MatrixXd j(x.size(), 3);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double s = share(p, x[i]);
      j.row(i) << 0.5 * (1 - s), (1 - s) * x[i], 0.5 * s;
    }
    return j;
  }
  double loss(const Parameters& p) const { return root_weights.cwiseProduct(residuals(p)).squaredNorm(); }

  Parameters fit(Parameters p) const {
    double damping = 1e-3, least = loss(p);
    for (int iteration = 0; iteration < 200 && damping < 1e12; ++iteration) {
      const Eigen::MatrixXd j = root_weights.asDiagonal() * jacobian(p);
      const Eigen::Matrix3d normal = j.transpose() * j;
      const Eigen::Vector3d gradient = j.transpose() * root_weights.cwiseProduct(residuals(p));
      Eigen::Matrix3d damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + 1e-12 * normal.trace()).matrix();
      const Parameters step = damped.ldlt().solve(gradient), next = p + step;
      const double value = loss(next);
      if (!(value <= least)) {
        damping *= 10;
        continue;
      }
      const bool settled = step.norm() <= 1e-12 * (1 + p.norm());
      p = next, least = value, damping /= 10;
      if (settled) break;
    }
    return p;
  }
};

}  // namespace

std::optional<FloorFit> fit_floor(const LineBootstrap& line, std::span<const double> samples,
                                  std::span<const double> weights, std::size_t first, std::size_t last) {
  if (last - first < kFewestForFloor) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(last - first);
  Model model{Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t j = first + static_cast<std::size_t>(i);
    model.x[i] = std::log(samples[j]);
    model.y[i] = line.log_rmse()[j];
    model.root_weights[i] = std::sqrt(weights[j]);
  }
  // The floor begins near the last error, or below it; the line through the first errors.
  const double rate = (model.y[count / 2] - model.y[0]) / (model.x[count / 2] - model.x[0]);
  Parameters best = Parameters::Zero();
  std::optional<double> least;
  for (const double below : {0.05, 1.0}) {
    const Parameters found = model.fit({2 * (model.y[0] - rate * model.x[0]), rate, 2 * model.y.minCoeff() - below});
    const double loss = model.loss(found);
    if (std::isfinite(loss) && (!least || loss < *least)) best = found, least = loss;
  }
  if (!least) return std::nullopt;

  const Eigen::MatrixXd jacobian = model.jacobian(best);
  const auto used = weights.subspan(first, last - first);
  const Eigen::MatrixXd coefficients = least_squares(jacobian, used);
  if (!coefficients.allFinite()) return std::nullopt;
  FloorFit fit{best[1], std::exp(best[2]), std::vector<double>(line.counts()), {}, {}};
  for (Eigen::Index i = 0; i < count; ++i) fit.coefficients[first + static_cast<std::size_t>(i)] = coefficients(1, i);
  for (const double n : samples) fit.share.push_back(model.share(best, std::log(n)));
  fit.residuals = residual_combinations(jacobian, used, model.residuals(best), first, line.counts());
  return fit;
}

std::optional<Floor> find_floor(const LineBootstrap& line, std::span<const double> samples,
                                std::span<const double> weights) {
  const std::size_t last = line.counts();
  for (std::size_t first = 0; first + kFewestForFloor <= last; ++first) {
    if (!is_bent(line, samples, weights, first, last)) return std::nullopt;
    std::optional<FloorFit> fit = fit_floor(line, samples, weights, first, last);
    if (!fit || !(fit->rate < 0)) continue;
    const auto dominated = std::find_if(fit->share.begin() + static_cast<std::ptrdiff_t>(first), fit->share.end(),
                                        [](double share) { return share > kDominated; });
    const auto end = static_cast<std::size_t>(dominated - fit->share.begin());
    if (end < first + kFewestBeforeFloor || end + kFewestInFloor > last) continue;
    const double tail = (line.log_rmse()[last - 1] - line.log_rmse()[end]) / std::log(samples[last - 1] / samples[end]);
    if (tail < fit->rate * kMostTail) continue;  // it slows down, and goes on falling
    if (line.differ_from_zero(fit->residuals, kLineLevel)) continue;
    return Floor{std::move(*fit), first, end};
  }
  return std::nullopt;
}

}  // namespace halfslope
