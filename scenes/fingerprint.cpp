#include "scenes/fingerprint.h"

#include <fmt/format.h>

#include <span>

#include "core/hash64.h"
#include "core/numbers.h"

namespace halfslope {
namespace {

/// Text that grows by what is added to it.
class Fingerprint {
 public:
  void add(std::string_view word) { text_ += '\n' + std::string(word); }
  void add(double number) { text_ += ' ' + format_number(number); }
  void add(int number) { text_ += fmt::format(" {}", number); }
  template <class Derived>
  void add(const Eigen::DenseBase<Derived>& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) add(static_cast<double>(numbers.derived().reshaped()(i)));
  }
  template <class Number>
  void add_hash(const std::vector<Number>& numbers) {
    text_ += fmt::format(" {}:{:016x}", numbers.size(), hash64(std::as_bytes(std::span(numbers))));
  }
  void add(const Bitmap& bitmap) {
    add(bitmap.width), add(bitmap.height);
    add_hash(bitmap.rgb);
  }
  void add(const std::shared_ptr<const Texture>& texture) {
    if (!texture) return;
    add("texture");
    add(static_cast<int>(texture->kind)), add(static_cast<int>(texture->filter)), add(static_cast<int>(texture->wrap));
    add(texture->color0), add(texture->color1), add(texture->to_uv);
    if (texture->bitmap) add(*texture->bitmap);
  }
  void add(const Bsdf& bsdf) {
    add("bsdf");
    add(static_cast<int>(bsdf.kind)), add(static_cast<int>(bsdf.distribution));
    add(bsdf.reflectance), add(bsdf.specular), add(bsdf.transmittance), add(bsdf.eta), add(bsdf.k);
    for (const double number : {bsdf.alpha, bsdf.alpha_v.value_or(bsdf.alpha), bsdf.exponent, bsdf.ior, bsdf.opacity}) {
      add(number);
    }
    add(bsdf.unit_fresnel ? 1 : 0), add(bsdf.nonlinear ? 1 : 0);
    add(bsdf.reflectance_texture), add(bsdf.specular_texture), add(bsdf.transmittance_texture);
    add(bsdf.opacity_texture);
  }
  void add(const Sphere& sphere) {
    add("sphere");
    add(sphere.center), add(sphere.radius), add(sphere.flip_normals ? 1 : 0), add(sphere.from_world);
  }
  void add(const Flat& flat) {
    add(flat.outline == Flat::Outline::kDisk ? "disk" : "rectangle");
    add(flat.center), add(flat.half_u), add(flat.half_v), add(flat.normal);
  }
  void add(const Cylinder& cylinder) {
    add("cylinder");
    add(cylinder.p0), add(cylinder.p1), add(cylinder.radius), add(cylinder.flip_normals ? 1 : 0), add(cylinder.start);
  }
  void add(const std::shared_ptr<const Mesh>& mesh) {
    add("mesh");
    add_hash(mesh->positions), add_hash(mesh->normals), add_hash(mesh->uvs), add_hash(mesh->triangles);
  }
  void add(const PointLight& light) {
    add("point");
    add(light.position), add(light.intensity);
  }
  void add(const DirectionalLight& light) {
    add("directional");
    add(light.direction), add(light.irradiance);
  }
  void add(const SpotLight& light) {
    add("spot");
    add(light.position), add(light.axis), add(light.intensity), add(light.cutoff_angle), add(light.beam_width);
  }
  void add(const Environment& environment) {
    add("environment");
    add(environment.radiance), add(environment.scale), add(environment.from_world);
    add(environment.mis_compensation ? 1 : 0);
    if (environment.map) add(*environment.map);
  }
  void add(const Sensor& sensor) {
    add("sensor");
    add(static_cast<int>(sensor.kind)), add(sensor.origin), add(sensor.left), add(sensor.up), add(sensor.forward);
    add(sensor.fov_degrees), add(static_cast<int>(sensor.fov_axis));
    add(sensor.aperture_radius), add(sensor.focus_distance);
    add(static_cast<int>(sensor.filter.kind)), add(sensor.filter.radius), add(sensor.filter.stddev);
    for (const Ray& ray : sensor.rays) add(ray.origin), add(ray.direction);
  }

  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace

std::string scene_fingerprint(const Scene& scene) {
  Fingerprint fingerprint;
  for (const Primitive& primitive : scene.primitives) {
    std::visit([&](const auto& shape) { fingerprint.add(shape); }, primitive.shape);
    fingerprint.add(primitive.bsdf);
    if (primitive.back) fingerprint.add(*primitive.back);
    if (primitive.emits) fingerprint.add("emits"), fingerprint.add(primitive.radiance);
  }
  for (const DeltaLight& light : scene.delta_lights) {
    std::visit([&](const auto& some) { fingerprint.add(some); }, light);
  }
  if (scene.environment) fingerprint.add(*scene.environment);
  fingerprint.add(scene.sensor);
  return std::move(fingerprint).text();
}

}  // namespace halfslope
