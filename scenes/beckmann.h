// The Beckmann microfacet distribution: slopes are Gaussian. In the local frame whose z axis is the surface normal.
//
// Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007 (D; Λ is the
// exact one, with erf, not their rational fit); Heitz & d'Eon, "Importance Sampling Microfacet-Based BSDFs using the
// Distribution of Visible Normals", CGF 33(4), 2014.
//
// α is the roughness, in (0, 1]; directions are unit length where nothing else is said.
#pragma once

#include <initializer_list>
#include <numbers>
#include <type_traits>

#include "core/packet.h"
#include "scenes/vec.h"

namespace halfslope {

namespace beckmann {

/// exp(−x) for x ≥ 0; 0 where that is denormal, and where x is ∞ or NaN.
template <class F>
inline F decay(const F& x) {
  using T = scalar_t<F>;
  const F most(std::is_same_v<T, float> ? T(87) : T(708));
  return select(x < most, exp(-min(x, most)), F(T(0)));
}

}  // namespace beckmann

/// D in 1/sr, from the cosine of the microfacet normal, in [0, 1]: exp(−tan²/α²) / (π α² c⁴), with sin² = (1 − c)(1 +
/// c). A c rounded to the last bit moves a narrow D visibly; where the vector is at hand, use the overload.
template <class F>
inline F beckmann_d(const F& alpha, const F& cos_h) {
  using T = scalar_t<F>;
  const F one(T(1)), c2 = cos_h * cos_h, ca = cos_h * alpha;
  const F d = beckmann::decay((one - cos_h) * (one + cos_h) / (ca * ca));
  const F inverse = one / (alpha * c2);
  return select(d > F(T(0)), d * inverse * inverse * F(std::numbers::inv_pi_v<T>), d);
}

/// D in 1/sr of the normal along h, of any length but 0, with a roughness for each tangent:
/// exp(−(h_x²/α_u² + h_y²/α_v²) / h_z²) |h|⁴ / (π α_u α_v h_z⁴).
template <class F>
inline F beckmann_d(const F& alpha_u, const F& alpha_v, const Vec<F>& h) {
  using T = scalar_t<F>;
  const F one(T(1)), zero(T(0)), inv_z = one / h.z;
  const F tan_x = h.x * inv_z, tan_y = h.y * inv_z, slope_x = tan_x / alpha_u, slope_y = tan_y / alpha_v;
  const F d = beckmann::decay(fma(slope_x, slope_x, slope_y * slope_y));
  const F inv_cos2 = fma(tan_x, tan_x, fma(tan_y, tan_y, one));
  return select(d > zero, d * inv_cos2 * inv_cos2 / (alpha_u * alpha_v) * F(std::numbers::inv_pi_v<T>), zero);
}

/// L = c (1 + 2Λ) of a direction w with c = w_z ≥ 0 and s = √(α_u² w_x² + α_v² w_y²) (scenes/microfacet.h). With a =
/// c/s, Λ = ½ (exp(−a²)/(a√π) − erfc a), so L = c erf a + s exp(−a²)/√π: neither 0/0 nor ∞ − ∞ at any angle.
template <class F>
inline F beckmann_projected_length(const F& s, const F& c) {
  using T = scalar_t<F>;
  const F a = min(c / s, F(T(10)));  // beyond 10 both terms are what they are at 10
  return fma(c, erf(a), s * exp(-(a * a)) * F(std::numbers::inv_sqrtpi_v<T>));
}

namespace beckmann {

/// The middle of the first step in which numbers of [0, 1) come: at 0 itself slopes are infinite.
template <class T>
inline constexpr T kLeastNumber = std::is_same_v<T, float> ? T(0x1p-25) : T(0x1p-54);

/// t with ½ (1 + erf t) = u in (0, 1): a Gaussian slope, within 3e-8 in u (M. Giles, "Approximating the erfinv
/// function", GPU Computing Gems Jade, 2011, table 5), polished to 1e-15 in binary64 by a step of Halley's.
template <class F>
inline F gaussian_slope(const F& u) {
  using T = scalar_t<F>;
  constexpr bool kSingle = std::is_same_v<T, float>;
  const F one(T(1));
  const F x = fma(F(T(2)), u, -one);
  const F w = -log(F(T(4)) * u * (one - u));
  const F centre = w - F(T(2.5)), tail = sqrt(w) - F(T(3));
  const auto polynomial = [](const F& at, std::initializer_list<T> terms) {
    F p(T(0));
    for (const T term : terms) p = fma(p, at, F(term));
    return p;
  };
  const F p = select(
      w < F(T(5)),
      polynomial(centre, {T(2.81022636e-08), T(3.43273939e-07), T(-3.5233877e-06), T(-4.39150654e-06), T(0.00021858087),
                          T(-0.00125372503), T(-0.00417768164), T(0.246640727), T(1.50140941)}),
      polynomial(tail, {T(-0.000200214257), T(0.000100950558), T(0.00134934322), T(-0.00367342844), T(0.00573950773),
                        T(-0.0076224613), T(0.00943887047), T(1.00167406), T(2.83297682)}));
  F t = p * x;
  if constexpr (!kSingle) {
    const F density = exp(-(t * t)) * F(T(2) * std::numbers::inv_sqrtpi_v<T>);
    const F newton = (erf(t) - x) / density;
    const F halley = newton / fma(t, newton, one);
    // In the last 1e-13 of u erf has no digits left to steer by.
    const F limit(T(0.25));
    t = t - max(min(halley, limit), -limit);
  }
  return t;
}

/// The slope t towards w, from the density ∝ (c + s t)⁺ exp(−t²) of the visible normals of roughness 1 (Heitz & d'Eon
/// 2014, eq. 15), w at cosine c ≥ 0 and sine s ≥ 0 to the normal, u in (0, 1).
///
/// With a = c/s, the integral from −a to t is ½√π f(t), f = c (erf t + erf a) + s (exp(−a²) − exp(−t²))/√π, and f(t) =
/// u f(∞) is solved by Halley's method, from between the answers at normal incidence (a Gaussian) and at grazing
/// incidence (√−ln(1 − u)). f' ∝ (c + s t) exp(−t²) lies between s (t + a) exp(−a²) and s (t + a) for |t| ≤ a, which
/// bounds t from both sides and keeps the method off its bad spot t = −a. What is left is below 5e-7 in u in binary32
/// and 1e-14 in binary64.
template <class F>
inline F visible_slope(const F& c, const F& s, const F& u) {
  using T = scalar_t<F>;
  constexpr bool kSingle = std::is_same_v<T, float>;
  const F zero(T(0)), one(T(1)), half(T(0.5)), two(T(2)), limit(T(0.25)), inv_sqrtpi(std::numbers::inv_sqrtpi_v<T>);
  const F top(kSingle ? T(4.2) : T(6.2));  // beyond the last u
  const F a = min(c / s, F(T(10)));
  const F start = fma(s, exp(-(a * a)) * inv_sqrtpi, c * erf(a));  // f(t) + what of it depends on t
  const F goal = u * (c + start);
  const F least = sqrt(goal / max(s * inv_sqrtpi, F(T(1e-30)))) - a;
  const F most = sqrt(goal / max(s * exp(-(a * a)) * inv_sqrtpi, F(T(1e-30)))) - a;
  const F low = select(a < F(T(4)), min(least, top), -a);
  const F high = select(most < a, max(low, most), top);
  const F grazing = s / (c + s);
  F t = fma(grazing, sqrt(-log1p(-u)), (one - grazing) * gaussian_slope(u));
  t = min(max(t, low), high);
  for (int k = 0; k < (kSingle ? 3 : 4); ++k) {
    const F density = exp(-(t * t)) * inv_sqrtpi, visible = fma(s, t, c);
    const F f = fma(c, erf(t), fma(-s, density, start)) - goal;
    const F newton = f / (two * density * visible);
    const F halley = newton / min(max(one - newton * (half * s / visible - t), half), two);
    // At either end f' may be 0, or f nothing but rounding.
    const F step = select(visible > zero, max(min(min(halley, limit), F(T(0.75)) * (t + a)), -limit), zero);
    t = min(max(t - step, low), high);
  }
  return t;
}

}  // namespace beckmann

/// Draws m, |m| = 1 and m_z > 0, from the visible normals' density of w, w_z ≥ 0, with u₁, u₂ in [0, 1): w is stretched
/// by the roughness, a slope is drawn towards it and one across, and both are stretched back.
template <class F>
inline Vec<F> sample_beckmann_visible_normal(const F& alpha_u, const F& alpha_v, const Vec<F>& w, const F& u1,
                                             const F& u2) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  const F x = alpha_u * w.x, y = alpha_v * w.y;
  const F flat = sqrt(fma(x, x, y * y)), inverse = one / sqrt(fma(w.z, w.z, flat * flat));
  const auto tilted = flat > zero;
  const F cos_phi = select(tilted, x / flat, one), sin_phi = select(tilted, y / flat, zero);
  const F least(beckmann::kLeastNumber<T>);
  const F towards = beckmann::visible_slope(w.z * inverse, flat * inverse, max(u1, least));
  const F across = beckmann::gaussian_slope(max(u2, least));
  return normalise(Vec<F>{alpha_u * fma(towards, cos_phi, -(across * sin_phi)),
                          alpha_v * fma(towards, sin_phi, across * cos_phi), one});
}

}  // namespace halfslope
