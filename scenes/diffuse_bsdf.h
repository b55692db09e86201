#pragma once

#include <numbers>

#include "scenes/bsdf_values.h"
#include "scenes/material_data.h"
#include "scenes/warp.h"

namespace halfslope {

/// f = ρ/π; drawn by the cosine.
template <class F, int C>
class DiffuseBsdf {
 public:
  using T = scalar_t<F>;
  static constexpr bool kChooses = false, kContinuous = true;

  template <class Get>
  explicit DiffuseBsdf(const Get& get) {
    get(&MaterialData<T>::reflectance, reflectance_);
  }

  BsdfValue<F, C> evaluate(const Vec<F>& wo, const Vec<F>& wi) const {
    BsdfValue<F, C> value;
    value.pdf = wi.z * F(std::numbers::inv_pi_v<T>);
    for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = reflectance_[c] * value.pdf;
    return value_where(both_in_front(wo, wi), value);
  }

  BsdfSample<F, C> sample(const Vec<F>& wo, const F& /*u_lobe*/, const F& u1, const F& u2) const {
    const Vec<F> wi = cosine_hemisphere(u1, u2);
    BsdfSample<F, C> sample{wi, {}, wi.z * F(std::numbers::inv_pi_v<T>), F(T(1)), no_lanes<F>()};
    for (int c = 0; c < C; ++c) sample.weight[c] = reflectance_[c];
    return sample_where(wo.z > F(T(0)), sample);
  }

 private:
  F reflectance_[C];
};

}  // namespace halfslope
