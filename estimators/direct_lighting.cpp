#include "estimators/direct_lighting.h"

#include <Eigen/Geometry>
#include <cmath>
#include <variant>

#include "core/error.h"
#include "core/kernel_library.h"
#include "core/numbers.h"
#include "estimators/kernels.h"
#include "estimators/occlusion.h"

namespace halfslope {
namespace {

constexpr int kLight = 0, kBsdf = 1;

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

/// A power of two by which lengths around the receiver become at most about 1. Kernels square them, and binary32 has
/// no squares of lengths beyond 1e±19.
double length_scale(const Scene& scene, const Receiver& receiver) {
  double farthest = 0;
  for (const Primitive& primitive : scene.primitives) {
    const Vec3 center = std::visit([](const auto& s) { return s.center; }, primitive.shape);
    farthest = std::max(farthest, (center - receiver.position).stableNorm());
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
  const auto& r = std::get<Flat>(primitive.shape);
  const Vec3 center = scale * (r.center - receiver.position), half_u = scale * r.half_u, half_v = scale * r.half_v;
  shape.is_sphere = false;
  copy(Vec3(to_local * center), shape.center);
  copy(Vec3(to_local * half_u), shape.u);
  copy(Vec3(to_local * half_v), shape.v);
  copy(Vec3(to_local * r.normal), shape.normal);
  shape.plane = static_cast<T>(r.normal.dot(center));
  shape.inv_u2 = static_cast<T>(1 / half_u.squaredNorm());
  shape.inv_v2 = static_cast<T>(1 / half_v.squaredNorm());
  return shape;
}

/// One pixel in one precision.
template <class T>
struct Local {
  PixelData<T> data;
  std::vector<LocalLight<T>> lights;
  std::vector<LocalShape<T>> occluders;

  Local(const Scene& scene, const std::vector<int>& light_indices, const Receiver& receiver, const Vec3& to_eye) {
    const Eigen::Matrix3d to_local = frame(receiver.normal);
    const double scale = length_scale(scene, receiver);
    copy(Vec3(to_local * to_eye), data.wo);
    for (int i = 0; i < 9; ++i) data.world_to_local[i] = static_cast<T>(to_local(i / 3, i % 3));
    const Bsdf& bsdf = scene.primitives[static_cast<std::size_t>(receiver.primitive)].bsdf;
    data.bsdf = bsdf.kind;
    data.unit_fresnel = bsdf.unit_fresnel;
    data.alpha = static_cast<T>(bsdf.alpha);
    copy(bsdf.reflectance, data.reflectance);
    copy(bsdf.eta, data.eta);
    copy(bsdf.k, data.k);

    std::vector<int> light_of(scene.primitives.size(), -1);
    for (std::size_t l = 0; l < light_indices.size(); ++l)
      light_of[static_cast<std::size_t>(light_indices[l])] = static_cast<int>(l);
    for (const int index : light_indices) {
      const Primitive& primitive = scene.primitives[static_cast<std::size_t>(index)];
      LocalLight<T> light;
      const bool own = index == receiver.primitive;
      light.reaches = light_reaches(receiver, primitive, own);
      light.shape =
          local_shape<T>(primitive, receiver, to_local, scale, own, light_of[static_cast<std::size_t>(index)]);
      light.pdf_area = static_cast<T>(1 / (area(primitive, scale) * static_cast<double>(light_indices.size())));
      if (light.reaches) copy(primitive.radiance, light.radiance);
      lights.push_back(light);
    }
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
      if (blocks_some_light(scene, light_indices, receiver, static_cast<int>(i))) {
        occluders.push_back(local_shape<T>(scene.primitives[i], receiver, to_local, scale,
                                           static_cast<int>(i) == receiver.primitive, light_of[i]));
      }
    }
    data.lights = lights.data();
    data.light_count = static_cast<int>(lights.size());
    data.occluders = occluders.data();
    data.occluder_count = static_cast<int>(occluders.size());
  }

  static bool blocks_some_light(const Scene& scene, const std::vector<int>& light_indices, const Receiver& receiver,
                                int index) {
    const Primitive& shape = scene.primitives[static_cast<std::size_t>(index)];
    if (index == receiver.primitive) {
      // A rectangle or the outside of a sphere does not shade its own front; the inside of a sphere does.
      const auto* sphere = std::get_if<Sphere>(&shape.shape);
      if (!sphere || !inside_sphere(receiver, *sphere, true)) return false;
    }
    for (const int light : light_indices) {
      const Primitive& primitive = scene.primitives[static_cast<std::size_t>(light)];
      if (light != index && light_reaches(receiver, primitive, light == receiver.primitive) &&
          can_occlude(receiver, primitive, shape)) {
        return true;
      }
    }
    return false;
  }
};

class ReflectedLight final : public Integral {
 public:
  ReflectedLight(const Scene& scene, const std::vector<int>& lights, const Receiver& receiver, const Vec3& to_eye,
                 int channels)
      : channels_(channels), f32_(scene, lights, receiver, to_eye), f64_(scene, lights, receiver, to_eye) {}

  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const override {
    evaluate(f32_.data, call, points, terms, call.technique == kLight ? kernels_.light_f32 : kernels_.bsdf_f32);
  }
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const override {
    evaluate(f64_.data, call, points, terms, call.technique == kLight ? kernels_.light_f64 : kernels_.bsdf_f64);
  }

 private:
  template <class T>
  void evaluate(const PixelData<T>& pixel, const TechniqueCall& call, const PointBlock& points, TermBlock<T>& terms,
                void (*kernel)(const LightingCall<T>&)) const {
    const std::uint32_t *high[3], *low[3];
    const int dims = call.technique == kLight ? (pixel.light_count > 1 ? 3 : 2) : 2;
    for (int d = 0; d < dims; ++d) {
      high[d] = points.high(call.first_dim + d);
      low[d] = points.low(call.first_dim + d);
    }
    T* values[3];
    for (int c = 0; c < channels_; ++c) values[c] = terms.value(call.slot, c);
    T* pdfs[2] = {nullptr, nullptr};
    for (std::size_t k = 0; k < call.set.size(); ++k) pdfs[call.set[k]] = terms.pdf(call.slot, static_cast<int>(k));
    kernel({&pixel, channels_, high, low, points.stride(), values, pdfs[kLight], pdfs[kBsdf]});
  }

  int channels_;
  const EstimatorKernels& kernels_ = kernels<EstimatorKernels>();
  Local<float> f32_;
  Local<double> f64_;
};

Scene with_lights(Scene scene) {
  for (const Primitive& p : scene.primitives) {
    if (p.emits) return scene;
  }
  fail(ExitCode::kBadInput, "{}: nothing in the scene emits; give a shape an <emitter type=\"area\">", scene.name);
}

}  // namespace

DirectLighting::DirectLighting(Scene scene, int width, int height)
    : scene_(with_lights(std::move(scene))), width_(width), height_(height), channels_(is_grey(scene_) ? 1 : 3) {
  for (std::size_t i = 0; i < scene_.primitives.size(); ++i) {
    if (scene_.primitives[i].emits) lights_.push_back(static_cast<int>(i));
  }
  // One light is no choice, and takes no dimension.
  techniques_ = {{"light", {lights_.size() > 1 ? std::vector<std::uint8_t>{1, 2} : std::vector<std::uint8_t>{2}}},
                 {"bsdf", {{2}}}};
}

Hit DirectLighting::hit(int pixel) const {
  return first_hit(scene_, scene_.sensor.ray(pixel % width_, pixel / width_, width_, height_));
}

bool DirectLighting::sees_constant(const Hit& hit) const {
  if (hit.primitive < 0 || !hit.front) return true;
  return is_black(scene_.primitives[static_cast<std::size_t>(hit.primitive)].bsdf);
}

PixelIntegral DirectLighting::pixel(int index) const {
  const Hit seen = hit(index);
  PixelIntegral result;
  if (seen.primitive < 0) return result;
  const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(seen.primitive)];
  if (primitive.emits && seen.front)
    result.constant = {primitive.radiance[0], primitive.radiance[1], primitive.radiance[2]};
  if (sees_constant(seen)) return result;
  const Receiver receiver = {seen.position, seen.normal, seen.primitive};
  const Ray ray = scene_.sensor.ray(index % width_, index / width_, width_, height_);
  result.integral = std::make_unique<ReflectedLight>(scene_, lights_, receiver, -ray.direction, channels_);
  return result;
}

// Parts of the image: for each shape, the pixels that see it, split by the light nearest to the mirror direction.
std::vector<std::string> DirectLighting::regions() const {
  std::vector<std::string> names = {"background"};
  for (const Primitive& shape : scene_.primitives) {
    for (const int light : lights_)
      names.push_back(shape.id + "/" + scene_.primitives[static_cast<std::size_t>(light)].id);
  }
  return names;
}

int DirectLighting::region(int pixel) const {
  const Hit seen = hit(pixel);
  if (seen.primitive < 0) return 0;
  const Vec3 d = scene_.sensor.ray(pixel % width_, pixel / width_, width_, height_).direction;
  const Vec3 mirror = d - 2 * d.dot(seen.normal) * seen.normal;
  std::size_t nearest = 0;
  double best = -2;
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    const auto& shape = scene_.primitives[static_cast<std::size_t>(lights_[l])].shape;
    const Vec3 center = std::visit([](const auto& s) { return s.center; }, shape);
    const double cosine = mirror.dot((center - seen.position).normalized());
    if (cosine > best) best = cosine, nearest = l;
  }
  return static_cast<int>(1 + static_cast<std::size_t>(seen.primitive) * lights_.size() + nearest);
}

std::vector<std::string> DirectLighting::skips() const {
  int constant = 0, unshadowed = 0, sampled = 0;
  for (int p = 0; p < pixels(); ++p) {
    const Hit seen = hit(p);
    if (sees_constant(seen)) {
      ++constant;
      continue;
    }
    ++sampled;
    const Receiver receiver = {seen.position, seen.normal, seen.primitive};
    bool occluded = false;
    for (std::size_t i = 0; i < scene_.primitives.size() && !occluded; ++i) {
      occluded = Local<float>::blocks_some_light(scene_, lights_, receiver, static_cast<int>(i));
    }
    unshadowed += occluded ? 0 : 1;
  }
  std::vector<std::string> lines;
  if (constant > 0) {
    lines.push_back(fmt::format("{} of {} pixels see only background or what does not reflect: constant, not sampled",
                                constant, pixels()));
  }
  if (unshadowed > 0) {
    lines.push_back(
        fmt::format("{} of {} sampled pixels have nothing that could come between them and a light: no shadow rays",
                    unshadowed, sampled));
  }
  if (lights_.size() == 1) lines.push_back("one light: no light choice, and no dimension for it");
  if (channels_ == 1) lines.push_back("grey scene: one channel");
  return lines;
}

std::string DirectLighting::fingerprint() const {
  std::string text = fmt::format("direct-lighting {}x{}", width_, height_);
  const auto add = [&](const auto& v) {
    for (int i = 0; i < 3; ++i) text += " " + format_number(v[i]);
  };
  for (const Primitive& p : scene_.primitives) {
    text += p.emits ? "\nemitter" : "\nshape";
    if (const auto* s = std::get_if<Sphere>(&p.shape)) {
      add(s->center);
      text += fmt::format(" {} {}", format_number(s->radius), s->flip_normals);
    } else {
      const auto& r = std::get<Flat>(p.shape);
      add(r.center), add(r.half_u), add(r.half_v), add(r.normal);
    }
    add(p.radiance);
    text += fmt::format(" {} {} {}", static_cast<int>(p.bsdf.kind), format_number(p.bsdf.alpha), p.bsdf.unit_fresnel);
    add(p.bsdf.reflectance), add(p.bsdf.eta), add(p.bsdf.k);
  }
  for (int pixel = 0; pixel < pixels(); pixel += std::max(1, pixels() - 1)) {
    const Ray ray = scene_.sensor.ray(pixel % width_, pixel / width_, width_, height_);
    add(ray.origin), add(ray.direction);
  }
  for (const Ray& ray : scene_.sensor.rays) add(ray.origin), add(ray.direction);
  return text;
}

}  // namespace halfslope
