// What the form factors' tests share: lights around a receiver at the origin, comparison, quadrature.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <optional>

#include "scenes/closed_form.h"

namespace halfslope {

inline constexpr double kPi = std::numbers::pi;
inline const Vec3 kUp = Vec3::UnitZ();

inline Flat flat_of(const Vec3& center, const Vec3& half_u, const Vec3& half_v, Flat::Outline outline) {
  Flat flat;
  flat.center = center, flat.half_u = half_u, flat.half_v = half_v, flat.outline = outline;
  flat.normal = half_u.cross(half_v).stableNormalized();
  if (flat.normal.dot(center) > 0) flat.normal = -flat.normal;  // faces the origin
  return flat;
}
inline Flat rectangle(const Vec3& center, const Vec3& half_u, const Vec3& half_v) {
  return flat_of(center, half_u, half_v, Flat::Outline::kRectangle);
}
inline Flat disk(const Vec3& center, const Vec3& half_u, const Vec3& half_v) {
  return flat_of(center, half_u, half_v, Flat::Outline::kDisk);
}
inline Sphere sphere(const Vec3& center, double radius, bool flip_normals = false) {
  return {center, radius, flip_normals};
}

inline std::optional<double> factor(const Shape& shape, const Vec3& position = Vec3::Zero(), const Vec3& normal = kUp) {
  Primitive light;
  light.shape = shape;
  light.emits = true;
  light.radiance = Rgb::Ones();
  return form_factor(light, position, normal);
}

inline void close(double found, double exact, double relative) {
  EXPECT_LE(std::fabs(found - exact), relative * std::fabs(exact)) << found << " is not " << exact;
}
inline void close(std::optional<double> found, double exact, double relative) {
  ASSERT_TRUE(found.has_value());
  close(*found, exact, relative);
}

/// ∫_a^b f, 15 Gauss points on each of `panels` equal parts.
template <class Function>
inline double integrate(const Function& f, double a, double b, int panels) {
  double sum = 0;
  for (int i = 0; i < panels; ++i) {
    const double step = (b - a) / panels;
    sum += boost::math::quadrature::gauss<double, 15>::integrate(f, a + i * step, a + (i + 1) * step);
  }
  return sum;
}

/// cos θ cos ψ / (π r²) at x, seen from the origin with normal +z.
inline double density(const Vec3& x, const Vec3& normal) {
  const double r2 = x.squaredNorm();
  return std::max(x.z(), 0.0) * std::fabs(normal.dot(x)) / (kPi * r2 * r2);
}

}  // namespace halfslope
