// Microfacet distributions behind one interface, so that a BSDF is written once for all.
//
// Smith's masking for any distribution: with Λ(w) for a direction w on the front, let L(w) = cos θ (1 + 2Λ), in which
// nothing is 0/0 at grazing angles. Then (Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based
// BRDFs", JCGT 3(2), 2014)
//   G₁/cos θ = 2 / (cos θ + L),                                                    G₁ = 1/(1 + Λ)
//   G₂/(4 cos θ_i cos θ_o) = ½ / (cos θ_o L_i + cos θ_i L_o),                      G₂ = 1/(1 + Λ_i + Λ_o)
// and the visible normals' density is D_w(m) = G₁/cos θ (w·m)⁺ D(m). A distribution gives D, L and a way to draw m.
#pragma once

#include <numbers>

#include "core/packet.h"
#include "scenes/beckmann.h"
#include "scenes/bsdf_values.h"
#include "scenes/ggx.h"
#include "scenes/material_data.h"

namespace halfslope {

/// GGX with a roughness for each tangent (Heitz 2014, eq. 85 and 86).
template <class F>
class GgxDistribution {
 public:
  using T = scalar_t<F>;
  static constexpr Distribution kDistribution = Distribution::kGgx;
  GgxDistribution(const F& alpha_u, const F& alpha_v)
      : alpha_u_(alpha_u),
        alpha_v_(alpha_v),
        area_(alpha_u * alpha_v),
        v_over_u_(alpha_v / alpha_u),
        u_over_v_(alpha_u / alpha_v) {}

  /// D in 1/sr of the normal along h, of any length but 0:
  /// D = 1/(π α_u α_v (m_x²/α_u² + m_y²/α_v² + m_z²)²); the bracket is multiplied by α_u α_v, which keeps its range.
  F d(const Vec<F>& h) const {
    const F squared = fma(h.z, h.z, fma(h.x, h.x, h.y * h.y));
    const F ratio = squared / fma(area_ * h.z, h.z, fma(v_over_u_ * h.x, h.x, u_over_v_ * h.y * h.y));
    return ratio * ratio * (area_ * F(std::numbers::inv_pi_v<T>));
  }
  /// L = √(z² + α_u² x² + α_v² y²), for w_z ≥ 0.
  F projected_length(const Vec<F>& w) const {
    const F x = alpha_u_ * w.x, y = alpha_v_ * w.y;
    return sqrt(fma(w.z, w.z, fma(x, x, y * y)));
  }
  /// m from D_w, for w_z ≥ 0: see sample_ggx_visible_normal.
  Vec<F> sample_visible_normal(const Vec<F>& w, const F& u1, const F& u2) const {
    return sample_ggx_visible_normal(alpha_u_, alpha_v_, w, u1, u2);
  }

 private:
  F alpha_u_, alpha_v_, area_, v_over_u_, u_over_v_;
};

/// Beckmann's, with a roughness for each tangent.
template <class F>
class BeckmannDistribution {
 public:
  using T = scalar_t<F>;
  static constexpr Distribution kDistribution = Distribution::kBeckmann;
  BeckmannDistribution(const F& alpha_u, const F& alpha_v) : alpha_u_(alpha_u), alpha_v_(alpha_v) {}

  /// D in 1/sr of the normal along h, of any length but 0.
  F d(const Vec<F>& h) const { return beckmann_d(alpha_u_, alpha_v_, h); }
  F projected_length(const Vec<F>& w) const {
    const F x = alpha_u_ * w.x, y = alpha_v_ * w.y;
    return beckmann_projected_length(sqrt(fma(x, x, y * y)), w.z);
  }
  Vec<F> sample_visible_normal(const Vec<F>& w, const F& u1, const F& u2) const {
    return sample_beckmann_visible_normal(alpha_u_, alpha_v_, w, u1, u2);
  }

 private:
  F alpha_u_, alpha_v_;
};

/// Reflection by microfacets that reflect all, between w_o and w_i on the front. Multiply by Fresnel's factor.
template <class F>
struct MicrofacetReflection {
  F cosine_bsdf;     ///< f cos θ_i
  F pdf;             ///< in 1/sr, of the mirror direction about a visible normal: D_w / (4 w·m)
  F weight;          ///< G₂/G₁(w_o), their quotient without D
  F cos_microfacet;  ///< w_o·m = |w_o + w_i|/2, at most 1
};

template <class F, template <class> class Distribution>
inline MicrofacetReflection<F> microfacet_reflection(const Distribution<F>& distribution, const Vec<F>& wo,
                                                     const Vec<F>& wi) {
  using T = scalar_t<F>;
  const F half(T(0.5));
  const Vec<F> h = wi + wo;
  const F d = distribution.d(h), l_o = distribution.projected_length(wo), l_i = distribution.projected_length(wi);
  const F both = fma(wo.z, l_i, wi.z * l_o), visible = wo.z + l_o;
  return {d * wi.z * half / both, d * half / visible, wi.z * visible / both, min(half * length(h), F(T(1)))};
}

/// The direction that a normal sends w to.
template <class F>
inline Vec<F> mirror(const Vec<F>& w, const Vec<F>& normal) {
  return F(scalar_t<F>(2)) * dot(normal, w) * normal - w;
}

}  // namespace halfslope
