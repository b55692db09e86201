// How far a sample variance may lie from a variance that is known.
#pragma once

#include <cstdint>

#include "analysis/cumulants.h"
#include "analysis/intervals.h"

namespace halfslope {

/// The law of V̂/V: V̂ the sample variance (over R − 1) of R independent numbers of one law, V = κ_2 of that law. Its
/// mean is 1. With the standardised cumulants λ_j = κ_j / κ_2^(j/2) and n = R its own next three are
///
///   c₂ = λ₄/n + 2/(n−1) = (K − (n−3)/(n−1))/n
///   c₃ = λ₆/n² + 12 λ₄/(n(n−1)) + 4(n−2) λ₃²/(n(n−1)²) + 8/(n−1)²
///   c₄ = λ₈/n³ + 24 λ₆/(n²(n−1)) + 32(n−2) λ₅λ₃/(n²(n−1)²) + 8(4n²−9n+6) λ₄²/(n²(n−1)³)
///        + 144 λ₄/(n(n−1)²) + 96(n−2) λ₃²/(n(n−1)³) + 48/(n−1)³
///
/// exactly (R. A. Fisher, "Moments and product moments of sampling distributions", 1930; M. G. Kendall, A. Stuart, "The
/// advanced theory of statistics", vol. 1, section 12.16).
struct SampleVarianceLaw {
  double deviation;  ///< √c₂
  double skewness;   ///< c₃/c₂^(3/2)
  double excess;     ///< c₄/c₂²: of the kurtosis over 3
};
SampleVarianceLaw sample_variance_law(const Cumulants& cumulants, std::int64_t replicates);

/// Whether sample_variance_range() can be trusted: K − 3 ≤ R/40 and skewness² ≤ R/40, of the law of the numbers. Since
/// K ≥ 1 + skewness², the second adds little where R is large; where it is small it tells numbers that are near normal
/// from those that take few values.
bool has_sample_variance_range(const Cumulants& cumulants, std::int64_t replicates);

/// The range that V̂/V is in with probability `level` at least, for laws that have it: lo may be negative, as nothing
/// but 0 is then too little. Quantiles of gamma laws, shifted and scaled to V̂/V's mean 1 and deviation s (Pearson's
/// type III), which are exact for normal numbers, where their skewness is 2s. With γ the skewness and e the excess of
/// V̂/V, a gamma law of the excess e has the skewness τ = √(max(e, 0)/1.5), and the laws are
///
///   upper end   of skewness max(2s, γ, τ)
///   lower end   of skewness min(2s, γ), and where γ < 0, −max(−γ, τ)
///
/// the wider of those that come in question. Each end leaves out (1 − level)/4: where has_sample_variance_range()
/// holds, the two tails together have at most twice what the quantiles say, for levels up to 1 − 10⁻⁵ (summed exactly
/// over two-valued numbers and their sums, simulated of rare spikes and gamma numbers, in
/// tests/analysis/sample_variance_test.cpp).
Interval sample_variance_range(const Cumulants& cumulants, std::int64_t replicates, double level);

}  // namespace halfslope
