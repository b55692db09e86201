// What a BSDF class gives, and what all of them share.
//
// A BSDF class is a template over the number type F (core/packet.h) and the C = 1 or 3 channels, in the local frame
// whose z axis is the shading normal; `wo` is towards where light is observed, `wi` towards where it comes from, both
// of unit length, on either side. Each has
//   explicit Class(const Get& get)              from materials (scenes/material_data.h): get(&MaterialData<T>::alpha_u)
//                                               is each lane's roughness, get(&MaterialData<T>::reflectance, out) fills
//                                               the C channels of `out`, each lane's texture looked up;
//   BsdfValue<F, C> evaluate(wo, wi)
//   BsdfSample<F, C> sample(wo, u_lobe, u1, u2) numbers in [0, 1);
//   kChooses                                    whether sample reads u_lobe: there are two lobes to choose from;
//   kContinuous                                 whether evaluate can be other than 0.
// Lanes stand alone: one never changes another's bits.
#pragma once

#include "core/packet.h"
#include "scenes/vec.h"

namespace halfslope {

/// The continuous part of a BSDF for one pair of directions; delta lobes are 0 here.
template <class F, int C>
struct BsdfValue {
  F cosine_bsdf[C];  ///< f |cos θ_i|
  F pdf;             ///< of sample() in 1/sr, its choice of lobe included
};

/// A direction drawn from a BSDF. Where nothing is scattered weight and pdf are 0.
template <class F, int C>
struct BsdfSample {
  Vec<F> wi;        ///< unit length
  F weight[C];      ///< f |cos θ_i| / pdf without what cancels; of a delta lobe, its value over its probability
  F pdf;            ///< what evaluate() gives for wi, to the bit; of a delta lobe, its probability
  F eta;            ///< index on wi's side over that on wo's: radiance is divided by its square; 1 for reflection
  mask_t<F> delta;  ///< whether wi came from a delta lobe
};

template <class F>
inline Vec<F> select_vec(const mask_t<F>& mask, const Vec<F>& a, const Vec<F>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// Every lane false.
template <class F>
inline mask_t<F> no_lanes() {
  const F zero(scalar_t<F>(0));
  return zero < zero;
}

/// Both directions on the front, where one-sided BSDFs reflect.
template <class F>
inline mask_t<F> both_in_front(const Vec<F>& wo, const Vec<F>& wi) {
  const F zero(scalar_t<F>(0));
  return (wo.z > zero) & (wi.z > zero);
}

/// 0 outside `mask`.
template <class F, int C>
inline BsdfValue<F, C> value_where(const mask_t<F>& mask, BsdfValue<F, C> value) {
  const F zero(scalar_t<F>(0));
  for (int c = 0; c < C; ++c) value.cosine_bsdf[c] = select(mask, value.cosine_bsdf[c], zero);
  value.pdf = select(mask, value.pdf, zero);
  return value;
}

/// Nothing scattered outside `mask`; wi is the normal there.
template <class F, int C>
inline BsdfSample<F, C> sample_where(const mask_t<F>& mask, BsdfSample<F, C> sample) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  sample.wi = select_vec(mask, sample.wi, Vec<F>{zero, zero, one});
  for (int c = 0; c < C; ++c) sample.weight[c] = select(mask, sample.weight[c], zero);
  sample.pdf = select(mask, sample.pdf, zero);
  sample.eta = select(mask, sample.eta, one);
  sample.delta = sample.delta & mask;
  return sample;
}

/// A sample of one value() at `wi`, whose weight is simply their quotient: for mixtures, where nothing cancels.
template <class F, int C>
inline BsdfSample<F, C> sample_of(const Vec<F>& wi, const BsdfValue<F, C>& value) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  BsdfSample<F, C> sample{wi, {}, value.pdf, one, no_lanes<F>()};
  for (int c = 0; c < C; ++c) sample.weight[c] = value.cosine_bsdf[c] / value.pdf;
  return sample_where(value.pdf > zero, sample);
}

}  // namespace halfslope
