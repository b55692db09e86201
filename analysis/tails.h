// How heavy the tails of a cell's errors are: what decides whether its intervals can be trusted.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/moments.h"

namespace halfslope {

/// K = Σ_p μ4_p / Σ_p σ_p⁴ of the errors' laws, estimated without the bias that few replicates bring to the plain
/// Σ m4 / Σ m2², which for R normal errors is about 3 (R − 1)/(R + 1), and at most R for any: numerator and denominator
/// are unbiased each. `sum_m2_squared` = Σ_p m2_p² and `sum_m4` = Σ_p m4_p are over integrals, m_k = (1/R) Σ (x − x̄)^k,
/// R one and the same. 3 for normal errors at any R; infinity where the spread is all in one replicate of each
/// integral, so that its square has no estimate above 0. Empty below four replicates, and where there is no spread or
/// it is not finite. Derivation in tails.cpp.
std::optional<double> corrected_kurtosis(double sum_m2_squared, double sum_m4, std::int64_t replicates);

/// max(5, R/40): a corrected kurtosis above it is a heavy tail, and intervals are not certified. A mean of R squared
/// errors has the relative variance (K − 1)/R, so that with more replicates more can be borne.
double kurtosis_limit(std::int64_t replicates);

/// ⌈P/1000⌉: how many of P integrals are the worst 0.1 %, at least one.
std::int64_t worst_count(std::int64_t integrals);

/// Mean of (x − truth)² over the values x that the moments are of: m2 + (x̄ − truth)².
double mean_squared_error(const Moments& moments, double truth);

/// Keeps of `values` the `count` largest, descending (all where there are fewer), and returns the sum of the others;
/// NaN counts as the largest.
double keep_largest(std::vector<double>& values, std::int64_t count);

/// Of the largest of some non-negative terms and the sum of the others, the share of the largest in all: at most 1,
/// however the sums are rounded. Empty where all are 0 or a sum is not finite.
std::optional<double> share_of_largest(double largest, double others);

}  // namespace halfslope
