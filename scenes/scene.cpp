#include "scenes/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/assertion.h"
#include "scenes/shape_hits.h"

namespace halfslope {
Ray Sensor::ray(int x, int y, int image_width, int image_height) const {
  if (kind == Kind::kRays) {
    assert_equal(y, 0, "row of a sensor whose rays are given one by one");
    assert_equal(x, std::clamp(x, 0, static_cast<int>(rays.size()) - 1), "index of a ray");
    return rays[static_cast<std::size_t>(x)];
  }
  assert_equal(x, std::clamp(x, 0, image_width - 1), "column of a pixel");
  assert_equal(y, std::clamp(y, 0, image_height - 1), "row of a pixel");
  const double across = 1 - 2 * (x + 0.5) / image_width, upwards = 1 - 2 * (y + 0.5) / image_height;
  if (kind == Kind::kOrthographic) return {origin + across * left + upwards * up, forward};
  const double aspect = static_cast<double>(image_width) / image_height;
  const double tan_half_fov = std::tan(0.5 * fov_degrees * std::numbers::pi / 180);
  FovAxis axis = fov_axis;
  if (axis == FovAxis::kSmaller) axis = aspect > 1 ? FovAxis::kY : FovAxis::kX;
  if (axis == FovAxis::kLarger) axis = aspect > 1 ? FovAxis::kX : FovAxis::kY;
  double tan_half_width = tan_half_fov;
  if (axis == FovAxis::kY) tan_half_width = tan_half_fov * aspect;
  if (axis == FovAxis::kDiagonal) tan_half_width = tan_half_fov / std::hypot(1, 1 / aspect);
  const double to_left = across * tan_half_width, to_top = upwards * tan_half_width / aspect;
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

namespace {

double area_of(const Sphere& sphere, double scale) {
  const double radius = scale * sphere.radius;
  return 4 * std::numbers::pi * radius * radius;
}

double area_of(const Flat& flat, double scale) {
  const double square = (scale * flat.half_u).norm() * (scale * flat.half_v).norm();
  return (flat.outline == Flat::Outline::kDisk ? std::numbers::pi : 4) * square;
}

double area_of(const Cylinder& cylinder, double scale) {
  return 2 * std::numbers::pi * (scale * cylinder.radius) * (scale * (cylinder.p1 - cylinder.p0)).norm();
}

double area_of(const std::shared_ptr<const Mesh>& mesh, double scale) {
  double sum = 0;
  for (const auto& triangle : mesh->triangles) {
    const auto corner = [&](int i) -> Vec3 {
      return scale * Eigen::Vector3f(mesh->positions[triangle[static_cast<std::size_t>(i)]].data()).cast<double>();
    };
    sum += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return sum;
}

}  // namespace

double area(const Primitive& primitive, double scale) {
  return std::visit([&](const auto& shape) { return area_of(shape, scale); }, primitive.shape);
}

namespace {

Vec3 middle_of(const Cylinder& cylinder) { return 0.5 * (cylinder.p0 + cylinder.p1); }

Eigen::AlignedBox3d box_of(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Mesh::Point& p : mesh.positions) box.extend(Eigen::Vector3f(p.data()).cast<double>());
  return box;
}

Vec3 middle_of(const std::shared_ptr<const Mesh>& mesh) { return box_of(*mesh).center(); }

template <class Shape>
Vec3 middle_of(const Shape& shape) {
  return shape.center;
}

double extent_of(const Sphere& sphere) { return sphere.radius; }
double extent_of(const Flat& flat) { return std::max(flat.half_u.stableNorm(), flat.half_v.stableNorm()); }
double extent_of(const Cylinder& cylinder) {
  return std::max(cylinder.radius, (cylinder.p1 - cylinder.p0).stableNorm());
}
double extent_of(const std::shared_ptr<const Mesh>& mesh) { return box_of(*mesh).diagonal().stableNorm(); }

}  // namespace

double extent(const Primitive& primitive) {
  return std::visit([](const auto& shape) { return extent_of(shape); }, primitive.shape);
}

Vec3 middle(const Primitive& primitive) {
  return std::visit([](const auto& shape) { return middle_of(shape); }, primitive.shape);
}

bool is_plain(const Scene& scene) {
  if (!scene.delta_lights.empty() || scene.environment) return false;
  return std::all_of(scene.primitives.begin(), scene.primitives.end(), [](const Primitive& primitive) {
    const Bsdf& bsdf = primitive.bsdf;
    if (!std::holds_alternative<Sphere>(primitive.shape) && !std::holds_alternative<Flat>(primitive.shape))
      return false;
    if (primitive.back || bsdf.textured() || bsdf.opacity != 1) return false;
    if (bsdf.kind == BsdfKind::kRoughConductor) return bsdf.distribution == Distribution::kGgx && !bsdf.alpha_v;
    return bsdf.kind == BsdfKind::kDiffuse || bsdf.kind == BsdfKind::kPhong;
  });
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
  const bool no_reflectance = (bsdf.reflectance == 0).all(), no_specular = (bsdf.specular == 0).all();
  if (bsdf.opacity != 1 || bsdf.opacity_texture) return false;
  switch (bsdf.kind) {
    case BsdfKind::kDiffuse:
    case BsdfKind::kConductor:
    case BsdfKind::kRoughConductor:
      return no_reflectance;
    case BsdfKind::kPhong:
    case BsdfKind::kPlastic:
    case BsdfKind::kRoughPlastic:
      return no_reflectance && no_specular;
    case BsdfKind::kDielectric:
    case BsdfKind::kRoughDielectric:
      return no_specular && (bsdf.transmittance == 0).all();
  }
  return false;
}

namespace {

bool grey(const Rgb& colour) { return colour[0] == colour[1] && colour[1] == colour[2]; }

bool grey(const std::shared_ptr<const Texture>& texture) {
  if (!texture) return true;
  if (texture->kind == Texture::Kind::kCheckerboard) return grey(texture->color0) && grey(texture->color1);
  return is_grey(*texture->bitmap);
}

bool grey(const Bsdf& bsdf) {
  if (!grey(bsdf.reflectance_texture) || !grey(bsdf.specular_texture) || !grey(bsdf.transmittance_texture))
    return false;
  switch (bsdf.kind) {
    case BsdfKind::kDiffuse:
      return grey(bsdf.reflectance);
    case BsdfKind::kConductor:
    case BsdfKind::kRoughConductor:
      return grey(bsdf.reflectance) && (bsdf.unit_fresnel || (grey(bsdf.eta) && grey(bsdf.k)));
    case BsdfKind::kPhong:
    case BsdfKind::kPlastic:
    case BsdfKind::kRoughPlastic:
      return grey(bsdf.reflectance) && grey(bsdf.specular);
    case BsdfKind::kDielectric:
    case BsdfKind::kRoughDielectric:
      return grey(bsdf.specular) && grey(bsdf.transmittance);
  }
  return false;
}

bool grey(const PointLight& light) { return grey(light.intensity); }
bool grey(const DirectionalLight& light) { return grey(light.irradiance); }
bool grey(const SpotLight& light) { return grey(light.intensity); }
bool grey(const Environment& environment) {
  return environment.map ? is_grey(*environment.map) : grey(environment.radiance);
}

}  // namespace

bool is_grey(const Bitmap& bitmap) {
  for (std::size_t i = 0; i + 2 < bitmap.rgb.size(); i += 3) {
    if (bitmap.rgb[i] != bitmap.rgb[i + 1] || bitmap.rgb[i] != bitmap.rgb[i + 2]) return false;
  }
  return true;
}

bool is_grey(const Scene& scene) {
  const auto is = [](const auto& light) { return grey(light); };
  for (const DeltaLight& light : scene.delta_lights) {
    if (!std::visit(is, light)) return false;
  }
  if (scene.environment && !grey(*scene.environment)) return false;
  return std::all_of(scene.primitives.begin(), scene.primitives.end(), [](const Primitive& primitive) {
    if (primitive.emits && !grey(primitive.radiance)) return false;
    return grey(primitive.bsdf) && (!primitive.back || grey(*primitive.back));
  });
}

}  // namespace halfslope
