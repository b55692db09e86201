// Weighted least squares as matrices: what a fit makes of each measured number.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "analysis/line_bootstrap.h"

namespace halfslope {

/// (XᵀWX)⁻¹ XᵀW for an n × k design X of full rank: it takes n measured numbers to the k coefficients that minimise
/// Σ w (y − Xβ)². By QR of √W X.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& design, std::span<const double> weights);

/// The residuals r of a fit with this design (or, of a model that is not linear, with its Jacobian) as combinations of
/// `counts` numbers, of which those from `first` on were fitted. Their linear part is I − X (XᵀWX)⁻¹ XᵀW; of a linear
/// fit to y, r is that times y.
std::vector<Combination> residual_combinations(const Eigen::MatrixXd& design, std::span<const double> weights,
                                               const Eigen::VectorXd& residuals, std::size_t first, std::size_t counts);

}  // namespace halfslope
