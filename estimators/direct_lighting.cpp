#include "estimators/direct_lighting.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "estimators/reflected_light.h"
#include "estimators/skip_worth.h"
#include "scenes/closed_form.h"
#include "scenes/fingerprint.h"

namespace halfslope {
namespace {

/// Whether the technique's first number chooses among several: one light, one surface, or one lobe, is no choice, and
/// takes no dimension.
bool chooses(TransportTechnique technique, std::size_t lights, std::size_t surfaces, bool lobes) {
  switch (technique) {
    case TransportTechnique::kBsdf:
      return lobes;
    case TransportTechnique::kHemisphere:
    case TransportTechnique::kCosine:
      return false;
    case TransportTechnique::kSurface:
      return surfaces > 1;
    default:
      return lights > 1;
  }
}

}  // namespace

DirectLighting::DirectLighting(Scene scene, int width, int height)
    : scene_(with_lights(std::move(scene))),
      plain_(is_plain(scene_)),
      emitters_(plain_ ? find_emitters(scene_) : Emitters{}),
      width_(width),
      height_(height),
      channels_(is_grey(scene_) ? 1 : 3),
      intersector_(scene_),
      tracing_(tracing_of(scene_, intersector_)),
      transport_(scene_, tracing_, false) {
  const bool lobes = chooses_lobes(scene_);
  const std::size_t lights = plain_ ? emitters_.lights.size() : transport_.chosen();
  for (int t = 0; t < kTransportTechniques; ++t) {
    const auto technique = static_cast<TransportTechnique>(t);
    if (technique == TransportTechnique::kSurface && scene_.environment) continue;
    const bool choice = chooses(technique, lights, count_pieces(scene_), lobes);
    techniques_.push_back({kTransportNames[static_cast<std::size_t>(t)], choice ? Layout{{1, 2}} : Layout{{2}},
                           is_directional(technique) ? "" : missed_by_lights(scene_)});
    meanings_.push_back(technique);
  }
  for (std::size_t i = 0; i < scene_.primitives.size(); ++i) {
    if (scene_.primitives[i].emits) lights_.push_back(static_cast<int>(i));
  }
}

Hit DirectLighting::hit(int pixel) const {
  if (plain_) return first_hit(scene_, ray(pixel));
  const SurfaceHit found = intersector_.first(ray(pixel));
  return {found.primitive, found.distance, found.position, found.shading_normal, found.front};
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
  if (!plain_) return std::nullopt;
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
  if (!plain_) return general_pixel(index);
  const Hit seen = hit(index);
  PixelIntegral result;
  result.constant = emitted(seen);
  if (sees_constant(seen)) return result;
  result.integral = plain_light_at({scene_, transport_, techniques_, meanings_, channels_}, emitters_,
                                   {seen.position, seen.normal, seen.primitive}, ray(index), tracing_);
  return result;
}

PixelIntegral DirectLighting::general_pixel(int index) const {
  const Ray eye = ray(index);
  const SeenPoint seen = see(transport_.of<double>().scene(), tracing_.to_kernel(eye.origin), eye.direction);
  PixelIntegral result;
  for (std::size_t c = 0; c < 3; ++c) result.constant[c] = seen.emitted[c] + seen.certain[c];
  if (seen.samples) result.integral = light_at({scene_, transport_, techniques_, meanings_, channels_}, seen.start);
  return result;
}

// Parts of the image: for each shape, the pixels that see it, split by the light nearest to the mirror direction where
// there are few of both.
std::vector<std::string> DirectLighting::regions() const {
  std::vector<std::string> names = {"background"};
  for (const Primitive& shape : scene_.primitives) {
    if (!splits_regions()) names.push_back(shape.id);
    for (const int light : lights_) {
      if (splits_regions()) names.push_back(shape.id + "/" + scene_.primitives[static_cast<std::size_t>(light)].id);
    }
  }
  return names;
}

bool DirectLighting::splits_regions() const {
  constexpr std::size_t kMostRegions = 1000;
  return !lights_.empty() && scene_.primitives.size() * lights_.size() <= kMostRegions;
}

int DirectLighting::region(int pixel) const {
  const Hit seen = hit(pixel);
  if (seen.primitive < 0) return 0;
  if (!splits_regions()) return 1 + seen.primitive;
  const Vec3 d = ray(pixel).direction;
  const Vec3 mirror = d - 2 * d.dot(seen.normal) * seen.normal;
  std::size_t nearest = 0;
  double best = -2;
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    const Vec3 center = middle(scene_.primitives[static_cast<std::size_t>(lights_[l])]);
    const double cosine = mirror.dot((center - seen.position).normalized());
    if (cosine > best) best = cosine, nearest = l;
  }
  return static_cast<int>(1 + static_cast<std::size_t>(seen.primitive) * lights_.size() + nearest);
}

std::vector<std::string> DirectLighting::skips() const { return plain_ ? plain_skips() : general_skips(); }

std::vector<std::string> DirectLighting::general_skips() const {
  std::vector<std::string> lines = {"intersection: " + intersector_.why()};
  int constant = 0;
  for (int p = 0; p < pixels(); ++p) constant += pixel(p).integral ? 0 : 1;
  if (constant > 0) {
    lines.push_back(
        fmt::format("{} of {} pixels see only background, emitters, or what a delta lobe shows: constant, not sampled",
                    constant, pixels()));
  }
  if (transport_.chosen() < transport_.lights().size()) {
    lines.push_back("delta lights are added as constants: what comes from them at one point is no integral");
  }
  if (transport_.chosen() == 1)
    lines.push_back("one light: no light choice, and no dimension for it" + worth(kWorthNoLightChoice));
  if (channels_ == 1) lines.push_back("grey scene: one channel" + worth(kWorthOneChannel));
  return lines;
}

std::vector<std::string> DirectLighting::plain_skips() const {
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
  return fmt::format("direct-lighting {}x{}\n{}", width_, height_, scene_fingerprint(scene_));
}

}  // namespace halfslope
