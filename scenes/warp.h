// From the unit square to disks, hemispheres and spheres, for u₁, u₂ in [0, 1); directions are unit length, in the
// frame whose z axis is the surface normal.
//
// Each height or radius is written in u₁ itself: a z recovered from 1 − x² − y² is 0 for the last u₁, where the density
// is 0 too, and f cos θ / p is 0/0. With u₁ < 1 no z here is 0. (M. Pharr, W. Jakob, G. Humphreys, "Physically Based
// Rendering", 3rd ed., 2016, §13.6 derives the maps.)
#pragma once

#include "core/packet.h"
#include "scenes/vec.h"

namespace halfslope {

/// A point of the plane.
template <class F>
struct DiskPoint {
  F x, y;
};

/// Uniform on the unit disk, density 1/π: r² < u₁ is a fraction u₁ of the area.
template <class F>
inline DiskPoint<F> uniform_disk(const F& u1, const F& u2) {
  const F radius = sqrt(u1);
  const auto azimuth = sin_cos_2pi(u2);
  return {radius * azimuth.cos, radius * azimuth.sin};
}

/// Density cos θ / π in 1/sr: the uniform disk raised to the hemisphere (Malley), z = √(1 − u₁) in (0, 1].
template <class F>
inline Vec<F> cosine_hemisphere(const F& u1, const F& u2) {
  const DiskPoint<F> foot = uniform_disk(u1, u2);
  return {foot.x, foot.y, sqrt(F(scalar_t<F>(1)) - u1)};
}

/// Density 1/(2π) in 1/sr: heights are uniform (Archimedes), z = 1 − u₁ in (0, 1], radius √(1 − z²) = √(u₁(2 − u₁)).
template <class F>
inline Vec<F> uniform_hemisphere(const F& u1, const F& u2) {
  using T = scalar_t<F>;
  const F radius = sqrt(u1 * (F(T(2)) - u1));
  const auto azimuth = sin_cos_2pi(u2);
  return {radius * azimuth.cos, radius * azimuth.sin, F(T(1)) - u1};
}

/// Density 1/(4π) in 1/sr, or per area of the unit sphere: z = 1 − 2u₁, radius √(1 − z²) = 2√(u₁(1 − u₁)).
template <class F>
inline Vec<F> uniform_sphere(const F& u1, const F& u2) {
  using T = scalar_t<F>;
  const F one(T(1)), radius = F(T(2)) * sqrt(u1 * (one - u1));
  const auto azimuth = sin_cos_2pi(u2);
  return {radius * azimuth.cos, radius * azimuth.sin, fma(F(T(-2)), u1, one)};
}

}  // namespace halfslope
