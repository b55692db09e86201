// Directions towards a sphere, uniform in the solid angle that it fills, from a tiny cone to touching it; and from
// inside it.
#pragma once

#include <numbers>

#include "core/packet.h"
#include "scenes/solid_angle.h"
#include "scenes/vec.h"
#include "scenes/warp.h"

namespace halfslope {

/// Where a ray from the origin meets a sphere first: at center + radius · outward.
template <class F>
struct SpherePoint {
  Vec<F> direction;   ///< unit length
  F distance;         ///< along it
  Vec<F> outward;     ///< the sphere's normal there, unit length
  F cosine;           ///< |outward · direction|
  F pdf;              ///< of the direction, in 1/sr
  mask_t<F> outside;  ///< whether the receiver is not inside the sphere
};

/// The density in 1/sr of sample_sphere_solid_angle in every direction that meets the sphere, relative to the receiver:
/// 1/(2π(1 − c)), and 1/(4π) from inside it.
template <class F>
inline F sphere_solid_angle_pdf(const Vec<F>& center, const F& radius, mask_t<F>& outside) {
  using T = scalar_t<F>;
  const F distance = length(center);
  outside = distance >= radius;
  return select(outside, cone_pdf(radius, max(distance, radius)), F(T(0.25) * std::numbers::inv_pi_v<T>));
}

/// A point of the sphere about `center`, relative to the receiver, that the receiver sees, uniform in the solid angle
/// that the sphere fills, for u₁ and u₂ in [0, 1); of all directions where the receiver is inside it.
///
/// With s = R/d the sine of the cone's half-angle and c its cosine, 1 − cos θ = u₁ (1 − c) = u₁ s²/(1 + c) =: t and
/// sin θ = √(t(2 − t)). The half chord is d √(cos²θ − c²) = d √((1 − u₁)(1 − c)(cos θ + c)); the distance is
/// d cos θ less that, as (d − R)(d + R)/(d cos θ + half chord); and at the point the normal makes with the way back to
/// the receiver an angle of cosine (half chord)/R.
template <class F>
inline SpherePoint<F> sample_sphere_solid_angle(const Vec<F>& center, const F& radius, const F& u1, const F& u2) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), two(T(2));
  const F d = length(center);
  const mask_t<F> outside = d >= radius;
  const F far = max(d, radius), s = radius / far, c = sphere_cos_half_angle(radius, far);
  const F all = s * (s / (one + c)), t = u1 * all, cos_theta = one - t, sin_theta = sqrt(t * (two - t));
  const auto azimuth = sin_cos_2pi(u2);
  const F half_chord = far * sqrt((one - u1) * all * (cos_theta + c));
  const F distance = (far - radius) * ((far + radius) / (far * cos_theta + half_chord));
  // A frame about the axis (T. Duff and others, "Building an Orthonormal Basis, Revisited", 2017).
  const Vec<F> axis = (one / far) * center;
  const F sign = select(axis.z < zero, -one, one), a = -one / (sign + axis.z), b = axis.x * axis.y * a;
  const Vec<F> axis_x = {fma(sign * axis.x * axis.x, a, one), sign * b, -(sign * axis.x)};
  const Vec<F> axis_y = {b, fma(axis.y * axis.y, a, sign), -axis.y};
  const Vec<F> across = azimuth.cos * axis_x + azimuth.sin * axis_y;
  // The normal leans from −axis by an angle of sine distance · sin θ / R, and of cosine cos(θ + angle at the point).
  const F lean_sin = (distance / radius) * sin_theta;
  const F lean_cos = (half_chord * cos_theta + far * (sin_theta * sin_theta)) / radius;
  SpherePoint<F> point = {cos_theta * axis + sin_theta * across,         distance,
                          lean_sin * across - lean_cos * axis,           half_chord / radius,
                          one / (F(T(2) * std::numbers::pi_v<T>) * all), outside};
  if (!any_lane(!outside)) return point;
  const Vec<F> direction = uniform_sphere(u1, u2);
  const F along = dot(center, direction);
  const Vec<F> closest = center - along * direction;
  const F chord = sqrt(max(fma(radius, radius, -dot(closest, closest)), zero));
  const F way = select(along > zero, along + chord, (radius - d) * (radius + d) / (chord - along));
  const F inverse = one / radius;
  const auto either = [&](const F& from_outside, const F& from_inside) {
    return select(outside, from_outside, from_inside);
  };
  const auto either_vec = [&](const Vec<F>& from_outside, const Vec<F>& from_inside) {
    return Vec<F>{either(from_outside.x, from_inside.x), either(from_outside.y, from_inside.y),
                  either(from_outside.z, from_inside.z)};
  };
  return {either_vec(point.direction, direction),
          either(point.distance, way),
          either_vec(point.outward, inverse * (way * direction - center)),
          either(point.cosine, chord * inverse),
          either(point.pdf, F(T(0.25) * std::numbers::inv_pi_v<T>)),
          outside};
}

}  // namespace halfslope
