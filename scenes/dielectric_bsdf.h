// Glass with a smooth surface.
#pragma once

#include "scenes/bsdf_values.h"
#include "scenes/fresnel.h"
#include "scenes/material_data.h"

namespace halfslope {

/// Index of the side opposite to w over that of w's own.
template <class F>
inline F index_across(const F& cos_w, const F& ior) {
  using T = scalar_t<F>;
  return select(cos_w > F(T(0)), ior, F(T(1)) / ior);
}

/// Reflects with probability F, else refracts. Radiance that crosses the surface is divided by the square of the
/// relative index (Veach's thesis, 1997, §5.2).
template <class F, int C>
class DielectricBsdf {
 public:
  using T = scalar_t<F>;
  static constexpr bool kChooses = true, kContinuous = false;

  template <class Get>
  explicit DielectricBsdf(const Get& get) : ior_(get(&MaterialData<T>::ior)) {
    get(&MaterialData<T>::specular, specular_);
    get(&MaterialData<T>::transmittance, transmittance_);
  }

  BsdfValue<F, C> evaluate(const Vec<F>& /*wo*/, const Vec<F>& /*wi*/) const {
    const F zero(T(0));
    BsdfValue<F, C> value;
    for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = zero;
    value.pdf = zero;
    return value;
  }

  BsdfSample<F, C> sample(const Vec<F>& wo, const F& u_lobe, const F& /*u1*/, const F& /*u2*/) const {
    const F zero(T(0)), one(T(1));
    const F index = index_across(wo.z, ior_), inverse = one / index;
    const DielectricFresnel<F> fresnel = fresnel_dielectric(min(abs(wo.z), one), index);
    const auto reflects = u_lobe < fresnel.reflected;
    const F across = select(wo.z > zero, -fresnel.cos_transmitted, fresnel.cos_transmitted);
    BsdfSample<F, C> sample;
    sample.wi = select_vec(reflects, Vec<F>{-wo.x, -wo.y, wo.z}, Vec<F>{-wo.x * inverse, -wo.y * inverse, across});
    for (int c = 0; c < C; ++c) {
      sample.weight[c] = select(reflects, specular_[c], transmittance_[c] * (inverse * inverse));
    }
    sample.pdf = select(reflects, fresnel.reflected, fresnel.transmitted);
    sample.eta = select(reflects, one, index);
    sample.delta = zero < one;
    return sample_where(wo.z != zero, sample);
  }

 private:
  F ior_, specular_[C], transmittance_[C];
};

}  // namespace halfslope
