#include "scenes/embree_shapes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "scenes/shape_hits.h"

namespace halfslope {
namespace {

struct Box {
  Vec3 lower, upper;
};

Box box_of(const Sphere& sphere) {
  const Vec3 half = Vec3::Constant(sphere.radius);
  return {sphere.center - half, sphere.center + half};
}

Box box_of(const Flat& flat) {
  Vec3 half = flat.half_u.cwiseAbs() + flat.half_v.cwiseAbs();
  if (flat.outline == Flat::Outline::kDisk) half = (flat.half_u.cwiseAbs2() + flat.half_v.cwiseAbs2()).cwiseSqrt();
  return {flat.center - half, flat.center + half};
}

Box box_of(const Cylinder& cylinder) {
  const Vec3 axis = (cylinder.p1 - cylinder.p0).normalized();
  const Vec3 half = cylinder.radius * (Vec3::Ones() - axis.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  return {cylinder.p0.cwiseMin(cylinder.p1) - half, cylinder.p0.cwiseMax(cylinder.p1) + half};
}

double hit(const Sphere& sphere, const Ray& ray, double t_min) { return hit_sphere(sphere, ray, t_min); }
double hit(const Flat& flat, const Ray& ray, double t_min) { return hit_flat(flat, ray, t_min).distance; }
double hit(const Cylinder& cylinder, const Ray& ray, double t_min) { return hit_cylinder(cylinder, ray, t_min); }

/// The distance at which lane i of n rays meets a shape, in lengths of its direction.
template <class Shape>
double hit_lane(const Shape& shape, RTCRayN* rays, unsigned n, unsigned i) {
  const Vec3 direction(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i));
  const double length = direction.norm();
  const Ray ray{{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)}, direction / length};
  return hit(shape, ray, RTCRayN_tnear(rays, n, i) * length) / length;
}

template <class Shape>
void bounds_callback(const RTCBoundsFunctionArguments* arguments) {
  const auto& user = *static_cast<const UserShape<Shape>*>(arguments->geometryUserPtr);
  Box box = box_of(user.shape);
  box.lower.array() -= user.margin;
  box.upper.array() += user.margin;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto down = [](double x) { return std::nextafter(static_cast<float>(x), -kInfinity); };
  const auto up = [](double x) { return std::nextafter(static_cast<float>(x), kInfinity); };
  *arguments->bounds_o = {down(box.lower.x()), down(box.lower.y()), down(box.lower.z()), 0,
                          up(box.upper.x()),   up(box.upper.y()),   up(box.upper.z()),   0};
}

template <class Shape>
void intersect_callback(const RTCIntersectFunctionNArguments* arguments) {
  const unsigned n = arguments->N;
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, n);
  RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, n);
  for (unsigned i = 0; i < n; ++i) {
    if (!arguments->valid[i]) continue;
    const auto t = static_cast<float>(
        hit_lane(static_cast<const UserShape<Shape>*>(arguments->geometryUserPtr)->shape, rays, n, i));
    if (!(t < RTCRayN_tfar(rays, n, i))) continue;
    RTCRayN_tfar(rays, n, i) = t;
    RTCHitN_u(hits, n, i) = RTCHitN_v(hits, n, i) = 0;
    RTCHitN_primID(hits, n, i) = 0;
    RTCHitN_geomID(hits, n, i) = arguments->geomID;
  }
}

template <class Shape>
void occluded_callback(const RTCOccludedFunctionNArguments* arguments) {
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (!arguments->valid[i]) continue;
    const auto t = static_cast<float>(
        hit_lane(static_cast<const UserShape<Shape>*>(arguments->geometryUserPtr)->shape, arguments->ray, n, i));
    if (t < RTCRayN_tfar(arguments->ray, n, i))
      RTCRayN_tfar(arguments->ray, n, i) = -std::numeric_limits<float>::infinity();
  }
}

template <class Shape>
void set(RTCGeometry geometry, UserShape<Shape>& shape) {
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, &shape);
  rtcSetGeometryBoundsFunction(geometry, bounds_callback<Shape>, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_callback<Shape>);
  rtcSetGeometryOccludedFunction(geometry, occluded_callback<Shape>);
}

}  // namespace

void set_callbacks(RTCGeometry geometry, UserShape<Sphere>& shape) { set(geometry, shape); }
void set_callbacks(RTCGeometry geometry, UserShape<Flat>& shape) { set(geometry, shape); }
void set_callbacks(RTCGeometry geometry, UserShape<Cylinder>& shape) { set(geometry, shape); }

}  // namespace halfslope
