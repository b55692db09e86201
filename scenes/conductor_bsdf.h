// Metals, smooth and rough.
#pragma once

#include "scenes/bsdf_values.h"
#include "scenes/ggx.h"
#include "scenes/material_data.h"
#include "scenes/microfacet.h"

namespace halfslope {

/// The reflectance ρ F per channel.
template <class F, int C>
class ConductorReflectance {
 public:
  using T = scalar_t<F>;
  template <class Get>
  explicit ConductorReflectance(const Get& get) {
    get(&MaterialData<T>::reflectance, reflectance_);
    get(&MaterialData<T>::eta, eta_);
    get(&MaterialData<T>::k, k_);
    for (int c = 0; c < C; ++c) coloured_ = coloured_ || any_lane(eta_[c] > F(T(0)));
  }
  /// Multiplies each channel of `values` by it, for a cosine in [0, 1].
  void tint(const F& cos_theta, F* values) const {
    for (int c = 0; c < C; ++c) values[c] = values[c] * reflectance_[c];
    // Where η = 0, F is 1 to the bit: a packet in which it is 0 everywhere need not be told.
    if (!coloured_) return;
    for (int c = 0; c < C; ++c) values[c] = values[c] * fresnel_conductor(cos_theta, eta_[c], k_[c]);
  }

 private:
  F reflectance_[C], eta_[C], k_[C];
  bool coloured_ = false;
};

/// A mirror.
template <class F, int C>
class ConductorBsdf {
 public:
  using T = scalar_t<F>;
  static constexpr bool kChooses = false, kContinuous = false;

  template <class Get>
  explicit ConductorBsdf(const Get& get) : reflectance_(get) {}

  BsdfValue<F, C> evaluate(const Vec<F>& /*wo*/, const Vec<F>& /*wi*/) const {
    const F zero(T(0));
    BsdfValue<F, C> value;
    for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = zero;
    value.pdf = zero;
    return value;
  }

  BsdfSample<F, C> sample(const Vec<F>& wo, const F& /*u_lobe*/, const F& /*u1*/, const F& /*u2*/) const {
    const F zero(T(0)), one(T(1));
    BsdfSample<F, C> sample{{-wo.x, -wo.y, wo.z}, {}, one, one, zero < one};
    for (int c = 0; c < C; ++c) sample.weight[c] = one;
    reflectance_.tint(wo.z, sample.weight);
    return sample_where(wo.z > zero, sample);
  }

 private:
  ConductorReflectance<F, C> reflectance_;
};

/// f = ρ F D G₂ / (4 cos θ_i cos θ_o), drawn by visible normals.
template <class F, int C, template <class> class Distribution>
class RoughConductorBsdf {
 public:
  using T = scalar_t<F>;
  static constexpr bool kChooses = false, kContinuous = true;

  template <class Get>
  explicit RoughConductorBsdf(const Get& get)
      : reflectance_(get), distribution_(get(&MaterialData<T>::alpha_u), get(&MaterialData<T>::alpha_v)) {}

  BsdfValue<F, C> evaluate(const Vec<F>& wo, const Vec<F>& wi) const {
    const MicrofacetReflection<F> r = microfacet_reflection(distribution_, wo, wi);
    BsdfValue<F, C> value;
    for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = r.cosine_bsdf;
    value.pdf = r.pdf;
    reflectance_.tint(r.cos_microfacet, value.cosine_bsdf);
    return value_where(both_in_front(wo, wi), value);
  }

  BsdfSample<F, C> sample(const Vec<F>& wo, const F& /*u_lobe*/, const F& u1, const F& u2) const {
    const Vec<F> wi = mirror(wo, distribution_.sample_visible_normal(wo, u1, u2));
    const MicrofacetReflection<F> r = microfacet_reflection(distribution_, wo, wi);
    BsdfSample<F, C> sample{wi, {}, r.pdf, F(T(1)), no_lanes<F>()};
    for (int c = 0; c < C; ++c) sample.weight[c] = r.weight;
    reflectance_.tint(r.cos_microfacet, sample.weight);
    return sample_where(both_in_front(wo, wi) & (r.pdf > F(T(0))), sample);
  }

 private:
  ConductorReflectance<F, C> reflectance_;
  Distribution<F> distribution_;
};

template <class F, int C>
using GgxConductorBsdf = RoughConductorBsdf<F, C, GgxDistribution>;
template <class F, int C>
using BeckmannConductorBsdf = RoughConductorBsdf<F, C, BeckmannDistribution>;

}  // namespace halfslope
