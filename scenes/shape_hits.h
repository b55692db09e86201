// Where a ray meets each shape, in double precision by the stable forms.
#pragma once

#include <limits>

#include "scenes/scene.h"

namespace halfslope {

inline constexpr double kNoHit = std::numeric_limits<double>::infinity();

/// The smallest t > t_min with |o + t d − c| = R, or kNoHit; |d| = 1. From the closest approach, with the root of the
/// smaller magnitude as the product of both over the other (E. Haines et al., Ray Tracing Gems, 2019, ch. 7).
double hit_sphere(const Sphere& sphere, const Ray& ray, double t_min = 0);

/// A point of a flat shape: center + a·half_u + b·half_v.
struct PlanePoint {
  double distance, a, b;
};
/// `distance` is kNoHit where the ray misses, or meets the plane at t ≤ t_min.
PlanePoint hit_flat(const Flat& flat, const Ray& ray, double t_min = 0);

/// The smallest t > t_min at which the ray meets the side of a cylinder, or kNoHit: the sphere's quadratic in the plane
/// across the axis.
double hit_cylinder(const Cylinder& cylinder, const Ray& ray, double t_min = 0);

/// A point of a triangle: its corners weighted by 1 − u − v, u, v.
struct TrianglePoint {
  double distance, u, v;
};
/// By the signed volumes of the ray with each edge. Those of an edge that two triangles share differ in sign alone, so
/// that no ray passes between them.
TrianglePoint hit_triangle(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Ray& ray, double t_min = 0);

/// A unit vector perpendicular to the unit vector n, Mitsuba's first: where the u of a cylinder along n begins (T. Duff
/// et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017).
Vec3 first_tangent(const Vec3& n);

/// A corner of a mesh.
inline Vec3 corner(const Mesh& mesh, std::size_t triangle, std::size_t k) {
  const Mesh::Point& p = mesh.positions[mesh.triangles[triangle][k]];
  return {p[0], p[1], p[2]};
}

}  // namespace halfslope
