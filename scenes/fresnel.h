// Fresnel's equations between dielectrics, averaged over polarisations. (Conductors: scenes/ggx.h.)
//
// With c the cosine on the near side, in [0, 1], and n the far side's index over the near side's, let e = n² − 1 =
// (n − 1)(n + 1) and g = √(c² + e) = n cos θ_t, which loses nothing near n = 1. Then (Born & Wolf, "Principles of
// Optics", §1.5) R_s = ((c − g)/(c + g))², R_p = ((n²c − g)/(n²c + g))², and c² − g² = −e clears both numerators:
//   R_s = (e / (c + g)²)²,   R_p = (e (c(c + g) − 1) / ((c + g)(n²c + g)))²,
//   1 − R_s = 4cg / (c + g)²,   1 − R_p = 4n²cg / (n²c + g)²:
// small R keep their digits near n = 1, and small 1 − R near grazing incidence.
#pragma once

#include "core/packet.h"

namespace halfslope {

template <class F>
struct DielectricFresnel {
  F reflected;        ///< F; 1 where g² ≤ 0: total internal reflection
  F transmitted;      ///< 1 − F; 0 there
  F cos_transmitted;  ///< g / n
  F bend;  ///< cos θ_o / n − cos θ_t = −e / ((c + g) n): ω_t = −ω_o/n + bend m, with m the normal on ω_o's side
};

/// c in [0, 1], n > 0.
template <class F>
inline DielectricFresnel<F> fresnel_dielectric(const F& cos_theta, const F& index) {
  using T = scalar_t<F>;
  const F one(T(1)), zero(T(0)), c = cos_theta;
  const F e = (index - one) * (index + one), g2 = fma(c, c, e);
  const F g = sqrt(max(g2, zero)), sum = c + g, sum_p = fma(index * index, c, g);
  // 0/0 is grazing incidence on matched indices: no surface.
  const auto inverse = [&](const F& x) { return select(x > zero, one / x, zero); };
  const F inv_sum = inverse(sum), inv_sum_p = inverse(sum_p);
  const F s = e * inv_sum * inv_sum, p = e * fma(c, sum, -one) * inv_sum * inv_sum_p;
  const F t = F(T(2)) * c * g, ts = inv_sum, tp = index * inv_sum_p;
  const auto total = (g2 <= zero) & (index < one);
  return {select(total, one, F(T(0.5)) * fma(s, s, p * p)), select(total, zero, t * fma(ts, ts, tp * tp)), g / index,
          -e * inv_sum / index};
}

}  // namespace halfslope
