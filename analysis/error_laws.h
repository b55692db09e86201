// Laws of errors whose moments are known: what intervals are tried on.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/run_random.h"

namespace halfslope {

/// The error of one estimate, with expectation 0.
struct ErrorLaw {
  std::string name;
  double variance;  ///< σ², the mean squared error
  std::function<double(RunRandom&)> draw;
  std::function<double(double)> upper_quantile;  ///< exceeded with probability q, 0 < q < 1; empty where not known
};

ErrorLaw gaussian_errors();               ///< σ = 1; kurtosis 3
ErrorLaw uniform_errors();                ///< in [−1, 1]; kurtosis 1.8
ErrorLaw laplace_errors();                ///< density e^(−|x|)/2; kurtosis 6
ErrorLaw lognormal_errors(double sigma);  ///< e^(σZ) less its mean e^(σ²/2); kurtosis 10 078 at σ = 1.5
ErrorLaw pareto_errors(double alpha);  ///< P(X > x) = x^−α, x > 1, less the mean, α > 2; no kurtosis where α ≤ 4

/// Means of `count` errors of a law, as a rendered pixel is. Single errors come fast from the law's quantiles on a line
/// between 64 knots an octave of the upper tail's probability, which is within 1e-5 of each, and exactly beyond a tail
/// of 1e-6.
ErrorLaw mean_errors(const ErrorLaw& law, int count);

/// `count` scales like those of a picture's pixels: quantiles of e^(σZ), at (i + ½)/count, so their mean is near
/// e^(σ²/2).
std::vector<double> lognormal_scales(int count, double sigma);

}  // namespace halfslope
