#include "experiments/scene_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "estimators/direct_lighting.h"
#include "scenes/intersector.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

// Up to so many shapes a look at the scene takes no time.
constexpr std::size_t kLookedAt = 200;

std::string type_of(const Shape& shape) {
  if (std::holds_alternative<Sphere>(shape)) return "sphere";
  if (std::holds_alternative<Cylinder>(shape)) return "cylinder";
  if (const auto* flat = std::get_if<Flat>(&shape)) {
    return flat->outline == Flat::Outline::kDisk ? "disk" : "rectangle";
  }
  return "mesh";
}

std::string type_of(const Bsdf& bsdf) {
  if (is_black(bsdf)) return "black";
  switch (bsdf.kind) {
    case BsdfKind::kDiffuse:
      return "diffuse";
    case BsdfKind::kRoughConductor:
      return "roughconductor";
    case BsdfKind::kPhong:
      return "phong";
    case BsdfKind::kConductor:
      return "conductor";
    case BsdfKind::kPlastic:
      return "plastic";
    case BsdfKind::kRoughPlastic:
      return "roughplastic";
    case BsdfKind::kDielectric:
      return "dielectric";
    case BsdfKind::kRoughDielectric:
      return "roughdielectric";
  }
  return "unknown";
}

bool is_masked(const Bsdf& bsdf) { return bsdf.opacity != 1 || bsdf.opacity_texture != nullptr; }

/// Whether some light goes on in one direction alone.
bool has_delta_lobe(const Bsdf& bsdf) {
  const bool smooth =
      bsdf.kind == BsdfKind::kConductor || bsdf.kind == BsdfKind::kPlastic || bsdf.kind == BsdfKind::kDielectric;
  return is_masked(bsdf) || (smooth && !is_black(bsdf));
}

void add_textures(const Bsdf& bsdf, std::set<std::shared_ptr<const Texture>>& textures) {
  for (const auto& texture :
       {bsdf.reflectance_texture, bsdf.specular_texture, bsdf.transmittance_texture, bsdf.opacity_texture}) {
    if (texture) textures.insert(texture);
  }
}

LightSummary summary_of(const PointLight& light) { return {"point", "", 4 * kPi * light.intensity, "W"}; }

LightSummary summary_of(const DirectionalLight& light) { return {"directional", "", light.irradiance, "W/m^2"}; }

LightSummary summary_of(const SpotLight& light) { return {"spot", "", solid_angle(light) * light.intensity, "W"}; }

/// The radiance integrated over the sphere.
LightSummary summary_of(const Environment& environment) {
  return {environment.map ? "envmap" : "constant", "", 4 * kPi * mean_radiance(environment), "W/m^2"};
}

std::string describe(const Sensor& sensor) {
  switch (sensor.kind) {
    case Sensor::Kind::kRays:
      return fmt::format("{} ray{}, given one by one", sensor.rays.size(), sensor.rays.size() == 1 ? "" : "s");
    case Sensor::Kind::kPerspective:
      return fmt::format("perspective, {} x {}", sensor.width, sensor.height);
    case Sensor::Kind::kThinLens:
      return fmt::format("thinlens of radius {}, {} x {}", sensor.aperture_radius, sensor.width, sensor.height);
    case Sensor::Kind::kOrthographic:
      return fmt::format("orthographic, {} x {}", sensor.width, sensor.height);
  }
  return "unknown";
}

std::string describe(const ReconstructionFilter& filter) {
  const char* names[] = {"box", "tent", "gaussian"};
  return fmt::format("{}, radius {} pixels", names[static_cast<int>(filter.kind)], filter.radius);
}

/// Why direct lighting's own kernels do not take the scene; empty if they do.
std::string why_not_plain(const Scene& scene) {
  if (is_plain(scene)) return "";
  if (scene.environment) return "light comes from all around";
  if (!scene.delta_lights.empty()) return "a light has no surface";
  for (const Primitive& primitive : scene.primitives) {
    const std::string type = type_of(primitive.shape);
    if (type == "mesh" || type == "cylinder") return fmt::format("'{}' is a {}", primitive.id, type);
    if (primitive.back) return fmt::format("'{}' has two sides", primitive.id);
    if (primitive.bsdf.textured()) return fmt::format("'{}' has a texture", primitive.id);
    if (is_masked(primitive.bsdf)) return fmt::format("'{}' has a mask", primitive.id);
    Scene alone;
    alone.primitives = {primitive};
    if (is_plain(alone)) continue;
    const bool rough = primitive.bsdf.kind == BsdfKind::kRoughConductor;
    return fmt::format("'{}' is a {}{}", primitive.id, type_of(primitive.bsdf),
                       !rough                   ? ""
                       : primitive.bsdf.alpha_v ? " of two roughnesses"
                                                : " by beckmann");
  }
  return "";
}

/// What a look at a small image says beforehand, or what the kinds of things in the scene say.
std::vector<std::string> skips_of(const Scene& scene, std::size_t lights) {
  std::vector<std::string> lines;
  if (lights == 0) lines.push_back("no light: there is nothing to measure, and estimators refuse the scene");
  const std::string why = why_not_plain(scene);
  if (why.empty() && lights > 0 && scene.primitives.size() <= kLookedAt) {
    const bool rays = scene.sensor.kind == Sensor::Kind::kRays;
    const double shrink = rays ? 1 : std::max(1.0, std::max(scene.sensor.width, scene.sensor.height) / 64.0);
    const int width = std::max(1, static_cast<int>(scene.sensor.width / shrink)),
              height = std::max(1, static_cast<int>(scene.sensor.height / shrink));
    for (const std::string& line : DirectLighting(scene, width, height).skips()) lines.push_back(line);
    if (!rays) lines.push_back(fmt::format("(pixels of an image of {} x {})", width, height));
  } else {
    if (lights == 1) lines.push_back("one light: no light choice, and no dimension for it");
    if (is_grey(scene)) lines.push_back("grey scene: one channel");
  }
  const bool deltas = std::any_of(scene.primitives.begin(), scene.primitives.end(), [](const Primitive& primitive) {
    return has_delta_lobe(primitive.bsdf) || (primitive.back && has_delta_lobe(*primitive.back));
  });
  if (!deltas) lines.push_back("no mirror, smooth glass or mask: every surface can be connected with every light");
  lines.push_back(why.empty() ? "plain: direct lighting's own kernels" : "no own kernels of direct lighting: " + why);
  lines.push_back(why_traced(count_pieces(scene)));
  return lines;
}

}  // namespace

SceneSummary summarise(const Scene& scene) {
  SceneSummary summary;
  std::set<std::shared_ptr<const Texture>> textures;
  for (const Primitive& primitive : scene.primitives) {
    ++summary.shapes[type_of(primitive.shape)];
    ++summary.materials[type_of(primitive.bsdf)];
    if (primitive.back) ++summary.materials["twosided"];
    if (is_masked(primitive.bsdf)) ++summary.materials["mask"];
    add_textures(primitive.bsdf, textures);
    if (primitive.back) add_textures(*primitive.back, textures);
    if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&primitive.shape)) {
      summary.triangles += (*mesh)->triangles.size();
      summary.degenerate += (*mesh)->degenerate;
    }
    if (primitive.emits) {
      summary.lights.push_back({"area", primitive.id, kPi * area(primitive) * primitive.radiance, "W"});
    }
  }
  for (const auto& texture : textures) {
    ++summary.textures[texture->kind == Texture::Kind::kBitmap ? "bitmap" : "checkerboard"];
  }
  for (const DeltaLight& light : scene.delta_lights) {
    summary.lights.push_back(std::visit([](const auto& of) { return summary_of(of); }, light));
  }
  if (scene.environment) summary.lights.push_back(summary_of(*scene.environment));
  summary.pieces = count_pieces(scene);
  summary.sensor = describe(scene.sensor);
  summary.filter = scene.sensor.kind == Sensor::Kind::kRays ? "none" : describe(scene.sensor.filter);
  summary.skips = skips_of(scene, summary.lights.size());
  return summary;
}

}  // namespace halfslope
