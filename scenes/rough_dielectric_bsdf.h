// Glass with a rough surface: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough
// Surfaces", EGSR 2007.
#pragma once

#include "scenes/bsdf_values.h"
#include "scenes/dielectric_bsdf.h"
#include "scenes/fresnel.h"
#include "scenes/material_data.h"
#include "scenes/microfacet.h"

namespace halfslope {

/// A visible normal m reflects with probability F(w_o·m), else refracts. With n the index across the surface,
/// h = w_o + w_i (reflection) or w_o + n w_i (refraction), m = ±h/|h|, and |h| = |w_o·m + n w_i·m| in the latter:
///   f |cos θ_i| = F D G₂ / (4 cos θ_o)                                              reflection
///   f |cos θ_i| = (1 − F) D G₁(w_o) G₁(w_i) |w_o·h| |w_i·h| / (cos θ_o |h|⁴)        refraction (Walter, eq. 21),
/// the second as radiance, divided by n². Reflection has the height-correlated G₂; directions on opposite sides are
/// masked independently, as in Walter, eq. 23.
template <class F, int C, template <class> class Distribution>
class RoughDielectricBsdf {
 public:
  using T = scalar_t<F>;
  static constexpr bool kChooses = true, kContinuous = true;

  template <class Get>
  explicit RoughDielectricBsdf(const Get& get)
      : ior_(get(&MaterialData<T>::ior)),
        distribution_(get(&MaterialData<T>::alpha_u), get(&MaterialData<T>::alpha_v)) {
    get(&MaterialData<T>::specular, specular_);
    get(&MaterialData<T>::transmittance, transmittance_);
  }

  BsdfValue<F, C> evaluate(const Vec<F>& wo, const Vec<F>& wi) const {
    const Scattering s = scatter(upright(wo, wo), upright(wo, wi), index_across(wo.z, ior_));
    BsdfValue<F, C> value;
    value.pdf = s.pdf;
    const F common = s.pdf * s.weight;
    for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = common * select(s.reflects, specular_[c], transmittance_[c]);
    return value_where(s.possible, value);
  }

  BsdfSample<F, C> sample(const Vec<F>& wo, const F& u_lobe, const F& u1, const F& u2) const {
    const F zero(T(0)), one(T(1));
    const Vec<F> o = upright(wo, wo);
    const F index = index_across(wo.z, ior_);
    const Vec<F> m = distribution_.sample_visible_normal(o, u1, u2);
    const F cosine = min(max(dot(o, m), zero), one);
    const DielectricFresnel<F> fresnel = fresnel_dielectric(cosine, index);
    const auto reflects = u_lobe < fresnel.reflected;
    const Vec<F> i = select_vec(reflects, mirror(o, m), fresnel.bend * m - (one / index) * o);
    const Scattering s = scatter(o, i, index);
    BsdfSample<F, C> sample;
    sample.wi = upright(wo, i);
    for (int c = 0; c < C; ++c) {
      sample.weight[c] = s.weight * select(reflects, specular_[c], transmittance_[c]);
    }
    sample.pdf = s.pdf;
    sample.eta = select(reflects, one, index);
    sample.delta = no_lanes<F>();
    // A reflection that ends below the surface, or a refraction that ends above it, would meet it again.
    return sample_where(s.possible & (select(reflects, i.z, -i.z) > zero), sample);
  }

 private:
  struct Scattering {
    mask_t<F> reflects, possible;
    F pdf, weight;  ///< their product is f |cos θ_i| of unit colours
  };

  /// v with wo's side as the front. Microfacets that are seen from below are those seen from above.
  static Vec<F> upright(const Vec<F>& wo, const Vec<F>& v) { return {v.x, v.y, select(wo.z > F(T(0)), v.z, -v.z)}; }

  Scattering scatter(const Vec<F>& o, const Vec<F>& i, const F& index) const {
    const F zero(T(0)), one(T(1)), two(T(2)), half(T(0.5));
    const auto reflects = i.z > zero;
    const Vec<F> h = o + select(reflects, one, index) * i;
    const F h2 = dot(h, h), inv_h2 = one / h2, oh = dot(o, h), ih = dot(i, h);
    const F cosine = min(abs(oh) * sqrt(inv_h2), one);
    const DielectricFresnel<F> fresnel = fresnel_dielectric(cosine, index);
    const F cos_i = abs(i.z), d = distribution_.d(h);
    const F l_o = distribution_.projected_length(o), l_i = distribution_.projected_length({i.x, i.y, cos_i});
    const F visible = o.z + l_o;
    const F reflection_pdf = fresnel.reflected * half,
            refraction_pdf = fresnel.transmitted * two * abs(oh * ih) * inv_h2 * inv_h2 * (index * index);
    Scattering s;
    s.reflects = reflects;
    s.pdf = d * select(reflects, reflection_pdf, refraction_pdf) / visible;
    s.weight =
        select(reflects, cos_i * visible / fma(o.z, l_i, cos_i * l_o), two * cos_i / ((cos_i + l_i) * (index * index)));
    // Each direction sees the front of m on its own side.
    const auto sees = (oh * h.z > zero) & (oh * ih < zero);
    s.possible = (o.z > zero) & (i.z != zero) & (reflects | sees) & (s.pdf > zero);
    return s;
  }

  F ior_;
  Distribution<F> distribution_;
  F specular_[C], transmittance_[C];
};

template <class F, int C>
using GgxDielectricBsdf = RoughDielectricBsdf<F, C, GgxDistribution>;
template <class F, int C>
using BeckmannDielectricBsdf = RoughDielectricBsdf<F, C, BeckmannDistribution>;

}  // namespace halfslope
