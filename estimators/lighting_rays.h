// Rays from the receiver, which is the origin, inside a kernel; and what both forms of a technique write.
#pragma once

#include <limits>
#include <numbers>

#include "core/packet.h"
#include "estimators/kernels.h"
#include "estimators/lighting_bsdfs.h"
#include "scenes/measure.h"
#include "scenes/vec.h"

namespace halfslope::kernel {

template <class F>
struct ShapeHit {
  mask_t<F> hit;
  F distance, cosine;  ///< cos ψ at the surface, ≥ 0; both hold where `hit`
};

/// Where the ray from the origin along the unit vector d meets the shape at a positive distance; false, and `result`
/// not to be read, where no lane does.
template <class F>
inline bool intersect(const LocalShape<scalar_t<F>>& shape, const Vec<F>& d, ShapeHit<F>& result) {
  using T = scalar_t<F>;
  const F zero(T(0));
  const Vec<F> center = broadcast<F>(shape.center);
  if (shape.kind == ShapeKind::kSphere) {
    // From the point of closest approach: the textbook discriminant cancels for small, distant spheres.
    const F along = dot(center, d);
    const Vec<F> closest = center - along * d;
    const F radius(shape.radius);
    const F discriminant = fma(radius, radius, -dot(closest, closest));
    if (shape.inside) {
      const F root = sqrt(max(discriminant, zero));
      result = {along + root > zero, along + root, root / radius};
      return any_lane(result.hit);
    }
    result.hit = (discriminant > zero) & (along > zero);
    if (!any_lane(result.hit)) return false;
    const F root = sqrt(max(discriminant, zero));
    result.distance = along - root;
    result.cosine = root / radius;
    result.hit = result.hit & (result.distance > zero);
    return true;
  }
  const Vec<F> normal = broadcast<F>(shape.normal);
  const F slope = dot(normal, d);
  const F distance = F(shape.plane) / slope;
  const Vec<F> offset = distance * d - center;
  const F a = dot(offset, broadcast<F>(shape.u)) * F(shape.inv_u2),
          b = dot(offset, broadcast<F>(shape.v)) * F(shape.inv_v2);
  const F one(T(1));
  result.hit = (distance > zero) & (distance < F(std::numeric_limits<T>::max()));
  if (shape.kind == ShapeKind::kDisk) {
    result.hit = result.hit & (fma(a, a, b * b) <= one);
  } else {
    result.hit = result.hit & (abs(a) <= one) & (abs(b) <= one);
  }
  result.distance = distance;
  result.cosine = abs(slope);
  return any_lane(result.hit);
}

/// Clears the lanes whose way along d is blocked before `distance`; `light` is the light that each lane aims at, which
/// does not block itself.
template <class F>
inline mask_t<F> unoccluded(const PixelData<scalar_t<F>>& pixel, const Vec<F>& d, const F& distance, const F& light,
                            mask_t<F> visible) {
  using T = scalar_t<F>;
  for (int o = 0; o < pixel.occluder_count && any_lane(visible); ++o) {
    const LocalShape<T>& shape = pixel.occluders[o];
    ShapeHit<F> x;
    if (!intersect(shape, d, x)) continue;
    const auto other = light != F(static_cast<T>(shape.light));
    visible = visible & !(x.hit & (x.distance < distance) & other);
  }
  return visible;
}

/// The light that a direction meets, or on which a point was drawn.
template <class F>
struct LightPoint {
  Vec<F> wi;
  F distance, cosine;            ///< cos ψ on the light's side
  F pdf_area, pdf_area_surface;  ///< of techniques light and surface; only where they are asked for
};

/// The density of each technique that the call asks for, 0 where nothing is seen.
template <class F>
inline void store_pdfs(const LightingCall<scalar_t<F>>& call, std::size_t at, const mask_t<F>& seen,
                       const LightPoint<F>& light, const F& pdf_bsdf) {
  using T = scalar_t<F>;
  const auto put = [&](LightingTechnique technique, const auto& pdf) {
    T* to = call.pdfs[static_cast<int>(technique)];
    if (to) store(to + at, select(seen, pdf(), F(T(0))));
  };
  const auto from_area = [&](const F& pdf_area) {
    return pdf_solid_angle_from_area(pdf_area, light.distance, light.cosine);
  };
  put(LightingTechnique::kLight, [&] { return from_area(light.pdf_area); });
  put(LightingTechnique::kBsdf, [&] { return pdf_bsdf; });
  put(LightingTechnique::kHemisphere, [&] { return F(T(0.5) * std::numbers::inv_pi_v<T>); });
  put(LightingTechnique::kCosine, [&] { return light.wi.z * F(std::numbers::inv_pi_v<T>); });
  put(LightingTechnique::kSurface, [&] { return from_area(light.pdf_area_surface); });
}

/// A sample that is worth nothing in every lane.
template <class F, int C>
inline void store_nothing(const LightingCall<scalar_t<F>>& call, std::size_t at) {
  const F zero(scalar_t<F>(0));
  for (int c = 0; c < C; ++c) store(call.values[c] + at, zero);
  for (int t = 0; t < kLightingTechniques; ++t) {
    if (call.pdfs[t]) store(call.pdfs[t] + at, zero);
  }
}

}  // namespace halfslope::kernel
