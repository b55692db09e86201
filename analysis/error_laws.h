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
};

ErrorLaw gaussian_errors();               ///< σ = 1; kurtosis 3
ErrorLaw uniform_errors();                ///< in [−1, 1]; kurtosis 1.8
ErrorLaw laplace_errors();                ///< density e^(−|x|)/2; kurtosis 6
ErrorLaw lognormal_errors(double sigma);  ///< e^(σZ) less its mean e^(σ²/2); kurtosis 10 078 at σ = 1.5
ErrorLaw pareto_errors(double alpha);  ///< P(X > x) = x^−α, x > 1, less the mean, α > 2; no kurtosis where α ≤ 4

/// Means of `count` errors of a law, as a rendered pixel is. Drawn from a pool of 2^20 of them, made with the `seed`,
/// whose own mean is taken off and whose own mean square is the variance: so the truth is exact for what is drawn. The
/// memory is 8 MiB.
ErrorLaw mean_errors(const ErrorLaw& law, int count, std::uint64_t seed, int threads);

/// `count` scales like those of a picture's pixels: quantiles of e^(σZ), at (i + ½)/count, so their mean is near
/// e^(σ²/2).
std::vector<double> lognormal_scales(int count, double sigma);

}  // namespace halfslope
