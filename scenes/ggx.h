// The GGX microfacet distribution (isotropic but for sampling; scenes/microfacet.h has D and masking for two
// roughnesses), in the local frame whose z axis is the surface normal.
//
// Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007 (D and G₁);
// Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014 (visible normals,
// the height-correlated G₂); Dupuy & Benyoub, "Sampling Visible GGX Normals with Spherical Caps", CGF 42(8), 2023.
//
// α is the roughness, in (0, 1]; directions are unit length. cos² + α² sin² appears everywhere, and 1 − c²(1 − α²)
// loses all of it where α is small: each function writes the form that keeps it.
#pragma once

#include <numbers>

#include "core/packet.h"
#include "scenes/vec.h"

namespace halfslope {

/// D in 1/sr, from the cosine of the microfacet normal, in [0, 1]: α² / (π den²), den = (cα)² + (1 − c)(1 + c).
/// A c rounded to the last bit moves a narrow D visibly; where the vector is at hand, use the overload.
template <class F>
inline F ggx_d(const F& alpha, const F& cos_h) {
  using T = scalar_t<F>;
  const F one(T(1)), ca = cos_h * alpha;
  const F ratio = alpha / fma(ca, ca, (one - cos_h) * (one + cos_h));
  return ratio * ratio * F(std::numbers::inv_pi_v<T>);
}

/// D in 1/sr, from the microfacet normal h, |h| = 1: sin² is h_x² + h_y², exact however close h is to the normal.
template <class F>
inline F ggx_d(const F& alpha, const Vec<F>& h) {
  const F za = h.z * alpha;
  const F ratio = alpha / fma(za, za, fma(h.x, h.x, h.y * h.y));
  return ratio * ratio * F(std::numbers::inv_pi_v<scalar_t<F>>);
}

/// √(c² + α² s²) = √(α² + (1 − α²) c²), s² = 1 − c²; both terms are positive.
template <class F>
inline F ggx_projected_length(const F& alpha, const F& cos_theta) {
  const F one(scalar_t<F>(1));
  return sqrt(fma((one - alpha) * (one + alpha) * cos_theta, cos_theta, alpha * alpha));
}

/// Smith's Λ for a direction with that cosine in [0, 1]; ∞ at 0. With x = α² tan²θ,
/// Λ = (√(1 + x) − 1)/2 = x / (2(1 + √(1 + x))); and both ends of that fraction times c², because tan² overflows:
/// Λ = α² s² / (2c (c + √(c² + α² s²))).
template <class F>
inline F ggx_lambda(const F& alpha, const F& cos_theta) {
  using T = scalar_t<F>;
  const F one(T(1));
  const F alpha_sin_squared = alpha * alpha * ((one - cos_theta) * (one + cos_theta));
  const F root = sqrt(fma(cos_theta, cos_theta, alpha_sin_squared));
  return alpha_sin_squared / (F(T(2)) * cos_theta * (cos_theta + root));
}

/// G₁ / cos θ with G₁ = 1/(1 + Λ), for a cosine in [0, 1]. One fraction, so that cos θ = 0 gives 2/α, not 0/0:
/// G₁ = 2c / (c + √(c² + α² s²)).
template <class F>
inline F ggx_g1_over_cos(const F& alpha, const F& cos_theta) {
  return F(scalar_t<F>(2)) / (cos_theta + ggx_projected_length(alpha, cos_theta));
}

/// G₂ / (4 cos_i cos_o), with the height-correlated G₂ = 1/(1 + Λ_i + Λ_o) (Heitz 2014, eq. 99), for cosines in
/// [0, 1]. 1 + 2Λ = √(c² + α² s²)/c, so the fraction clears to
/// 0.5 / (c_o √(c_i² + α² s_i²) + c_i √(c_o² + α² s_o²)). f_r = F · D · this. Symmetric bit for bit.
template <class F>
inline F ggx_visibility(const F& alpha, const F& cos_i, const F& cos_o) {
  const F i = cos_o * ggx_projected_length(alpha, cos_i), o = cos_i * ggx_projected_length(alpha, cos_o);
  return F(scalar_t<F>(0.5)) / (i + o);
}

/// The density in 1/sr of microfacet normals h as seen from w: D_w(h) = G₁(w)/cos θ_w · max(0, w·h) · D(h) (Heitz 2014,
/// eq. 16), for w_z ≥ 0 and h_z ≥ 0. Integrates to 1 over the hemisphere of h.
template <class F>
inline F ggx_visible_normal_pdf(const F& alpha, const Vec<F>& w, const Vec<F>& h) {
  return ggx_g1_over_cos(alpha, w.z) * max(dot(w, h), F(scalar_t<F>(0))) * ggx_d(alpha, h);
}

/// The density in 1/sr of the direction o = 2(w·h)h − w, with h drawn by sample_ggx_visible_normal: D_w(h) / (4 w·h),
/// where w·h cancels. `cos_w` = w_z ≥ 0. Directions with o_z < 0 have it too: some of the mass goes below the horizon.
template <class F>
inline F ggx_reflection_pdf_solid_angle(const F& alpha, const F& cos_w, const Vec<F>& h) {
  return F(scalar_t<F>(0.25)) * ggx_g1_over_cos(alpha, cos_w) * ggx_d(alpha, h);
}

/// Draws h from ggx_visible_normal_pdf(alpha, w, ·) with u₁, u₂ in [0, 1), w_z ≥ 0; |h| = 1, h_z > 0.
///
/// Stretching by diag(α, α, 1) makes the microsurface a hemisphere (α = 1, D = 1/π), and maps w to v = (αw_x, αw_y,
/// w_z) normalised. There D_v(h) = 2 (v·h)⁺ / (π (1 + v_z)). Mirror v about h: o = 2(v·h)h − v has the density D_v(h) /
/// (4 v·h) = 1 / (2π (1 + v_z)), a constant. So o is uniform on the spherical cap o_z ≥ −v_z, whose solid angle is 2π(1
/// + v_z) — and h_z ≥ 0 exactly there, for h = (o + v)/|o + v|. A uniform cap has a uniform height: o_z = 1 − u₂(1 +
/// v_z), with the azimuth 2πu₁. Then o_z + v_z = (1 − u₂)(1 + v_z) and, for the radius of o's circle, 1 − o_z = u₂(1 +
/// v_z): neither cancels. Normals go back by the inverse transpose, again diag(α, α, 1) up to scale. A roughness for
/// each tangent stretches each by its own.
template <class F>
inline Vec<F> sample_ggx_visible_normal(const F& alpha_u, const F& alpha_v, const Vec<F>& w, const F& u1, const F& u2) {
  using T = scalar_t<F>;
  const F one(T(1)), zero(T(0));
  const Vec<F> v = normalise(Vec<F>{alpha_u * w.x, alpha_v * w.y, w.z});
  const F cap_height = one + v.z;
  const F one_minus_z = u2 * cap_height;
  const F radius = sqrt(one_minus_z * max(F(T(2)) - one_minus_z, zero));
  const auto azimuth = sin_cos_2pi(u1);
  return normalise(Vec<F>{alpha_u * fma(radius, azimuth.cos, v.x), alpha_v * fma(radius, azimuth.sin, v.y),
                          (one - u2) * cap_height});
}
template <class F>
inline Vec<F> sample_ggx_visible_normal(const F& alpha, const Vec<F>& w, const F& u1, const F& u2) {
  return sample_ggx_visible_normal(alpha, alpha, w, u1, u2);
}

/// The Fresnel reflectance, averaged over polarisations, of a conductor with relative index η + ik seen under a cosine
/// c in [0, 1]; η, k ≥ 0. In [0, 1].
///
/// With a + ib = √((η + ik)² − s²), s² = 1 − c² (Born & Wolf, "Principles of Optics", §14.2),
///   R_s = |c − (a + ib)|² / |c + (a + ib)|² = ((a − c)² + b²) / ((a + c)² + b²),
///   R_p = R_s · ((ac − s²)² + b²c²) / ((ac + s²)² + b²c²),
/// sums of squares all. Of a and b the larger comes from the square root and the other from ab = ηk.
template <class F>
inline F fresnel_conductor(const F& cos_theta, const F& eta, const F& k) {
  using T = scalar_t<F>;
  const F one(T(1)), zero(T(0)), half(T(0.5)), c = cos_theta;
  const F s2 = (one - c) * (one + c), eta_k = eta * k;
  const F real = (eta - k) * (eta + k) - s2;  // of (η + ik)² − s²; the imaginary part is 2ηk
  const F modulus = sqrt(fma(real, real, F(T(4)) * eta_k * eta_k));
  const F larger = sqrt(half * (modulus + abs(real)));
  const F smaller = select(larger > zero, eta_k / larger, zero);
  const F a = select(real >= zero, larger, smaller), b = select(real >= zero, smaller, larger);
  const auto ratio = [&](const F& minus, const F& plus, const F& b2) {
    const F below = fma(plus, plus, b2);
    // 0/0 is grazing incidence on matched indices, where the limit from every other index is total reflection.
    return select(below > zero, fma(minus, minus, b2) / below, one);
  };
  const F r_s = ratio(a - c, a + c, b * b);
  const F bc = b * c;
  return half * r_s * (one + ratio(fma(a, c, -s2), fma(a, c, s2), bc * bc));
}

}  // namespace halfslope
