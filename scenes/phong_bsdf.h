#pragma once

#include <numbers>

#include "scenes/bsdf_values.h"
#include "scenes/material_data.h"
#include "scenes/phong.h"
#include "scenes/warp.h"

namespace halfslope {

/// f = k_d/π + k_s (n + 2)/(2π) cosⁿα with α the angle to w_o's mirror direction. A share of the samples is drawn about
/// that direction by (n + 1)/(2π) cosⁿα, the rest by the cosine (Mitsuba 0.6, phong.cpp).
template <class F, int C>
class PhongBsdf {
 public:
  using T = scalar_t<F>;
  static constexpr bool kChooses = true, kContinuous = true;

  template <class Get>
  explicit PhongBsdf(const Get& get)
      : exponent_(get(&MaterialData<T>::exponent)), share_(get(&MaterialData<T>::specular_share)) {
    const F inv_pi(std::numbers::inv_pi_v<T>), inv_2pi(T(0.5) * std::numbers::inv_pi_v<T>);
    get(&MaterialData<T>::reflectance, diffuse_);
    get(&MaterialData<T>::specular, lobe_);
    for (int c = 0; c < C; ++c) {
      diffuse_[c] = diffuse_[c] * inv_pi;
      lobe_[c] = lobe_[c] * (exponent_ + F(T(2))) * inv_2pi;
    }
    lobe_pdf_ = share_ * (exponent_ + F(T(1))) * inv_2pi;
    cosine_pdf_ = (F(T(1)) - share_) * inv_pi;
  }

  BsdfValue<F, C> evaluate(const Vec<F>& wo, const Vec<F>& wi) const {
    // 1 − cos α = |w_i − R|²/2, which does not cancel.
    const Vec<F> apart = wi - mirrored(wo);
    const F power = phong_cos_power(exponent_, F(T(0.5)) * dot(apart, apart));
    BsdfValue<F, C> value;
    value.pdf = fma(lobe_pdf_, power, cosine_pdf_ * wi.z);
    for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = fma(lobe_[c], power, diffuse_[c]) * wi.z;
    return value_where(both_in_front(wo, wi), value);
  }

  BsdfSample<F, C> sample(const Vec<F>& wo, const F& u_lobe, const F& u1, const F& u2) const {
    const auto specular = u_lobe < share_;
    const Vec<F> wi = select_vec(specular, about_mirror(wo, u1, u2), cosine_hemisphere(u1, u2));
    return sample_of(wi, evaluate(wo, wi));
  }

 private:
  static Vec<F> mirrored(const Vec<F>& wo) { return {-wo.x, -wo.y, wo.z}; }
  Vec<F> about_mirror(const Vec<F>& wo, const F& u1, const F& u2) const {
    // An orthonormal frame about R, which is above the horizon: T. Duff and others, "Building an Orthonormal Basis,
    // Revisited", JCGT 6(1), 2017, with a positive sign.
    const F one(T(1));
    const Vec<F> r = mirrored(wo);
    const F a = -one / (one + r.z), b = r.x * r.y * a;
    const Vec<F> tangent{fma(r.x * r.x, a, one), b, -r.x}, bitangent{b, fma(r.y * r.y, a, one), -r.y};
    const PhongAngle<F> angle = sample_phong_angle(exponent_, u1);
    const auto azimuth = sin_cos_2pi(u2);
    return angle.sin * azimuth.cos * tangent + angle.sin * azimuth.sin * bitangent + angle.cos * r;
  }

  F exponent_, share_, lobe_pdf_, cosine_pdf_;
  F diffuse_[C], lobe_[C];
};

}  // namespace halfslope
