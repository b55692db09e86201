#include "scenes/shape_hits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scenes/intersection.h"

namespace halfslope {
namespace {

Vec<double> plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

struct Roots {
  double near, far;
};

/// The roots of s² + 2 b s + c = 0 where b² − c = half_chord².
Roots roots(double b, double c, double half_chord) {
  const double q = b < 0 ? -b + half_chord : -b - half_chord;
  const double other = q != 0 ? c / q : 0;
  return {std::min(q, other), std::max(q, other)};
}

}  // namespace

double hit_sphere(const Sphere& sphere, const Ray& ray, double t_min) {
  const Vec3 from_center = ray.origin - sphere.center;
  const double b = from_center.dot(ray.direction);
  const double discriminant = half_chord_squared(plain(from_center), plain(ray.direction), b, sphere.radius);
  if (!(discriminant >= 0)) return kNoHit;
  const double distance = from_center.norm();
  const auto [near, far] = roots(b, (distance - sphere.radius) * (distance + sphere.radius), std::sqrt(discriminant));
  return near > t_min ? near : far > t_min ? far : kNoHit;
}

PlanePoint hit_flat(const Flat& flat, const Ray& ray, double t_min) {
  const Vec3 to_center = flat.center - ray.origin;
  const double t = flat.normal.dot(to_center) / flat.normal.dot(ray.direction);
  if (!(t > t_min) || !std::isfinite(t)) return {kNoHit, 0, 0};
  const Vec3 local = t * ray.direction - to_center;
  const double a = local.dot(flat.half_u) / flat.half_u.squaredNorm();
  const double b = local.dot(flat.half_v) / flat.half_v.squaredNorm();
  const bool disk = flat.outline == Flat::Outline::kDisk;
  const bool inside = disk ? a * a + b * b <= 1 : std::abs(a) <= 1 && std::abs(b) <= 1;
  return {inside ? t : kNoHit, a, b};
}

double hit_cylinder(const Cylinder& cylinder, const Ray& ray, double t_min) {
  const Vec3 span = cylinder.p1 - cylinder.p0;
  const double height = span.norm();
  const Vec3 axis = span / height, from_foot = ray.origin - cylinder.p0;
  const double origin_along = from_foot.dot(axis), direction_along = ray.direction.dot(axis);
  const Vec3 across = from_foot - origin_along * axis;
  const Vec3 direction = ray.direction - direction_along * axis;
  const double speed = direction.norm();
  if (!(speed > 0)) return kNoHit;
  const Vec3 unit = direction / speed;
  const double b = across.dot(unit);
  const double discriminant = half_chord_squared(plain(across), plain(unit), b, cylinder.radius);
  if (!(discriminant >= 0)) return kNoHit;
  const double distance = across.norm();
  const auto [near, far] =
      roots(b, (distance - cylinder.radius) * (distance + cylinder.radius), std::sqrt(discriminant));
  for (const double s : {near, far}) {
    const double t = s / speed, along = origin_along + t * direction_along;
    if (t > t_min && along >= 0 && along <= height) return t;
  }
  return kNoHit;
}

namespace {

/// Twice the signed volumes that the ray's direction spans with each edge as seen from its origin, for the edges across
/// from corners 0, 1 and 2. An edge times the sum of its ends, not one end times the other, which would cancel where
/// the triangle is small beside its distance.
struct Volumes {
  double v0, v1, v2;
};

Volumes volumes(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Ray& ray) {
  const Vec3 to0 = p0 - ray.origin, to1 = p1 - ray.origin, to2 = p2 - ray.origin;
  return {ray.direction.dot((p2 - p1).cross(to2 + to1)), ray.direction.dot((p0 - p2).cross(to0 + to2)),
          ray.direction.dot((p1 - p0).cross(to1 + to0))};
}

}  // namespace

TrianglePoint hit_triangle(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Ray& ray, double t_min) {
  const auto [v0, v1, v2] = volumes(p0, p1, p2, ray);
  const bool one_side = (v0 >= 0 && v1 >= 0 && v2 >= 0) || (v0 <= 0 && v1 <= 0 && v2 <= 0);
  const double whole = v0 + v1 + v2;
  if (!one_side || whole == 0) return {kNoHit, 0, 0};
  const Vec3 normal = (p1 - p0).cross(p2 - p0);
  const double t = normal.dot(p0 - ray.origin) / normal.dot(ray.direction);
  if (!(t > t_min) || !std::isfinite(t)) return {kNoHit, 0, 0};
  return {t, v1 / whole, v2 / whole};
}

Vec3 first_tangent(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  return {1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
}

}  // namespace halfslope
