// What the error of a reference adds to the errors that are measured against it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "analysis/intervals.h"

namespace halfslope {

/// With R̂_p = I_p + δ_p a reference, E δ_p = 0, Var δ_p = V_p, independent over the P integrals p, and Î = I + ε, the
/// measured mean of squares is
///   M = mean (Î − R̂)² = mean ε² − 2 mean εδ + mean δ².
/// Its last term has the expectation V̄ = mean V_p, which is subtracted. What is left of it, mean δ² − V̄, is the same
/// for every replicate, so their spread does not show it. For normal δ (means of many replicates) its variance is
///   Var(mean δ²) = 2 Σ_p V_p² / P².
/// The cross term needs nothing: replicates differ in it, so of an unbiased estimator it is in their spread. (A bias
/// b_p of the estimator leaves −2 mean b_p δ_p, which is not.)
///
/// V_p is itself the estimate from n replicates of R̂, whose own error adds 2 V_p²/(n − 1); since E V̂_p² = V_p² (1 +
/// 2/(n − 1)), the plug-in 2 Σ V̂_p²/P² has that in it and a little more.
///
/// The channels of one pixel share their samples, so their errors are not independent: Var(Σ_c δ_c²) = 2 Σ_cc' Cov²,
/// which is at most 2 (Σ_c V_c)², and that where they go together. So V_p is summed over each pixel's channels before
/// it is squared.
///
/// Returns 2 Σ_pixels (Σ_c w V)² / P². `variances` are pixel-major, channels fastest, P their number, a multiple of
/// `channels`; `weights` are the w of a weighted error, none for all 1.
double mean_square_noise(std::span<const double> variances, std::size_t channels, std::span<const double> weights = {});

/// The 95 % interval of log M from the spread over replicates, made wider for a reference whose mean δ² has the
/// variance `noise`: log M moves by (mean δ²)/M, so on each side the distance d of the end from log `mean` and that of
/// the normal quantile z √noise / `mean`, z = 1.96, being independent, add up to √(d² + z² noise/mean²). For `mean` >
/// 0.
Interval widened_for_reference(Interval log_interval, double mean, double noise);

/// What a reference's own error is in a mean of squared errors: V̄, to be subtracted, and the variance of mean δ² about
/// it, which says how sure that is. Of a weighted error both are of w V.
struct ReferencePart {
  double mean = 0, noise = 0;
};

/// A mean of squared errors less the reference's part, and the ends of its 95 % interval. Empty where a number is not
/// finite or not positive, and an end whose root is further than a factor kFarthestEnd from that of the mean; never 0
/// instead.
struct CorrectedMean {
  std::optional<double> value, lo, hi;
};

/// `log_interval` is that of log `mean` from the spread over replicates; without it, and where `mean` is no more than
/// the reference's part, there are no ends.
CorrectedMean corrected_mean(double mean, const std::optional<Interval>& log_interval, const ReferencePart& part);

/// The root of each.
CorrectedMean rooted(const CorrectedMean& square);

}  // namespace halfslope
