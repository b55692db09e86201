// The weights that combine techniques: folds of terms.
//
// With c_k samples of technique k a round, the multi-sample estimator (E. Veach, "Robust Monte Carlo methods for light
// transport simulation", 1997, eq. 9.4) is
//
//   F = Σ_i (1/c_i) Σ_j w_i(x_ij) f(x_ij) / p_i(x_ij),
//
// unbiased for any weights with Σ_i w_i(x) = 1 where f(x) ≠ 0 and w_i(x) = 0 where p_i(x) = 0. Here
//
//   average   w_i = 1/n                             the mean of the techniques' own estimators
//   balance   w_i = c_i p_i / Σ_k c_k p_k           eq. 9.8
//   power β   w_i = (c_i p_i)^β / Σ_k (c_k p_k)^β   eq. 9.9
//
// Densities span more orders of magnitude than binary32 has, and their powers more still. So every weight is made of
// the ratios r_k = c_k p_k / max_l c_l p_l, which lie in [0, 1] with one of them 1: sums lie in [1, n], nothing
// overflows, and what underflows is a weight that is 0 to the last bit. Where every density is 0 each weight is 1/n.
#pragma once

#include <limits>

#include "core/packet.h"
#include "estimators/kernels.h"

namespace halfslope {

/// r^β for r in [0, 1], β ≥ 0; 0 for r below the normal range where β is none of 0, 1, 2, 3, 4. NaN stays NaN.
template <class F>
inline F ratio_power(const F& r, double beta) {
  using T = scalar_t<F>;
  if (beta == 2) return r * r;
  if (beta == 1) return r;
  if (beta == 3) return r * r * r;
  if (beta == 4) return (r * r) * (r * r);
  const F smallest(std::numeric_limits<T>::min()), zero(T(0)), one(T(1));
  if (beta == 0) return fma(zero, r, one);
  const F exponent = F(static_cast<T>(beta)) * log(max(r, smallest));
  // Below this exp is 0 or denormal: say so rather than ask it.
  const F least(std::is_same_v<T, float> ? T(-87) : T(-708));
  const F power = select(exponent < least, zero, exp(max(exponent, least)));
  return select(r >= smallest, power, zero * r);
}

/// The ratios r_k of the scaled densities c_k p_k (in place), and whether all of them were 0 (then each ratio is 1).
template <class F>
inline void to_ratios(F* scaled, int techniques) {
  using T = scalar_t<F>;
  if (techniques == 2) {  // the usual case needs one division
    const auto first = scaled[0] >= scaled[1];
    const F larger = select(first, scaled[0], scaled[1]), smaller = select(first, scaled[1], scaled[0]);
    const F unit(T(1)), ratio = select(larger == F(T(0)), unit, smaller / larger);
    scaled[0] = select(first, unit, ratio);
    scaled[1] = select(first, ratio, unit);
    return;
  }
  F largest = scaled[0];
  for (int k = 1; k < techniques; ++k) largest = max(scaled[k], largest);
  const auto none = largest == F(T(0));
  const F one(T(1));
  const F divisor = select(none, one, largest);
  for (int k = 0; k < techniques; ++k) scaled[k] = select(none, one, scaled[k] / divisor);
}

/// The weight of technique i from the ratios of all.
template <class F>
inline F weight(const Heuristic& heuristic, const F* ratios, int techniques, int i) {
  using T = scalar_t<F>;
  switch (heuristic.kind) {
    case HeuristicKind::kSingle:
      return F(T(1));
    case HeuristicKind::kAverage:
      return F(T(1) / static_cast<T>(techniques));
    case HeuristicKind::kBalance: {
      F sum = ratios[0];
      for (int k = 1; k < techniques; ++k) sum = sum + ratios[k];
      return ratios[i] / sum;
    }
    case HeuristicKind::kPower: {
      F sum(T(0)), own(T(0));
      for (int k = 0; k < techniques; ++k) {
        const F power = ratio_power(ratios[k], heuristic.parameter);
        if (k == i) own = power;
        sum = sum + power;
      }
      return own / sum;
    }
  }
  return F(T(0));
}

}  // namespace halfslope
