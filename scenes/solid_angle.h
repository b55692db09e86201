// Solid angles of cones and of spheres seen from outside, by forms that hold for the smallest.
#pragma once

#include <cmath>
#include <numbers>

#include "core/packet.h"

namespace halfslope {

/// Solid angle in sr of a cone with half-angle theta in [0, π]: 2π(1 − cos θ) = 4π sin²(θ/2), which does not cancel.
template <ScalarNumber F>
inline F cone_solid_angle(F theta) {
  const F s = std::sin(F(0.5) * theta);
  return F(4) * std::numbers::pi_v<F> * s * s;
}

/// √(1 − (R/d)²): the cosine of the half-angle under which a sphere of that radius is seen, 0 < R ≤ d. The difference
/// is taken between d and R, which are given, not between 1 and a rounded square.
template <class F>
inline F sphere_cos_half_angle(const F& radius, const F& distance) {
  return sqrt(((distance - radius) / distance) * ((distance + radius) / distance));
}

/// Solid angle in sr of a sphere of `radius` whose centre is `distance` away, 0 < radius ≤ distance:
/// 2π(1 − c) = 2π s² / (1 + c) with s = R/d.
template <class F>
inline F sphere_cap_solid_angle(const F& radius, const F& distance) {
  using T = scalar_t<F>;
  const F s = radius / distance;
  return F(T(2) * std::numbers::pi_v<T>) * s * (s / (F(T(1)) + sphere_cos_half_angle(radius, distance)));
}

/// The uniform density in 1/sr over that solid angle, (1 + c) / (2π s²), divided by s twice because s² underflows
/// first.
template <class F>
inline F cone_pdf(const F& radius, const F& distance) {
  using T = scalar_t<F>;
  const F s = radius / distance;
  return (F(T(1)) + sphere_cos_half_angle(radius, distance)) / (F(T(2) * std::numbers::pi_v<T>) * s) / s;
}

}  // namespace halfslope
