// Errors that stop falling: at rounding, at the reference, at a bias.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/line_bootstrap.h"

namespace halfslope {

/// MSE_j = a · N_j^(2 rate) + f fitted to the y_j = ½ log MSE_j of [first, last) by weighted least squares.
struct FloorFit {
  double rate = 0;
  double floor_mse = 0;              ///< f
  std::vector<double> coefficients;  ///< ∂ rate / ∂ y_j, over all N of the line
  std::vector<double> share;         ///< f over the model's MSE at each N of the line
  std::vector<Combination> residuals;
};

/// By Levenberg's and Marquardt's method in (log a, rate, log f), which keeps a and f positive, from two starts. Empty
/// where there are fewer than five N, or nothing is found with finite coefficients.
std::optional<FloorFit> fit_floor(const LineBootstrap& line, std::span<const double> samples,
                                  std::span<const double> weights, std::size_t first, std::size_t last);

/// What was found to end in a floor: the fit, and the window that the floor does not dominate.
struct Floor {
  FloorFit fit;
  std::size_t first, last;  ///< N of [first, last) were not dominated: f is at most half of the model's MSE
};

/// A floor is found from the least `first` for which a line is refused (is_bent) and the model with a floor is not, on
/// [first, J); where f is more than half of the MSE at two N at least (one alone may be an outlier), at least three N
/// stay below half, the errors of the N that it dominates fall at most a third as fast as the others, and the errors
/// fall before it (rate < 0). Empty where a line does, or nothing fits.
std::optional<Floor> find_floor(const LineBootstrap& line, std::span<const double> samples,
                                std::span<const double> weights);

}  // namespace halfslope
