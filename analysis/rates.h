// How fast an error falls: the slope of log RMSE against log N.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/intervals.h"

namespace halfslope {

/// A fitted rate, −½ for plain Monte Carlo. Empty where the fit was refused, and `status` says why; the interval is
/// also empty with a single replicate and where too few resamples have a rate.
struct RateFit {
  std::optional<double> rate;
  std::optional<Interval> interval;
  double samples_lo = 0, samples_hi = 0;  ///< the window: the least and the largest N of the fit
  std::string status;                     ///< "ok", or marks joined by ';'
};

/// Ordinary least squares of log RMSE_j on log N_j, where MSE_j = mean over replicates of mse[j][r], less the
/// reference's variance V̄_j. With x_j = log N_j − mean log N and c_j = x_j / Σ x², the rate is Σ_j c_j · ½ log MSE_j.
///
/// Samples at different N of one replicate share points, so the interval (95 %) resamples replicates jointly over all
/// N: bootstrap-t as in log_mean_bootstrap_t, B = 999, studentised by the standard error of the mean of the replicates'
/// influences u_r = ½ Σ_j c_j · mse[j][r] / MSE_j (the derivative of the rate by the weight of replicate r),
/// half-widths × (1 + 1.5/R). A resample with some MSE*_j ≤ 0 or equal influences counts as beyond both ends. V̄ is
/// taken as exact.
///
/// Shapes: samples, mse and reference_mse have one entry for each N, each mse[j] the same R ≥ 1 replicates in the same
/// order; anything else is a programmer's error and aborts. samples > 0, mse and reference_mse ≥ 0.
///
/// Marks that refuse the fit: `too-few-points` (fewer than two different N), `invalid` (an MSE is not finite), `exact`
/// (an MSE is 0), `reference-limited` (V̄_j above 10 % of the measured mean), `rounding-limited` (a measured mean under
/// 100 · rounding_mse, the square of the values' own rounding error; 0 where that does not matter). Marks that don't:
/// `deterministic` (R = 1), `few-replicates` (R < 16: the interval is not certified).
RateFit fit_rate(std::span<const double> samples, std::span<const std::vector<double>> mse,
                 std::span<const double> reference_mse, std::uint64_t seed, double rounding_mse = 0);

}  // namespace halfslope
