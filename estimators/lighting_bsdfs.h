// The receiver's BSDF inside a kernel, with all that a pixel fixes worked out once. Directions are local: the normal is
// the z axis (estimators/pixel_data.h).
//
// Each class has
//   evaluate(wi)          f_r cos θ_i per channel and the density of technique `bsdf`, for wi.z > 0;
//   draw(u_lobe, u1, u2)  a direction of technique `bsdf`; below the horizon it is worth nothing;
//   weigh(wi, w, pdf)     for a direction so drawn: w = f_r cos θ_i / p per channel, and p, without what cancels.
#pragma once

#include <numbers>

#include "core/packet.h"
#include "estimators/pixel_data.h"
#include "scenes/ggx.h"
#include "scenes/phong.h"
#include "scenes/vec.h"
#include "scenes/warp.h"

namespace halfslope::kernel {

template <class F>
inline Vec<F> broadcast(const scalar_t<F>* v) {
  return {F(v[0]), F(v[1]), F(v[2])};
}

/// What a direction towards a light is worth.
template <class F>
struct Reflection {
  F cosine_brdf[3];  ///< f_r · cos θ_i, per channel
  F pdf;             ///< the BSDF technique's density of the direction
};

/// f_r = albedo/π; drawn by the cosine.
template <class F, int C>
class Diffuse {
 public:
  using T = scalar_t<F>;
  static constexpr int kChannels = C;
  explicit Diffuse(const PixelData<T>& pixel) {
    for (int c = 0; c < C; ++c) albedo_[c] = pixel.reflectance[c];
  }
  Reflection<F> evaluate(const Vec<F>& wi) const {
    Reflection<F> r;
    r.pdf = wi.z * F(std::numbers::inv_pi_v<T>);
    for (int c = 0; c < C; ++c) r.cosine_brdf[c] = F(albedo_[c]) * r.pdf;
    return r;
  }
  Vec<F> draw(const F& /*u_lobe*/, const F& u1, const F& u2) const { return cosine_hemisphere(u1, u2); }
  void weigh(const Vec<F>& wi, F* weight, F& pdf) const {
    pdf = wi.z * F(std::numbers::inv_pi_v<T>);
    for (int c = 0; c < C; ++c) weight[c] = F(albedo_[c]);
  }

 private:
  T albedo_[3];
};

/// GGX, height-correlated; drawn by visible normals (scenes/ggx.h).
template <class F, int C>
class RoughConductor {
 public:
  using T = scalar_t<F>;
  static constexpr int kChannels = C;
  explicit RoughConductor(const PixelData<T>& pixel)
      : pixel_(pixel),
        wo_(broadcast<F>(pixel.wo)),
        alpha_(pixel.alpha),
        quarter_g1_over_cos_(F(T(0.25)) * ggx_g1_over_cos(alpha_, wo_.z)),
        projected_o_(ggx_projected_length(alpha_, wo_.z)) {}

  Reflection<F> evaluate(const Vec<F>& wi) const {
    const Vec<F> h = wi + wo_;
    const F d = distribution(h);
    const F fr_cos = d * visibility(wi.z) * wi.z;
    Reflection<F> r;
    r.pdf = d * quarter_g1_over_cos_;
    fresnel(wi, h, r.cosine_brdf);
    for (int c = 0; c < C; ++c) r.cosine_brdf[c] = r.cosine_brdf[c] * fr_cos;
    return r;
  }
  Vec<F> draw(const F& /*u_lobe*/, const F& u1, const F& u2) const {
    const Vec<F> m = sample_ggx_visible_normal(alpha_, wo_, u1, u2);
    return F(T(2)) * dot(m, wo_) * m - wo_;
  }
  /// f_r cos θ / p has no D left in it.
  void weigh(const Vec<F>& wi, F* weight, F& pdf) const {
    const Vec<F> h = wi + wo_;
    pdf = distribution(h) * quarter_g1_over_cos_;
    const F common = visibility(wi.z) * wi.z / quarter_g1_over_cos_;
    fresnel(wi, h, weight);
    for (int c = 0; c < C; ++c) weight[c] = weight[c] * common;
  }

 private:
  /// D of the unnormalised half vector: with |h|² in place of 1, D = (α|h|² / ((αh_z)² + h_x² + h_y²))² / π.
  F distribution(const Vec<F>& h) const {
    const F za = alpha_ * h.z, flat = fma(h.x, h.x, h.y * h.y);
    const F ratio = alpha_ * fma(h.z, h.z, flat) / fma(za, za, flat);
    return ratio * ratio * F(std::numbers::inv_pi_v<T>);
  }
  F visibility(const F& cos_i) const {
    return F(T(0.5)) / fma(wo_.z, ggx_projected_length(alpha_, cos_i), cos_i * projected_o_);
  }
  void fresnel(const Vec<F>& wi, const Vec<F>& h, F* out) const {
    for (int c = 0; c < C; ++c) out[c] = F(pixel_.reflectance[c]);
    if (pixel_.unit_fresnel) return;
    const F cosine = min(dot(wi, h) / sqrt(dot(h, h)), F(T(1)));
    for (int c = 0; c < C; ++c) out[c] = out[c] * fresnel_conductor(cosine, F(pixel_.eta[c]), F(pixel_.k[c]));
  }

  const PixelData<T>& pixel_;
  Vec<F> wo_;
  F alpha_, quarter_g1_over_cos_, projected_o_;
};

/// f_r = k_d/π + k_s (n+2)/(2π) cosⁿα with α the angle to the mirror direction R. A share of the samples is drawn about
/// R by (n+1)/(2π) cosⁿα, the rest by the cosine (Mitsuba 0.6, phong.cpp).
template <class F, int C>
class Phong {
 public:
  using T = scalar_t<F>;
  static constexpr int kChannels = C;
  explicit Phong(const PixelData<T>& pixel)
      : pixel_(pixel),
        mirror_{F(-pixel.wo[0]), F(-pixel.wo[1]), F(pixel.wo[2])},
        exponent_(pixel.exponent),
        lobe_pdf_((pixel.exponent + 1) * T(0.5) * std::numbers::inv_pi_v<T> * pixel.specular_share),
        cosine_pdf_(std::numbers::inv_pi_v<T> * (1 - pixel.specular_share)) {
    for (int c = 0; c < C; ++c) {
      lobe_[c] = (pixel.exponent + 2) * T(0.5) * std::numbers::inv_pi_v<T> * pixel.specular[c];
      diffuse_[c] = std::numbers::inv_pi_v<T> * pixel.reflectance[c];
    }
    // An orthonormal frame about R, which is above the horizon: Duff and others (2017) with a positive sign.
    const T x = -pixel.wo[0], y = -pixel.wo[1], z = pixel.wo[2], a = -1 / (1 + z), b = x * y * a;
    tangent_ = {F(1 + x * x * a), F(b), F(-x)};
    bitangent_ = {F(b), F(1 + y * y * a), F(-y)};
  }

  Reflection<F> evaluate(const Vec<F>& wi) const {
    const F power = lobe_power(wi);
    Reflection<F> r;
    r.pdf = fma(F(lobe_pdf_), power, F(cosine_pdf_) * wi.z);
    for (int c = 0; c < C; ++c) r.cosine_brdf[c] = fma(F(lobe_[c]), power, F(diffuse_[c])) * wi.z;
    return r;
  }
  Vec<F> draw(const F& u_lobe, const F& u1, const F& u2) const {
    const T share = pixel_.specular_share;
    if (share == 0) return cosine_hemisphere(u1, u2);
    if (share == 1) return about_mirror(u1, u2);
    const auto specular = u_lobe < F(share);
    const Vec<F> lobe = about_mirror(u1, u2), cosine = cosine_hemisphere(u1, u2);
    return {select(specular, lobe.x, cosine.x), select(specular, lobe.y, cosine.y), select(specular, lobe.z, cosine.z)};
  }
  void weigh(const Vec<F>& wi, F* weight, F& pdf) const {
    const Reflection<F> r = evaluate(wi);
    pdf = r.pdf;
    // The lobe cancels where nothing else is mixed in, and there it may have underflowed.
    const bool lone = pixel_.specular_share == 1;
    for (int c = 0; c < C; ++c) weight[c] = lone ? F(lobe_[c] / lobe_pdf_) * wi.z : r.cosine_brdf[c] / pdf;
  }

 private:
  /// 1 − cos α = |ω_i − R|²/2, which does not cancel.
  F lobe_power(const Vec<F>& wi) const {
    const Vec<F> apart = wi - mirror_;
    return phong_cos_power(exponent_, F(T(0.5)) * dot(apart, apart));
  }
  Vec<F> about_mirror(const F& u1, const F& u2) const {
    const PhongAngle<F> angle = sample_phong_angle(exponent_, u1);
    const auto azimuth = sin_cos_2pi(u2);
    return angle.sin * azimuth.cos * tangent_ + angle.sin * azimuth.sin * bitangent_ + angle.cos * mirror_;
  }

  const PixelData<T>& pixel_;
  Vec<F> mirror_, tangent_, bitangent_;
  F exponent_;
  T lobe_pdf_, cosine_pdf_;
  T lobe_[3], diffuse_[3];
};

/// Runs `run(bsdf)` with the receiver's BSDF for packets of the call's number type and its channels.
template <class T, class Run>
inline void with_bsdf(const PixelData<T>& pixel, int channels, Run run) {
  using F = NativePacket<T>;
  const auto with_channels = [&]<template <class, int> class Bsdf>() {
    channels == 1 ? run(Bsdf<F, 1>(pixel)) : run(Bsdf<F, 3>(pixel));
  };
  switch (pixel.bsdf) {
    case BsdfKind::kDiffuse:
      return with_channels.template operator()<Diffuse>();
    case BsdfKind::kRoughConductor:
      return with_channels.template operator()<RoughConductor>();
    default:  // a plain scene (scenes/scene.h) has these three
      return with_channels.template operator()<Phong>();
  }
}

}  // namespace halfslope::kernel
