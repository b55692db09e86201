// Straight lines through log RMSE, and from which N on the errors follow one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/line_bootstrap.h"

namespace halfslope {

/// A test of straightness calls a straight line bent in one case of a hundred.
inline constexpr double kLineLevel = 0.01;
/// A window has at least so many N: two are always on a line.
inline constexpr std::size_t kFewestInWindow = 4;

/// The slope Σ_j c_j y_j of the weighted least-squares line through (log N_j, y_j): c_j = w_j (x_j − x̄) / Σ w (x − x̄)²,
/// x = log N and x̄ its weighted mean. Weights ≥ 0; those of 0 leave their N out. Σ c_j = 0, Σ c_j x_j = 1. At least two
/// different N must have a weight.
std::vector<double> slope_coefficients(std::span<const double> samples, std::span<const double> weights);

/// Whether the y_j of [first, last) lie on no line: the largest of the residuals about the weighted line and of the
/// curvature (the weighted coefficient of the parabola that is orthogonal to lines), each over its standard error, is
/// beyond what joint resamples of the replicates give in 1 − level of cases.
bool is_bent(const LineBootstrap& line, std::span<const double> samples, std::span<const double> weights,
             std::size_t first, std::size_t last, double level = kLineLevel);

/// The least `first` for which [first, last) is not bent; empty where fewer than kFewestInWindow are left.
std::optional<std::size_t> straight_from(const LineBootstrap& line, std::span<const double> samples,
                                         std::span<const double> weights, std::size_t last);

/// weights with those outside [first, last) set to 0.
std::vector<double> weights_within(std::span<const double> weights, std::size_t first, std::size_t last);

}  // namespace halfslope
