// Confidence intervals of means and of logarithms of means.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "analysis/moments.h"

namespace halfslope {

/// The interval of an estimated number.
struct Interval {
  double lo, hi;
};

/// An end further than this factor from the number whose interval it is, either way, says nothing of it: too few
/// replicates, or a bootstrap that ran out of them. It is left empty.
inline constexpr double kFarthestEnd = 1e6;

/// Resamples of every bootstrap: the 25th and the 975th of 999 sorted values are the 2.5 % and 97.5 % quantiles
/// exactly, rank/(B + 1), without interpolation.
inline constexpr int kBootstrapResamples = 999;

/// The value that Student's t with `dof` > 0 degrees of freedom stays below with probability p, 0 < p < 1.
double t_quantile(double p, double dof);

/// Of the mean: x̄ ± t · s/√n. Empty below two values or where a moment is not finite.
std::optional<Interval> t_interval(const Moments& moments, double level = 0.95);

/// Of log μ by Student's t and the delta method: log x̄ ± t · s/(√n x̄). For so many values that the mean's distribution
/// is near normal; with fewer use the bootstrap. Empty below two values, and where x̄ ≤ 0, s = 0 or a moment is not
/// finite.
std::optional<Interval> log_mean_t(const Moments& moments, double level = 0.95);

/// Of log μ, μ the mean of the distribution that the n non-negative values are from, by bootstrap-t: with m the values'
/// mean and se = s/(√n m) the standard error of log m, each of B = 999 resamples gives T* = (log m* − log m)/se*, and
///   lo = log m − w · se · T*_(975),   hi = log m − w · se · T*_(25),   w = 1 + 1.5/n
/// (B. Efron, R. Tibshirani, "An Introduction to the Bootstrap", 1993, section 12.5; w is an empirical correction for
/// small n). Squared errors are skewed, and the upper end is the farther one, as it should be.
///
/// A resample of n equal values has no standard error. It is counted beyond both ends, the cautious side: the ranks
/// move outwards by one for each, and with 25 or more the interval is empty. Dropping or redrawing them would make it
/// shortest where the least is known, such as one non-zero error among many zeros.
///
/// Random numbers are Philox's, a function of `seed` alone. Empty below two values, and where all are equal or one is
/// negative or not finite. Below 16 values coverage is not certified.
std::optional<Interval> log_mean_bootstrap_t(std::span<const double> values, std::uint64_t seed, double level = 0.95);

/// The same from resamples that were drawn already.
struct MeanBootstrap;
std::optional<Interval> log_mean_bootstrap_t(const MeanBootstrap& bootstrap, double level = 0.95);

}  // namespace halfslope
