#include "estimators/direct_lighting.h"

#include <algorithm>
#include <variant>

#include "core/error.h"
#include "core/kernel_library.h"
#include "core/numbers.h"
#include "estimators/kernels.h"
#include "estimators/local_pixel.h"
#include "estimators/skip_worth.h"
#include "scenes/closed_form.h"

namespace halfslope {
namespace {

/// Whether the technique's first number chooses among several: one light, or one surface, is no choice, and takes no
/// dimension.
bool chooses(LightingTechnique technique, const Scene& scene, const Emitters& emitters) {
  if (technique == LightingTechnique::kLight) return emitters.lights.size() > 1;
  return technique == LightingTechnique::kSurface && scene.primitives.size() > 1;
}

/// Reflected light at one point. A pixel is sampled in one precision, and what that needs is made when it is first
/// asked for; an integral belongs to one thread.
class ReflectedLight final : public Integral {
 public:
  ReflectedLight(const Scene& scene, const Emitters& emitters, const Receiver& receiver, const Vec3& to_eye,
                 int channels)
      : scene_(scene), emitters_(emitters), receiver_(receiver), to_eye_(to_eye), channels_(channels) {}

  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const override {
    evaluate(f32_, call, points, terms, kernels_.lighting_f32);
  }
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const override {
    evaluate(f64_, call, points, terms, kernels_.lighting_f64);
  }

 private:
  template <class T>
  void evaluate(std::optional<LocalPixel<T>>& pixel, const TechniqueCall& call, const PointBlock& points,
                TermBlock<T>& terms, void (*kernel)(const LightingCall<T>&)) const {
    if (!pixel) pixel.emplace(scene_, emitters_, receiver_, to_eye_);
    const auto technique = static_cast<LightingTechnique>(call.technique);
    const bool choose = chooses(technique, scene_, emitters_);
    const std::uint32_t *high[3], *low[3];
    for (int d = 0; d < (choose ? 3 : 2); ++d) {
      high[d] = points.high(call.first_dim + d);
      low[d] = points.low(call.first_dim + d);
    }
    T* values[3];
    for (int c = 0; c < channels_; ++c) values[c] = terms.value(call.slot, c);
    T* pdfs[kLightingTechniques] = {};
    for (std::size_t k = 0; k < call.set.size(); ++k) pdfs[call.set[k]] = terms.pdf(call.slot, static_cast<int>(k));
    kernel({&pixel->data, technique, channels_, choose, high, low, points.stride(), values, pdfs});
  }

  const Scene& scene_;
  const Emitters& emitters_;
  Receiver receiver_;
  Vec3 to_eye_;
  int channels_;
  const EstimatorKernels& kernels_ = kernels<EstimatorKernels>();
  mutable std::optional<LocalPixel<float>> f32_;
  mutable std::optional<LocalPixel<double>> f64_;
};

Scene with_lights(Scene scene) {
  for (const Primitive& p : scene.primitives) {
    if (p.emits) return scene;
  }
  fail(ExitCode::kBadInput, "{}: nothing in the scene emits; give a shape an <emitter type=\"area\">", scene.name);
}

}  // namespace

DirectLighting::DirectLighting(Scene scene, int width, int height)
    : scene_(with_lights(std::move(scene))),
      emitters_(find_emitters(scene_)),
      width_(width),
      height_(height),
      channels_(is_grey(scene_) ? 1 : 3) {
  // In the order of LightingTechnique.
  for (const char* name : {"light", "bsdf", "hemisphere", "cosine", "surface"}) {
    const auto technique = static_cast<LightingTechnique>(techniques_.size());
    techniques_.push_back({name, {{2}}});
    if (chooses(technique, scene_, emitters_)) techniques_.back().layout = {{1, 2}};
  }
}

Hit DirectLighting::hit(int pixel) const {
  return first_hit(scene_, scene_.sensor.ray(pixel % width_, pixel / width_, width_, height_));
}

bool DirectLighting::sees_constant(const Hit& hit) const {
  if (hit.primitive < 0 || !hit.front) return true;
  if (is_black(scene_.primitives[static_cast<std::size_t>(hit.primitive)].bsdf)) return true;
  return std::none_of(emitters_.lights.begin(), emitters_.lights.end(), [&](int light) {
    return light_reaches({hit.position, hit.normal, hit.primitive}, scene_.primitives[static_cast<std::size_t>(light)],
                         light == hit.primitive);
  });
}

Color DirectLighting::emitted(const Hit& hit) const {
  if (hit.primitive < 0 || !hit.front) return {0, 0, 0};
  const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(hit.primitive)];
  if (!primitive.emits) return {0, 0, 0};
  return {primitive.radiance[0], primitive.radiance[1], primitive.radiance[2]};
}

// Each light adds ρ L_e · E/(πL), if nothing can come between and that form factor is known.
std::optional<Color> DirectLighting::closed_form(int pixel) const {
  const Hit seen = hit(pixel);
  Color sum = emitted(seen);
  if (sees_constant(seen)) return sum;
  const Bsdf& bsdf = scene_.primitives[static_cast<std::size_t>(seen.primitive)].bsdf;
  if (bsdf.kind != BsdfKind::kDiffuse) return std::nullopt;
  const Receiver receiver = {seen.position, seen.normal, seen.primitive};
  for (const int light : emitters_.lights) {
    const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(light)];
    if (!light_reaches(receiver, primitive, light == seen.primitive)) continue;
    for (std::size_t i = 0; i < scene_.primitives.size(); ++i) {
      if (may_shade(scene_, receiver, light, static_cast<int>(i))) return std::nullopt;
    }
    // Only the inside of a sphere is lit by itself: from all around.
    const bool own = light == seen.primitive;
    const auto factor = own ? std::optional(1.0) : form_factor(primitive, seen.position, seen.normal);
    if (!factor) return std::nullopt;
    for (int c = 0; c < 3; ++c) {
      sum[static_cast<std::size_t>(c)] += bsdf.reflectance[c] * primitive.radiance[c] * *factor;
    }
  }
  return sum;
}

PixelIntegral DirectLighting::pixel(int index) const {
  const Hit seen = hit(index);
  PixelIntegral result;
  result.constant = emitted(seen);
  if (sees_constant(seen)) return result;
  const Receiver receiver = {seen.position, seen.normal, seen.primitive};
  const Ray ray = scene_.sensor.ray(index % width_, index / width_, width_, height_);
  result.integral = std::make_unique<ReflectedLight>(scene_, emitters_, receiver, -ray.direction, channels_);
  return result;
}

// Parts of the image: for each shape, the pixels that see it, split by the light nearest to the mirror direction.
std::vector<std::string> DirectLighting::regions() const {
  std::vector<std::string> names = {"background"};
  for (const Primitive& shape : scene_.primitives) {
    for (const int light : emitters_.lights)
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
  const auto& lights = emitters_.lights;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const Vec3 center = middle(scene_.primitives[static_cast<std::size_t>(lights[l])]);
    const double cosine = mirror.dot((center - seen.position).normalized());
    if (cosine > best) best = cosine, nearest = l;
  }
  return static_cast<int>(1 + static_cast<std::size_t>(seen.primitive) * lights.size() + nearest);
}

std::vector<std::string> DirectLighting::skips() const {
  int constant = 0, unshadowed = 0, known = 0;
  for (int p = 0; p < pixels(); ++p) {
    const Hit seen = hit(p);
    known += closed_form(p) ? 1 : 0;
    if (sees_constant(seen)) {
      ++constant;
      continue;
    }
    const Receiver receiver = {seen.position, seen.normal, seen.primitive};
    const auto shaded = [&](int light) {
      for (std::size_t i = 0; i < scene_.primitives.size(); ++i) {
        if (may_shade(scene_, receiver, light, static_cast<int>(i))) return true;
      }
      return false;
    };
    unshadowed += std::none_of(emitters_.lights.begin(), emitters_.lights.end(), shaded) ? 1 : 0;
  }
  std::vector<std::string> lines;
  if (known == pixels() && constant < pixels()) {
    lines.push_back("recognised: diffuse receivers under unoccluded polygon, disk or sphere lights, in closed form");
  }
  if (constant > 0) {
    lines.push_back(fmt::format(
        "{} of {} pixels see only background, what does not reflect or what no light reaches: constant, not sampled",
        constant, pixels()));
  }
  if (unshadowed > 0) {
    lines.push_back(fmt::format(
        "{} of {} sampled pixels have nothing that could come between them and a light: no shadow rays there{}",
        unshadowed, pixels() - constant, worth(kWorthNoShadowRay)));
  }
  if (emitters_.lights.size() == 1)
    lines.push_back("one light: no light choice, and no dimension for it" + worth(kWorthNoLightChoice));
  if (channels_ == 1) lines.push_back("grey scene: one channel" + worth(kWorthOneChannel));
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
      if (r.outline == Flat::Outline::kDisk) text += " disk";
      add(r.center), add(r.half_u), add(r.half_v), add(r.normal);
    }
    add(p.radiance);
    text += fmt::format(" {} {} {}", static_cast<int>(p.bsdf.kind), format_number(p.bsdf.alpha), p.bsdf.unit_fresnel);
    add(p.bsdf.reflectance), add(p.bsdf.eta), add(p.bsdf.k);
    if (p.bsdf.kind == BsdfKind::kPhong) add(p.bsdf.specular), text += ' ' + format_number(p.bsdf.exponent);
  }
  for (int pixel = 0; pixel < pixels(); pixel += std::max(1, pixels() - 1)) {
    const Ray ray = scene_.sensor.ray(pixel % width_, pixel / width_, width_, height_);
    add(ray.origin), add(ray.direction);
  }
  for (const Ray& ray : scene_.sensor.rays) add(ray.origin), add(ray.direction);
  return text;
}

}  // namespace halfslope
