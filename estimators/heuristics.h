// The weights that combine techniques: folds of terms.
//
// With c_k samples of technique k a round, the multi-sample estimator (E. Veach, "Robust Monte Carlo methods for light
// transport simulation", 1997, eq. 9.4) is
//
//   F = Σ_i (1/c_i) Σ_j w_i(x_ij) f(x_ij) / p_i(x_ij),
//
// unbiased for any weights with Σ_i w_i(x) = 1 where f(x) ≠ 0 and w_i(x) = 0 where p_i(x) = 0. Here
//
//   only i    w_i = 1; w_k = 1 where p_i = 0        technique i alone, and of samples drawn beside what it cannot find
//   average   w_i = 1/n                             the mean of the techniques' own estimators
//   balance   w_i = c_i p_i / Σ_k c_k p_k           eq. 9.8
//   power β   w_i = (c_i p_i)^β / Σ_k (c_k p_k)^β   section 9.2.3
//   cutoff α  w_i = c_i p_i / Σ_k {c_k p_k : c_k p_k ≥ α q} where c_i p_i ≥ α q, q = max_k c_k p_k, else 0
//                                                   section 9.2.3
//   maximum   w_i = 1 for the first i with c_i p_i = q, else 0   section 9.2.3
//
// Densities span more orders of magnitude than binary32 has, and their powers more still. So every weight is made of
// the ratios r_k = c_k p_k / max_l c_l p_l, which lie in [0, 1] with one of them 1: sums lie in [1, n], nothing
// overflows, and what underflows is a weight that is 0 to the last bit. Where every density is 0 each weight is 1/n;
// there all ratios are the number before 1, which says so.
//
// Cutoff and maximum jump, and Σ_i w_i(x) = 1 must hold however each technique's sample came by the densities at x. Two
// densities that are the same function of x (by area and by the cosine on the inside of a sphere, say) differ by
// rounding, one way at one technique's samples and another way at the other's, and a jump there is a bias. So these two
// trust half of a ratio's digits: what is within kNearTie of a threshold has reached it.
#pragma once

#include <limits>
#include <type_traits>

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

/// The ratio of each technique where every density is 0.
template <class T>
inline constexpr T kAllZero = T(1) - std::numeric_limits<T>::epsilon() / 2;

/// What a ratio is compared with, over what it is meant to reach.
template <class T>
inline constexpr T kNearTie = std::is_same_v<T, float> ? T(1 - 0x1p-11) : T(1 - 0x1p-26);

/// Turns the scaled densities c_k p_k into the ratios r_k, in place. An infinite density is the largest.
template <class F>
inline void to_ratios(F* scaled, int techniques) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), all_zero(kAllZero<T>);
  if (techniques == 2) {  // the usual case needs one division
    const auto first = scaled[0] >= scaled[1];
    const F larger = select(first, scaled[0], scaled[1]), smaller = select(first, scaled[1], scaled[0]);
    const F unit = select(larger == zero, all_zero, one);
    const F ratio = select(smaller == larger, unit, smaller / larger);
    scaled[0] = select(first, unit, ratio);
    scaled[1] = select(first, ratio, unit);
    return;
  }
  F largest = scaled[0];
  for (int k = 1; k < techniques; ++k) largest = max(scaled[k], largest);
  const F unit = select(largest == zero, all_zero, one);
  for (int k = 0; k < techniques; ++k) scaled[k] = select(scaled[k] == largest, unit, scaled[k] / largest);
}

/// 0; NaN where a ratio is, which selections would lose.
template <class F>
inline F nan_of(const F* ratios, int techniques) {
  F sum = ratios[0];
  for (int k = 1; k < techniques; ++k) sum = sum + ratios[k];
  return F(scalar_t<F>(0)) * sum;
}

/// Where some density is not 0.
template <class F>
inline mask_t<F> any_density(const F* ratios, int techniques) {
  const F one(scalar_t<F>(1));
  mask_t<F> any = ratios[0] == one;
  for (int k = 1; k < techniques; ++k) any = any | (ratios[k] == one);
  return any;
}

/// A lane at a time, in binary64.
template <class F>
inline F custom_weight(WeightFunction function, const F* ratios, int techniques, int i) {
  using T = scalar_t<F>;
  constexpr int kMostTechniques = 16;
  alignas(64) T lanes[kMostTechniques][kWidth<F>];
  for (int k = 0; k < techniques; ++k) store(lanes[k], ratios[k]);
  for (int l = 0; l < kWidth<F>; ++l) {
    double of_lane[kMostTechniques];
    for (int k = 0; k < techniques; ++k) of_lane[k] = static_cast<double>(lanes[k][l]);
    lanes[0][l] = static_cast<T>(function(of_lane, techniques, i));
  }
  return load<F>(lanes[0]);
}

/// The weight of technique i from the ratios of all.
template <class F>
inline F weight(const Heuristic& heuristic, const F* ratios, int techniques, int i) {
  using T = scalar_t<F>;
  switch (heuristic.kind) {
    case HeuristicKind::kSingle:
      return F(T(1));
    case HeuristicKind::kOnly:
      if (i == static_cast<int>(heuristic.parameter)) return F(T(1));
      return select(ratios[static_cast<int>(heuristic.parameter)] == F(T(0)), F(T(1)), F(T(0)));
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
    case HeuristicKind::kCutoff: {
      const F alpha(static_cast<T>(heuristic.parameter) * kNearTie<T>), zero(T(0));
      F sum = zero;
      for (int k = 0; k < techniques; ++k) sum = sum + select(ratios[k] >= alpha, ratios[k], zero);
      const F own = select(ratios[i] >= alpha, ratios[i] / sum, zero);
      const F equal(T(1) / static_cast<T>(techniques));
      return select(any_density(ratios, techniques), own, equal) + nan_of(ratios, techniques);
    }
    case HeuristicKind::kMaximum: {
      const F zero(T(0)), one(T(1)), most(kNearTie<T>);
      F own = select(ratios[i] >= most, one, zero);
      for (int k = 0; k < i; ++k) own = select(ratios[k] >= most, zero, own);
      const F equal(T(1) / static_cast<T>(techniques));
      return select(any_density(ratios, techniques), own, equal) + nan_of(ratios, techniques);
    }
    case HeuristicKind::kCustom:
      return custom_weight(heuristic.custom, ratios, techniques, i);
    case HeuristicKind::kOptimal:
    case HeuristicKind::kOptimalProgressive:
      break;  // no folds
  }
  return F(T(0));
}

}  // namespace halfslope
