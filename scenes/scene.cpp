#include "scenes/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/assertion.h"
#include "scenes/intersection.h"

namespace halfslope {
namespace {

constexpr double kNoHit = std::numeric_limits<double>::infinity();

Vec<double> plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// The smallest t > 0 with |o + t d − c| = R, or kNoHit. The root of the smaller magnitude is the product of both over
/// the other.
double hit_sphere(const Sphere& sphere, const Ray& ray) {
  const Vec3 from_center = ray.origin - sphere.center;
  const double b = from_center.dot(ray.direction);
  const double discriminant = half_chord_squared(plain(from_center), plain(ray.direction), b, sphere.radius);
  if (!(discriminant >= 0)) return kNoHit;
  const double half_chord = std::sqrt(discriminant), distance = from_center.norm();
  const double product = (distance - sphere.radius) * (distance + sphere.radius);
  const double q = b < 0 ? -b + half_chord : -b - half_chord;
  const double other = q != 0 ? product / q : 0;
  const double near = std::min(q, other), far = std::max(q, other);
  return near > 0 ? near : far > 0 ? far : kNoHit;
}

struct PlanePoint {
  double distance, a, b;  ///< center + a·half_u + b·half_v
};

PlanePoint hit_flat(const Flat& flat, const Ray& ray) {
  const Vec3 to_center = flat.center - ray.origin;
  const double t = flat.normal.dot(to_center) / flat.normal.dot(ray.direction);
  if (!(t > 0) || !std::isfinite(t)) return {kNoHit, 0, 0};
  const Vec3 local = t * ray.direction - to_center;
  const double a = local.dot(flat.half_u) / flat.half_u.squaredNorm();
  const double b = local.dot(flat.half_v) / flat.half_v.squaredNorm();
  const bool disk = flat.outline == Flat::Outline::kDisk;
  const bool inside = disk ? a * a + b * b <= 1 : std::abs(a) <= 1 && std::abs(b) <= 1;
  return {inside ? t : kNoHit, a, b};
}

}  // namespace

Ray Sensor::ray(int x, int y, int image_width, int image_height) const {
  if (kind == Kind::kRays) {
    assert_equal(y, 0, "row of a sensor whose rays are given one by one");
    assert_equal(x, std::clamp(x, 0, static_cast<int>(rays.size()) - 1), "index of a ray");
    return rays[static_cast<std::size_t>(x)];
  }
  assert_equal(x, std::clamp(x, 0, image_width - 1), "column of a pixel");
  assert_equal(y, std::clamp(y, 0, image_height - 1), "row of a pixel");
  const double aspect = static_cast<double>(image_width) / image_height;
  const double tan_half_fov = std::tan(0.5 * fov_degrees * std::numbers::pi / 180);
  FovAxis axis = fov_axis;
  if (axis == FovAxis::kSmaller) axis = aspect > 1 ? FovAxis::kY : FovAxis::kX;
  if (axis == FovAxis::kLarger) axis = aspect > 1 ? FovAxis::kX : FovAxis::kY;
  double tan_half_width = tan_half_fov;
  if (axis == FovAxis::kY) tan_half_width = tan_half_fov * aspect;
  if (axis == FovAxis::kDiagonal) tan_half_width = tan_half_fov / std::hypot(1, 1 / aspect);
  const double to_left = (1 - 2 * (x + 0.5) / image_width) * tan_half_width;
  const double to_top = (1 - 2 * (y + 0.5) / image_height) * tan_half_width / aspect;
  return {origin, (forward + to_left * left + to_top * up).normalized()};
}

Hit first_hit(const Scene& scene, const Ray& ray) {
  Hit hit;
  double nearest = kNoHit;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    if (const auto* sphere = std::get_if<Sphere>(&scene.primitives[i].shape)) {
      const double t = hit_sphere(*sphere, ray);
      if (!(t < nearest)) continue;
      nearest = t;
      const Vec3 outward = (ray.origin + t * ray.direction - sphere->center).normalized();
      hit.position = sphere->center + sphere->radius * outward;
      hit.normal = sphere->flip_normals ? Vec3(-outward) : outward;
    } else {
      const auto& flat = std::get<Flat>(scene.primitives[i].shape);
      const PlanePoint point = hit_flat(flat, ray);
      if (!(point.distance < nearest)) continue;
      nearest = point.distance;
      hit.position = flat.center + point.a * flat.half_u + point.b * flat.half_v;
      hit.normal = flat.normal;
    }
    hit.primitive = static_cast<int>(i);
    hit.distance = nearest;
    hit.front = ray.direction.dot(hit.normal) < 0;
  }
  return hit;
}

double area(const Primitive& primitive, double scale) {
  if (const auto* sphere = std::get_if<Sphere>(&primitive.shape)) {
    const double radius = scale * sphere->radius;
    return 4 * std::numbers::pi * radius * radius;
  }
  const auto& flat = std::get<Flat>(primitive.shape);
  const double square = (scale * flat.half_u).norm() * (scale * flat.half_v).norm();
  return (flat.outline == Flat::Outline::kDisk ? std::numbers::pi : 4) * square;
}

Vec3 leave_surface(const Primitive& primitive, const Hit& hit) {
  const auto largest = [](const Vec3& v) { return v.cwiseAbs().maxCoeff(); };
  double reach = largest(hit.position);
  if (const auto* sphere = std::get_if<Sphere>(&primitive.shape)) {
    reach = std::max({reach, largest(sphere->center), sphere->radius});
  } else {
    const auto& flat = std::get<Flat>(primitive.shape);
    reach = std::max({reach, largest(flat.center), largest(flat.half_u), largest(flat.half_v)});
  }
  const double step = 16 * std::numeric_limits<double>::epsilon() * reach;
  return hit.position + (hit.front ? step : -step) * hit.normal;
}

bool is_black(const Bsdf& bsdf) {
  return (bsdf.reflectance == 0).all() && (bsdf.kind != BsdfKind::kPhong || (bsdf.specular == 0).all());
}

bool is_grey(const Scene& scene) {
  const auto grey = [](const Rgb& colour) { return colour[0] == colour[1] && colour[1] == colour[2]; };
  for (const Primitive& primitive : scene.primitives) {
    const Bsdf& bsdf = primitive.bsdf;
    if (primitive.emits && !grey(primitive.radiance)) return false;
    if (!grey(bsdf.reflectance)) return false;
    if (bsdf.kind == BsdfKind::kPhong && !grey(bsdf.specular)) return false;
    const bool has_index = bsdf.kind == BsdfKind::kRoughConductor && !bsdf.unit_fresnel;
    if (has_index && !(grey(bsdf.eta) && grey(bsdf.k))) return false;
  }
  return true;
}

}  // namespace halfslope
