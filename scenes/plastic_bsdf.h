// A diffuse ground under a clear coat, smooth and rough (Mitsuba's plastic and roughplastic).
//
// With t the coat's transmittance, f = specular reflection at the coat + t(w_o) t(w_i) ρ / (π (divisor − tint ρ)):
// divisor and tint (scenes/material_data.h) sum the light that the coat sends back to the ground again and again.
#pragma once

#include <numbers>

#include "scenes/bsdf_values.h"
#include "scenes/fresnel.h"
#include "scenes/material_data.h"
#include "scenes/microfacet.h"
#include "scenes/rough_transmittance.h"
#include "scenes/warp.h"

namespace halfslope {

/// The ground and the choice between it and the coat.
template <class F, int C>
class CoatedGround {
 public:
  using T = scalar_t<F>;
  template <class Get>
  explicit CoatedGround(const Get& get) : share_(get(&MaterialData<T>::specular_share)) {
    const F divisor = get(&MaterialData<T>::diffuse_divisor), tint = get(&MaterialData<T>::diffuse_tint);
    get(&MaterialData<T>::reflectance, albedo_);
    get(&MaterialData<T>::specular, specular_);
    for (int c = 0; c < C; ++c) albedo_[c] = albedo_[c] / (divisor - tint * albedo_[c]);
  }

  struct Choice {
    F specular, diffuse;  ///< probabilities of reflection at the coat and of the ground: neither is 1 minus the other
  };
  /// Where the coat reflects `reflected` and lets `transmitted` through.
  Choice choose(const F& reflected, const F& transmitted) const {
    const F zero(T(0)), specular = reflected * share_, diffuse = transmitted * (F(T(1)) - share_);
    const F sum = specular + diffuse;
    // Quotients, so that a lobe that stands alone has exactly 1.
    return {select(sum > zero, specular / sum, zero), select(sum > zero, diffuse / sum, zero)};
  }
  /// Of the ground, with neither way's transmittance.
  const F& albedo(int c) const { return albedo_[c]; }
  const F& specular(int c) const { return specular_[c]; }

 private:
  F share_, albedo_[C], specular_[C];
};

/// The coat is a delta lobe.
template <class F, int C>
class PlasticBsdf {
 public:
  using T = scalar_t<F>;
  static constexpr bool kChooses = true, kContinuous = true;

  template <class Get>
  explicit PlasticBsdf(const Get& get) : ground_(get), ior_(get(&MaterialData<T>::ior)) {}

  BsdfValue<F, C> evaluate(const Vec<F>& wo, const Vec<F>& wi) const {
    const F cosine_pdf = wi.z * F(std::numbers::inv_pi_v<T>);
    const DielectricFresnel<F> out = fresnel(wo), in = fresnel(wi);
    const F through = out.transmitted * in.transmitted * cosine_pdf;
    BsdfValue<F, C> value;
    for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = ground_.albedo(c) * through;
    value.pdf = ground_.choose(out.reflected, out.transmitted).diffuse * cosine_pdf;
    return value_where(both_in_front(wo, wi), value);
  }

  BsdfSample<F, C> sample(const Vec<F>& wo, const F& u_lobe, const F& u1, const F& u2) const {
    const F one(T(1)), zero(T(0));
    const DielectricFresnel<F> out = fresnel(wo);
    const auto choice = ground_.choose(out.reflected, out.transmitted);
    BsdfSample<F, C> sample;
    sample.delta = u_lobe < choice.specular;
    const Vec<F> down = cosine_hemisphere(u1, u2);
    sample.wi = select_vec(sample.delta, Vec<F>{-wo.x, -wo.y, wo.z}, down);
    const F coat = out.reflected / choice.specular,
            ground = out.transmitted * fresnel(down).transmitted / choice.diffuse;
    for (int c = 0; c < C; ++c) {
      sample.weight[c] = select(sample.delta, ground_.specular(c) * coat, ground_.albedo(c) * ground);
    }
    sample.pdf = select(sample.delta, choice.specular, choice.diffuse * (down.z * F(std::numbers::inv_pi_v<T>)));
    sample.eta = one;
    return sample_where(wo.z > zero, sample);
  }

 private:
  DielectricFresnel<F> fresnel(const Vec<F>& w) const {
    return fresnel_dielectric(min(max(w.z, F(T(0))), F(T(1))), ior_);
  }

  CoatedGround<F, C> ground_;
  F ior_;
};

/// The coat reflects by microfacets; what it does not reflect is let through.
template <class F, int C, template <class> class Distribution>
class RoughPlasticBsdf {
 public:
  using T = scalar_t<F>;
  static constexpr bool kChooses = true, kContinuous = true;

  template <class Get>
  explicit RoughPlasticBsdf(const Get& get)
      : ground_(get),
        transmittance_(get),
        ior_(get(&MaterialData<T>::ior)),
        distribution_(get(&MaterialData<T>::alpha_u), get(&MaterialData<T>::alpha_v)) {}

  BsdfValue<F, C> evaluate(const Vec<F>& wo, const Vec<F>& wi) const { return evaluate(wo, wi, transmittance_(wo.z)); }

  BsdfSample<F, C> sample(const Vec<F>& wo, const F& u_lobe, const F& u1, const F& u2) const {
    const F through = transmittance_(wo.z);
    const auto specular = u_lobe < ground_.choose(F(T(1)) - through, through).specular;
    const Vec<F> coat = mirror(wo, distribution_.sample_visible_normal(wo, u1, u2));
    const Vec<F> wi = select_vec(specular, coat, cosine_hemisphere(u1, u2));
    return sample_of(wi, evaluate(wo, wi, through));
  }

 private:
  BsdfValue<F, C> evaluate(const Vec<F>& wo, const Vec<F>& wi, const F& through_o) const {
    const F one(T(1)), cosine_pdf = wi.z * F(std::numbers::inv_pi_v<T>);
    const MicrofacetReflection<F> r = microfacet_reflection(distribution_, wo, wi);
    const F coat = r.cosine_bsdf * fresnel_dielectric(r.cos_microfacet, ior_).reflected;
    const F ground = through_o * transmittance_(wi.z) * cosine_pdf;
    const auto choice = ground_.choose(one - through_o, through_o);
    BsdfValue<F, C> value;
    for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = fma(ground_.specular(c), coat, ground_.albedo(c) * ground);
    value.pdf = fma(choice.specular, r.pdf, choice.diffuse * cosine_pdf);
    return value_where(both_in_front(wo, wi), value);
  }

  CoatedGround<F, C> ground_;
  RoughTransmittance<F> transmittance_;
  F ior_;
  Distribution<F> distribution_;
};

template <class F, int C>
using GgxPlasticBsdf = RoughPlasticBsdf<F, C, GgxDistribution>;
template <class F, int C>
using BeckmannPlasticBsdf = RoughPlasticBsdf<F, C, BeckmannDistribution>;

}  // namespace halfslope
