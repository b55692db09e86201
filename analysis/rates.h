// How fast an error falls: the slope of log RMSE against log N.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/intervals.h"
#include "analysis/line_bootstrap.h"

namespace halfslope {

/// The errors of one line of convergence at N_1, …, N_J > 0.
struct RateData {
  std::vector<double> samples;
  /// mse[j][r], of the same R ≥ 1 replicates in the same order for each N, the reference's variance in it. ≥ 0, or not
  /// finite where an estimate was not.
  std::vector<std::vector<double>> mse;
  ReferenceNoise reference = {};
  /// The sample variance of estimates at each N, which no error of the reference reaches; empty where it is not known.
  std::vector<double> variance = {};
  /// The square of the values' own rounding error; 0 where that does not matter.
  double rounding_mse = 0;
  /// Not 0 at each N whose errors have so heavy a tail that no interval of their mean is certified; empty where none
  /// is.
  std::vector<char> heavy_tailed = {};
};

/// A fitted rate, −½ for plain Monte Carlo. Empty where the fit was refused, and `status` says why; the interval is
/// also empty with a single replicate and where too few resamples have a rate.
struct RateFit {
  std::optional<double> rate;
  std::optional<Interval> interval;                ///< 95 %, LineBootstrap::interval
  double samples_lo = 0, samples_hi = 0;           ///< the window: the least and the largest N of the fit
  std::string status;                              ///< "ok", or marks joined by ';'
  std::optional<double> floor_mse = std::nullopt;  ///< the mean squared error below which it does not fall
};

/// The slope between two neighbouring N, empty where one of them has no error that could be used. `status` has the
/// marks of either, as RateFit's.
struct LocalRate {
  double samples_lo = 0, samples_hi = 0;
  std::optional<double> rate;
  std::optional<Interval> interval;
  std::string status;
};

struct LineRates {
  RateFit plain;                  ///< over every N
  std::optional<RateFit> window;  ///< where the errors follow a line
  std::vector<LocalRate> local;   ///< between neighbouring N, in rising order
};

/// Everything that the errors say about their rate. `samples` must rise; else as RateData says, and anything different
/// is a programmer's error and aborts.
///
/// An N is *used* where its mean M_j is positive and finite, its R ≥ 2 replicates do not all err alike (then they have
/// met too little to know either the error or its spread), its errors are above rounding (M_j ≥ 100 · rounding_mse) and
/// above the reference's reach: V̄ ≤ 3/7 of the least MSE_j that the data allow, max(variance_j, M_j − δ²_0.999),
/// with δ²_0.999 the quantile of the reference's squared error; without a variance V̄ ≤ 0.3 M_j. That is where the
/// interval still covers (docs/rates.md): it carries the reference's error, which moves all M_j together.
///
/// plain: ordinary least squares over all N, c_j = x_j / Σ x², x_j = log N_j − mean. Marks that refuse it:
///   too-few-points     fewer than two different N
///   invalid            an M_j is not finite
///   exact              an M_j is 0
///   reference-limited  an M_j within the reference's reach
///   rounding-limited   an M_j within that of rounding
///   no-spread          at some N all replicates err alike
///   floor              the errors stop falling (find_floor), and a line would be fitted through that
/// Marks that don't: `deterministic` (R = 1), `few-replicates` (R < 16) and `heavy-tailed` (at some N used), with which
/// the interval is not certified, and `pre-asymptotic` (no line through all N used, is_bent).
///
/// window: weighted least squares, weights 1/LineBootstrap::variances, from the least N on from which the errors follow
/// a line, up to the largest used (straight_from), if these are half of the N used: fewer may be in line by chance;
/// marked `asymptotic`. Where they end in a floor: MSE = a·N^(2·rate) +
/// f over all used N from `samples_lo` on, those above `samples_hi`, which f dominates, telling f alone; marked
/// `floor`. Weights are kept in resamples. Empty below 16 replicates, below four N used, and where no four N are on a
/// line. Of more than LineBootstrap::kMostPaired N those nearest to equal steps of log N are looked at, and by
/// `pre-asymptotic` and `floor` too.
///
/// local: slopes between neighbouring used N; unlike the others for a single replicate too.
LineRates analyse_rates(const RateData& data, std::uint64_t seed);

/// Whether the interval is there and as sure as it says: without marks of too few replicates or of a heavy tail.
bool is_certified(const RateFit& fit);

/// The plain fit alone: of N that are not looked at one by one, so without the marks `pre-asymptotic` and `floor`.
RateFit fit_rate(const RateData& data, std::uint64_t seed);

}  // namespace halfslope
