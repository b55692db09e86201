// Times and what errors cost: medians of repeated timings, efficiency, places in a ranking.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/intervals.h"

namespace halfslope {

/// A positive number that was estimated, and its 95 % interval as far as it is known: an error, a time, an efficiency.
/// Half-widths are those of its logarithm.
struct PositiveEstimate {
  double value = 0;
  std::optional<double> lo = std::nullopt, hi = std::nullopt;

  std::optional<double> log_below() const;  ///< log(value / lo)
  std::optional<double> log_above() const;  ///< log(hi / value)
};

/// The median of repeated measurements, and an interval of the median of the law they are from.
struct MedianEstimate {
  double median = 0;
  Interval interval = {0, 0};
  double coverage = 0;  ///< that the interval has, or more, if the values are independent and of one law
};

/// Of n ≥ 1 finite values, in any order; none, or one that is not finite, is a programmer's error and aborts. The
/// interval goes from the k-th smallest value to the k-th largest, and whatever the law it holds the median of the law
/// with probability 1 − 2 P(B < k) at least, B binomial with n tries at ½. k is the largest that gives `level`; where
/// none does, at 95 % below 6 values, the interval is the range, and `coverage` says what that is worth.
/// (H. A. David, H. N. Nagaraja, "Order Statistics", 3rd ed. 2003, section 7.1.)
MedianEstimate median_estimate(std::span<const double> values, double level = 0.95);

/// 1/(rmse² · seconds), the reciprocal of what an integral costs: half the efficiency needs twice the time for the same
/// error. Error and time are measured apart, so their half-widths on the log, 2 · log(rmse end/rmse) and
/// log(time end/time), join in quadrature, side by side; an end that either lacks is empty. Both values > 0.
PositiveEstimate efficiency(const PositiveEstimate& rmse, const PositiveEstimate& seconds);

/// The places in a ranking that an estimate may have, from 1: behind all that are better beyond doubt, before all that
/// are worse beyond doubt.
struct Places {
  std::size_t first, last;
  /// "3", or "2-5" where the order cannot be told.
  std::string text() const;
};

/// Of each estimate among the others; one is better than another beyond doubt where its interval lies wholly on the
/// better side of the other's. Estimates without an interval have no place, and take none.
std::vector<std::optional<Places>> places(std::span<const PositiveEstimate> estimates, bool larger_is_better);

}  // namespace halfslope
