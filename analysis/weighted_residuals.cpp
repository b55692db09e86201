#include "analysis/weighted_residuals.h"

#include <cmath>

namespace halfslope {

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& design, std::span<const double> weights) {
  Eigen::VectorXd root(design.rows());
  for (Eigen::Index i = 0; i < root.size(); ++i) root[i] = std::sqrt(weights[static_cast<std::size_t>(i)]);
  const Eigen::MatrixXd scaled = root.asDiagonal() * design, scales = root.asDiagonal();
  return scaled.colPivHouseholderQr().solve(scales);
}

std::vector<Combination> residual_combinations(const Eigen::MatrixXd& design, std::span<const double> weights,
                                               const Eigen::VectorXd& residuals, std::size_t first,
                                               std::size_t counts) {
  const Eigen::MatrixXd hat = design * least_squares(design, weights);
  std::vector<Combination> combinations;
  for (Eigen::Index i = 0; i < hat.rows(); ++i) {
    Combination residual{std::vector<double>(counts), residuals[i]};
    for (Eigen::Index k = 0; k < hat.cols(); ++k) {
      residual.c[first + static_cast<std::size_t>(k)] = (i == k ? 1.0 : 0.0) - hat(i, k);
    }
    combinations.push_back(std::move(residual));
  }
  return combinations;
}

}  // namespace halfslope
