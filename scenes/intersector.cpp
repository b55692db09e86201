#include "scenes/intersector.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/shape_hits.h"

namespace halfslope {
namespace {

/// A piece that a ray meets. u and v are of a triangle.
struct Meeting {
  int primitive = -1, triangle = 0;
  double distance = kNoHit, u = 0, v = 0;
};

/// Takes the place of `nearest` where it is nearer.
void meet(const Sphere& sphere, int primitive, const Ray& ray, double t_min, Meeting& nearest) {
  const double t = hit_sphere(sphere, ray, t_min);
  if (t < nearest.distance) nearest = {primitive, 0, t};
}

void meet(const Flat& flat, int primitive, const Ray& ray, double t_min, Meeting& nearest) {
  const double t = hit_flat(flat, ray, t_min).distance;
  if (t < nearest.distance) nearest = {primitive, 0, t};
}

void meet(const Cylinder& cylinder, int primitive, const Ray& ray, double t_min, Meeting& nearest) {
  const double t = hit_cylinder(cylinder, ray, t_min);
  if (t < nearest.distance) nearest = {primitive, 0, t};
}

void meet(const Mesh& mesh, std::size_t triangle, int primitive, const Ray& ray, double t_min, Meeting& nearest) {
  const auto [t, u, v] =
      hit_triangle(corner(mesh, triangle, 0), corner(mesh, triangle, 1), corner(mesh, triangle, 2), ray, t_min);
  if (t < nearest.distance) nearest = {primitive, static_cast<int>(triangle), t, u, v};
}

void meet(const std::shared_ptr<const Mesh>& mesh, int primitive, const Ray& ray, double t_min, Meeting& nearest) {
  for (std::size_t t = 0; t < mesh->triangles.size(); ++t) meet(*mesh, t, primitive, ray, t_min, nearest);
}

/// An angle of atan2 as a part of a turn, in [0, 1).
double turn(double angle) {
  const double part = angle / (2 * std::numbers::pi);
  return part < 0 ? std::min(part + 1, std::nextafter(1.0, 0.0)) : part;
}

void fill(const Sphere& sphere, const Ray& ray, const Meeting& meeting, SurfaceHit& hit) {
  const Vec3 outward = (ray.origin + meeting.distance * ray.direction - sphere.center).normalized();
  hit.position = sphere.center + sphere.radius * outward;
  hit.normal = sphere.flip_normals ? Vec3(-outward) : outward;
  const Vec3 local = sphere.from_world * outward;
  // By atan2: acos of z would lose half the digits near the poles.
  hit.uv = {turn(std::atan2(local.y(), local.x())),
            std::atan2(std::hypot(local.x(), local.y()), local.z()) / std::numbers::pi};
}

void fill(const Flat& flat, const Ray& ray, const Meeting& meeting, SurfaceHit& hit) {
  const Vec3 local = ray.origin + meeting.distance * ray.direction - flat.center;
  const double a = local.dot(flat.half_u) / flat.half_u.squaredNorm();
  const double b = local.dot(flat.half_v) / flat.half_v.squaredNorm();
  hit.position = flat.center + a * flat.half_u + b * flat.half_v;
  hit.normal = flat.normal;
  if (flat.outline == Flat::Outline::kDisk) {
    hit.uv = {std::hypot(a, b), turn(std::atan2(b, a))};
  } else {
    hit.uv = {(a + 1) / 2, (b + 1) / 2};
  }
}

void fill(const Cylinder& cylinder, const Ray& ray, const Meeting& meeting, SurfaceHit& hit) {
  const Vec3 span = cylinder.p1 - cylinder.p0;
  const double height = span.norm();
  const Vec3 axis = span / height, local = ray.origin + meeting.distance * ray.direction - cylinder.p0;
  const double along = std::clamp(local.dot(axis), 0.0, height);
  const Vec3 outward = (local - local.dot(axis) * axis).normalized();
  hit.position = cylinder.p0 + along * axis + cylinder.radius * outward;
  hit.normal = cylinder.flip_normals ? Vec3(-outward) : outward;
  const Vec3 s = (cylinder.start - cylinder.start.dot(axis) * axis).normalized(), t = axis.cross(s);
  hit.uv = {turn(std::atan2(outward.dot(t), outward.dot(s))), along / height};
}

void fill(const std::shared_ptr<const Mesh>& mesh, const Ray&, const Meeting& meeting, SurfaceHit& hit) {
  const auto index = static_cast<std::size_t>(meeting.triangle);
  const auto& triangle = mesh->triangles[index];
  const double w = 1 - meeting.u - meeting.v;
  const Vec3 p0 = corner(*mesh, index, 0), p1 = corner(*mesh, index, 1), p2 = corner(*mesh, index, 2);
  hit.triangle = meeting.triangle;
  hit.position = w * p0 + meeting.u * p1 + meeting.v * p2;
  hit.normal = (p1 - p0).cross(p2 - p0).normalized();
  hit.uv = {meeting.u, meeting.v};
  const auto interpolated = [&]<std::size_t n>(const std::vector<std::array<float, n>>& values) {
    Eigen::Matrix<double, n, 1> sum;
    for (std::size_t i = 0; i < n; ++i)
      sum[static_cast<int>(i)] = w * static_cast<double>(values[triangle[0]][i]) +
                                 meeting.u * static_cast<double>(values[triangle[1]][i]) +
                                 meeting.v * static_cast<double>(values[triangle[2]][i]);
    return sum;
  };
  if (!mesh->uvs.empty()) hit.uv = interpolated(mesh->uvs);
  hit.shading_normal = hit.normal;
  if (mesh->normals.empty()) return;
  const Vec3 normal = interpolated(mesh->normals);
  if (normal.norm() > 0) hit.shading_normal = normal.normalized();
}

}  // namespace

std::size_t count_pieces(const Scene& scene) {
  std::size_t count = 0;
  for (const Primitive& primitive : scene.primitives) {
    const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&primitive.shape);
    count += mesh ? (*mesh)->triangles.size() : 1;
  }
  return count;
}

std::string why_traced(std::size_t pieces) {
  const std::string count = pieces == 1 ? "1 piece" : fmt::format("{} pieces", pieces);
  return pieces <= kHandful ? fmt::format("{}, at most {}: each is tried", count, kHandful)
                            : fmt::format("{}, more than {}: Embree's hierarchy", count, kHandful);
}

Intersector::Intersector(const Scene& scene) : scene_(scene), pieces_(count_pieces(scene)) {
  if (pieces_ > kHandful) embree_ = std::make_shared<const EmbreeScene>(scene);
}

SurfaceHit Intersector::first(const Ray& ray) const {
  Meeting nearest;
  if (embree_) {
    const auto found = embree_->first(ray);
    if (found.primitive < 0) return {};
    const auto& shape = scene_.primitives[static_cast<std::size_t>(found.primitive)].shape;
    // The root that Embree found, which may be a sphere's second, as double precision has it.
    const double t_min = 0.99 * found.distance;
    if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape)) {
      meet(**mesh, static_cast<std::size_t>(found.triangle), found.primitive, ray, t_min, nearest);
    } else {
      std::visit([&](const auto& one) { meet(one, found.primitive, ray, t_min, nearest); }, shape);
    }
    // A ray that only its rounding brings to the piece.
    if (!(nearest.distance < 1.01 * found.distance))
      nearest = {found.primitive, found.triangle, found.distance, found.u, found.v};
  } else {
    for (std::size_t i = 0; i < scene_.primitives.size(); ++i)
      std::visit([&](const auto& shape) { meet(shape, static_cast<int>(i), ray, 0, nearest); },
                 scene_.primitives[i].shape);
  }
  if (nearest.primitive < 0) return {};
  SurfaceHit hit;
  hit.primitive = nearest.primitive;
  hit.distance = nearest.distance;
  std::visit([&](const auto& shape) { fill(shape, ray, nearest, hit); },
             scene_.primitives[static_cast<std::size_t>(nearest.primitive)].shape);
  if (!std::holds_alternative<std::shared_ptr<const Mesh>>(
          scene_.primitives[static_cast<std::size_t>(nearest.primitive)].shape))
    hit.shading_normal = hit.normal;
  hit.front = ray.direction.dot(hit.normal) < 0;
  return hit;
}

}  // namespace halfslope
