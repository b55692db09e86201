#include "estimators/local_pixel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

namespace halfslope {
namespace {

template <class T>
void copy(const Vec3& from, T (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(from[i]);
}
template <class T>
void copy(const Rgb& from, T (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(from[i]);
}

/// Rows: a local frame whose z axis is n (J. R. Frisvad's problem, solved by Duff and others 2017).
Eigen::Matrix3d frame(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  Eigen::Matrix3d rows;
  rows << 1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x(), b, sign + n.y() * n.y() * a, -n.y(), n.x(), n.y(),
      n.z();
  return rows;
}

/// A power of two by which lengths from the point become at most about 1. Kernels square them, and binary32 has no
/// squares of lengths beyond 1e±19.
double length_scale(const Scene& scene, const Vec3& from) {
  double farthest = 0;
  for (const Primitive& primitive : scene.primitives) {
    farthest = std::max(farthest, (middle(primitive) - from).stableNorm());
  }
  return farthest > 0 ? std::exp2(-std::ilogb(farthest)) : 1;
}

/// `own`: the receiver lies on it. `light`: its index among the lights.
template <class T>
LocalShape<T> local_shape(const Primitive& primitive, const Receiver& receiver, const Eigen::Matrix3d& to_local,
                          double scale, bool own, int light) {
  LocalShape<T> shape;
  shape.light = light;
  if (const auto* sphere = std::get_if<Sphere>(&primitive.shape)) {
    copy(Vec3(scale * (to_local * (sphere->center - receiver.position))), shape.center);
    shape.radius = static_cast<T>(scale * sphere->radius);
    shape.inside = inside_sphere(receiver, *sphere, own);
    return shape;
  }
  const auto& flat = std::get<Flat>(primitive.shape);
  const Vec3 center = scale * (flat.center - receiver.position);
  const Vec3 half_u = scale * flat.half_u, half_v = scale * flat.half_v;
  shape.kind = flat.outline == Flat::Outline::kDisk ? ShapeKind::kDisk : ShapeKind::kRectangle;
  copy(Vec3(to_local * center), shape.center);
  copy(Vec3(to_local * half_u), shape.u);
  copy(Vec3(to_local * half_v), shape.v);
  copy(Vec3(to_local * flat.normal), shape.normal);
  shape.plane = static_cast<T>(flat.normal.dot(center));
  shape.inv_u2 = static_cast<T>(1 / half_u.squaredNorm());
  shape.inv_v2 = static_cast<T>(1 / half_v.squaredNorm());
  return shape;
}

/// Rec. 709 luminance.
double luminance(const Rgb& colour) { return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]; }

template <class T>
void copy_bsdf(const Bsdf& bsdf, PixelData<T>& data) {
  data.bsdf = bsdf.kind;
  data.unit_fresnel = bsdf.unit_fresnel;
  data.alpha = static_cast<T>(bsdf.alpha);
  copy(bsdf.reflectance, data.reflectance);
  copy(bsdf.eta, data.eta);
  copy(bsdf.k, data.k);
  if (bsdf.kind != BsdfKind::kPhong) return;
  copy(bsdf.specular, data.specular);
  data.exponent = static_cast<T>(bsdf.exponent);
  // A whole number of the steps in which T's coordinates come, so that exactly this share of them is below it; neither
  // all nor none where both parts reflect.
  constexpr double kSteps = std::is_same_v<T, float> ? 0x1p24 : 0x1p53;
  const double specular = luminance(bsdf.specular), diffuse = luminance(bsdf.reflectance);
  const double least = specular > 0 ? 1 : 0, most = diffuse > 0 ? kSteps - 1 : kSteps;
  const double steps = std::round(specular / (specular + diffuse) * kSteps);
  data.specular_share = static_cast<T>(std::clamp(steps, least, most) / kSteps);
}

}  // namespace

Emitters find_emitters(const Scene& scene) {
  Emitters emitters;
  double longest = 0;
  for (const Primitive& p : scene.primitives) longest = std::max(longest, extent(p));
  const double scale = longest > 0 ? std::exp2(-std::ilogb(longest)) : 1;
  double total = 0;
  for (const Primitive& p : scene.primitives) total += area(p, scale);
  std::vector<std::uint64_t> words;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    if (!scene.primitives[i].emits) continue;
    emitters.lights.push_back(static_cast<int>(i));
    const double share = area(scene.primitives[i], scale) / total;
    words.push_back(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(share * 0x1p32))));
    sum += words.back();
  }
  if (words.empty()) return emitters;
  // Rounding is made good on the largest, which does not feel it.
  auto& largest = *std::max_element(words.begin(), words.end());
  constexpr std::uint64_t kAll = std::uint64_t{1} << 32;
  const bool only_lights = emitters.lights.size() == scene.primitives.size();
  if (sum > kAll || only_lights) largest = largest + kAll - sum;
  std::uint64_t end = 0;
  for (const std::uint64_t count : words) {
    end += count;
    emitters.surface_last.push_back(static_cast<std::uint32_t>(end - 1));
    emitters.surface_probability.push_back(static_cast<double>(count) * 0x1p-32);
  }
  return emitters;
}

bool may_shade(const Scene& scene, const Receiver& receiver, int light, int shape) {
  const Primitive& primitive = scene.primitives[static_cast<std::size_t>(shape)];
  if (light == shape) return false;
  if (shape == receiver.primitive) {
    // A flat shape or the outside of a sphere does not shade its own front; the inside of a sphere does.
    const auto* sphere = std::get_if<Sphere>(&primitive.shape);
    if (!sphere || !inside_sphere(receiver, *sphere, true)) return false;
  }
  const Primitive& target = scene.primitives[static_cast<std::size_t>(light)];
  return light_reaches(receiver, target, light == receiver.primitive) && can_occlude(receiver, target, primitive);
}

template <class T>
LocalPixel<T>::LocalPixel(const Scene& scene, const Emitters& emitters, const Receiver& receiver, const Vec3& to_eye) {
  const Eigen::Matrix3d to_local = frame(receiver.normal);
  const double scale = length_scale(scene, receiver.position);
  copy(Vec3(to_local * to_eye), data.wo);
  for (int i = 0; i < 9; ++i) data.world_to_local[i] = static_cast<T>(to_local(i / 3, i % 3));
  copy_bsdf(scene.primitives[static_cast<std::size_t>(receiver.primitive)].bsdf, data);

  const auto& indices = emitters.lights;
  std::vector<int> light_of(scene.primitives.size(), -1);
  for (std::size_t l = 0; l < indices.size(); ++l) {
    light_of[static_cast<std::size_t>(indices[l])] = static_cast<int>(l);
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(indices[l])];
    const bool own = indices[l] == receiver.primitive;
    LocalLight<T> light;
    light.reaches = light_reaches(receiver, primitive, own);
    light.shape = local_shape<T>(primitive, receiver, to_local, scale, own, static_cast<int>(l));
    const double size = area(primitive, scale);
    light.pdf_area = static_cast<T>(1 / (size * static_cast<double>(indices.size())));
    light.pdf_area_surface = static_cast<T>(emitters.surface_probability[l] / size);
    if (light.reaches) copy(primitive.radiance, light.radiance);
    lights.push_back(light);
  }
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const auto shades = [&](int light) { return may_shade(scene, receiver, light, static_cast<int>(i)); };
    if (std::any_of(indices.begin(), indices.end(), shades)) {
      occluders.push_back(local_shape<T>(scene.primitives[i], receiver, to_local, scale,
                                         static_cast<int>(i) == receiver.primitive, light_of[i]));
    }
  }
  data.lights = lights.data();
  data.light_count = static_cast<int>(lights.size());
  data.surface_last = emitters.surface_last.data();
  data.occluders = occluders.data();
  data.occluder_count = static_cast<int>(occluders.size());
}

template struct LocalPixel<float>;
template struct LocalPixel<double>;

}  // namespace halfslope
