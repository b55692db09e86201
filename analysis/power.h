// What a measured difference's spread says about experiments that are still to be made.
#pragma once

#include <cstdint>
#include <span>

namespace halfslope {

/// The spread of a comparison's influences u_r, as a pilot of R replicates measured it.
struct InfluenceSpread {
  double deviation = 0;  ///< s, their sample standard deviation: of n replicates the log ratio has the error s/√n
  double log_error = 0;  ///< standard error of log s: ½ √((κ − 1)/R), κ the influences' sample kurtosis
};

/// Of at least two influences.
InfluenceSpread influence_spread(std::span<const double> influences);

/// A prediction, and what it is with s at either end of its 95 % interval, s · exp(±1.96 log_error).
struct Prediction {
  double value, lo, hi;
};

/// The probability that a two-sided test tells a log ratio of `difference` from 0, by n replicates: with δ =
/// difference/(s/√n), Φ(δ − z) + Φ(−δ − z), less to second order the bias that the error of log s gives its mean over
/// pilots, but within the range. `critical` is z, 1.96 for a single comparison at 5 %.
Prediction predicted_power(const InfluenceSpread& spread, double difference, double critical, double replicates);

/// The n at which predicted_power is `power`, in [0.5, 1) : (z + Φ⁻¹(power))² s²/difference², without the far tail.
Prediction predicted_replicates(const InfluenceSpread& spread, double difference, double critical, double power);

}  // namespace halfslope
