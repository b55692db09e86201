// The Phong lobe about the mirror direction, (n+1)/(2π) cosⁿα as a density and (n+2)/(2π) cosⁿα as a BRDF.
//
// E. P. Lafortune & Y. D. Willems, "Using the modified Phong reflectance model for physically based rendering", 1994.
// n reaches 10⁸ and cosⁿα is decided by what cos α loses when it is rounded to 1; so it is always a function of
// v = 1 − cos α or of sin²α, by log1p, and a sampled angle comes with both.
#pragma once

#include <limits>
#include <numbers>

#include "core/packet.h"

namespace halfslope {

/// cosⁿα from v = 1 − cos α in [0, 2], n ≥ 0; 0 where cos α ≤ 0.
template <class F>
inline F phong_cos_power(const F& exponent, const F& one_minus_cos) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  // Below this exp is 0 or denormal: say so rather than ask it.
  const F least(std::is_same_v<T, float> ? T(-87) : T(-708));
  const F largest(one - F(std::numeric_limits<T>::epsilon() / 2));
  const F power = exponent * log1p(-min(one_minus_cos, largest));
  return select((one_minus_cos < one) & (power > least), exp(max(power, least)), zero);
}

/// The density (n+1)/(2π) cosⁿα in 1/sr, from sin²α in [0, 1) on the side where cos α > 0: exp(½ n log1p(−sin²α)).
template <class F>
inline F phong_lobe_pdf(const F& exponent, const F& sin_squared) {
  using T = scalar_t<F>;
  const F scale = (exponent + F(T(1))) * F(T(0.5) * std::numbers::inv_pi_v<T>);
  return scale * exp(F(T(0.5)) * exponent * log1p(-sin_squared));
}

/// An angle drawn from the lobe's density.
template <class F>
struct PhongAngle {
  F sin, cos, one_minus_cos;
};

/// cos α = (1 − u)^(1/(n+1)) for u in [0, 1): with l = log(1 − u)/(n+1), sin α = √(−expm1(2l)) and 1 − cos α =
/// −expm1(l).
template <class F>
inline PhongAngle<F> sample_phong_angle(const F& exponent, const F& u) {
  using T = scalar_t<F>;
  const F log_cos = log1p(-u) / (exponent + F(T(1)));
  const F one_minus_cos = -expm1(log_cos);
  return {sqrt(-expm1(log_cos + log_cos)), F(T(1)) - one_minus_cos, one_minus_cos};
}

}  // namespace halfslope
