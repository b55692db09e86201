#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "estimators/transport_data.h"
#include "scenes/shape_hits.h"

namespace halfslope {
namespace {

template <class T, class From>
void copy(const From& from, T (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(from[i]);
}

double mean(const Rgb& colour) { return colour.mean(); }

LightKind kind_of(const Shape& shape) {
  if (std::holds_alternative<Sphere>(shape)) return LightKind::kSphere;
  if (std::holds_alternative<Cylinder>(shape)) return LightKind::kCylinder;
  const auto* flat = std::get_if<Flat>(&shape);
  if (!flat) return LightKind::kTriangle;
  return flat->outline == Flat::Outline::kDisk ? LightKind::kDisk : LightKind::kRectangle;
}

/// Triangle by triangle.
std::vector<double> areas_of(const Shape& shape, double all) {
  const auto* pointer = std::get_if<std::shared_ptr<const Mesh>>(&shape);
  if (!pointer) return {all};
  const Mesh& mesh = **pointer;
  std::vector<double> areas;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 p0 = corner(mesh, t, 0);
    areas.push_back(0.5 * (corner(mesh, t, 1) - p0).cross(corner(mesh, t, 2) - p0).norm());
  }
  return areas;
}

/// Half the diagonal of the box around all shapes: a ball of that radius about its middle holds them.
double scene_radius(const Scene& scene) {
  const Eigen::AlignedBox3d box = bounds_of(scene);
  return box.isEmpty() ? 1 : 0.5 * box.diagonal().norm();
}

/// Shares of 2³² words in the proportions of `weights`, at least one word each: `last` of a LightTable and the words'
/// probabilities.
template <class T>
void make_table(const std::vector<double>& weights, std::vector<std::uint32_t>& last, std::vector<T>& probability) {
  double sum = 0;
  for (const double w : weights) sum += w;
  const auto count = static_cast<std::uint64_t>(weights.size());
  const double spare = 0x1p32 - static_cast<double>(count);
  double before = 0;
  std::uint64_t begin = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    before += weights[i];
    // One word each, and of the others what the running sum says; the last takes all that is left.
    std::uint64_t end = static_cast<std::uint64_t>(i) + 1 +
                        static_cast<std::uint64_t>(sum > 0 ? std::floor(before / sum * spare) : 0.0);
    if (i + 1 == weights.size()) end = std::uint64_t{1} << 32;
    end = std::clamp(end, begin + 1, (std::uint64_t{1} << 32) - (count - 1 - static_cast<std::uint64_t>(i)));
    last.push_back(static_cast<std::uint32_t>(end - 1));
    probability.push_back(static_cast<T>(static_cast<double>(end - begin) * 0x1p-32));
    begin = end;
  }
}

/// A light as the tree of lights has it, in the kernels' lengths.
LightLeaf leaf_of(const Scene& scene, const Tracing& tracing, const LightSource& light) {
  LightLeaf leaf;
  leaf.power = light.power;
  leaf.everywhere = light.kind == LightKind::kEnvironment || light.kind == LightKind::kDirectional;
  if (leaf.everywhere) return leaf;
  Eigen::AlignedBox3d box;
  Vec3 axis = Vec3::UnitZ();
  if (light.primitive < 0) {
    const DeltaLight& source = scene.delta_lights[light.delta];
    if (const auto* spot = std::get_if<SpotLight>(&source)) {
      box.extend(tracing.to_kernel(spot->position));
      axis = spot->axis;
      // Its rays are the normals, as far as the beam reaches; beyond it they fade to the cutoff.
      leaf.cos_normals = std::cos(spot->beam_width);
      leaf.cos_emission = std::cos(std::max(spot->cutoff_angle - spot->beam_width, 0.0));
    } else {
      box.extend(tracing.to_kernel(std::get<PointLight>(source).position));
    }
  } else {
    const Shape& shape = scene.primitives[static_cast<std::size_t>(light.primitive)].shape;
    if (const auto* flat = std::get_if<Flat>(&shape)) {
      const Vec3 reach = flat->half_u.cwiseAbs() + flat->half_v.cwiseAbs();
      box.extend(tracing.to_kernel(flat->center - reach)), box.extend(tracing.to_kernel(flat->center + reach));
      axis = flat->normal, leaf.cos_normals = 1;
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
      const Vec3 reach = Vec3::Constant(sphere->radius);
      box.extend(tracing.to_kernel(sphere->center - reach)), box.extend(tracing.to_kernel(sphere->center + reach));
    } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      const Vec3 reach = Vec3::Constant(cylinder->radius);
      for (const Vec3& end : {cylinder->p0, cylinder->p1}) {
        box.extend(tracing.to_kernel(end - reach)), box.extend(tracing.to_kernel(end + reach));
      }
    } else {
      const Mesh& mesh = *std::get<std::shared_ptr<const Mesh>>(shape);
      const auto corner = [&](std::size_t i) -> Vec3 {
        const auto index = mesh.triangles[static_cast<std::size_t>(light.triangle)][i];
        return Eigen::Vector3f(mesh.positions[index].data()).cast<double>();
      };
      for (std::size_t i = 0; i < 3; ++i) box.extend(tracing.to_kernel(corner(i)));
      axis = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized(), leaf.cos_normals = 1;
    }
  }
  for (int k = 0; k < 3; ++k) {
    leaf.lower[k] = box.min()[k], leaf.upper[k] = box.max()[k], leaf.axis[k] = axis[k];
  }
  return leaf;
}

}  // namespace

std::vector<LightSource> list_lights(const Scene& scene) {
  std::vector<LightSource> lights, beyond;
  const double radius = scene_radius(scene), disk = std::numbers::pi * radius * radius;
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const Primitive& primitive = scene.primitives[p];
    if (!primitive.emits || !(primitive.radiance > 0).any()) continue;
    const double all = area(primitive);
    const std::vector<double> areas = areas_of(primitive.shape, all);
    for (std::size_t t = 0; t < areas.size(); ++t) {
      LightSource light = {kind_of(primitive.shape), static_cast<int>(p), static_cast<int>(t)};
      light.radiance = primitive.radiance;
      light.area = areas[t];
      light.power = std::numbers::pi * areas[t] * mean(primitive.radiance);
      light.share = areas[t] / all;
      lights.push_back(light);
    }
  }
  for (std::size_t d = 0; d < scene.delta_lights.size(); ++d) {
    LightSource light;
    light.delta = d;
    if (const auto* point = std::get_if<PointLight>(&scene.delta_lights[d])) {
      light.kind = LightKind::kPoint;
      light.radiance = point->intensity;
      light.power = 4 * std::numbers::pi * mean(point->intensity);
    } else if (const auto* spot = std::get_if<SpotLight>(&scene.delta_lights[d])) {
      light.kind = LightKind::kSpot;
      light.radiance = spot->intensity;
      light.power = solid_angle(*spot) * mean(spot->intensity);
    } else {
      const auto& far = std::get<DirectionalLight>(scene.delta_lights[d]);
      light.kind = LightKind::kDirectional;
      light.radiance = far.irradiance;
      light.power = disk * mean(far.irradiance);
    }
    if (!(light.radiance > 0).any()) continue;
    (light.kind == LightKind::kDirectional ? beyond : lights).push_back(light);
  }
  if (scene.environment) {
    LightSource light;
    light.kind = LightKind::kEnvironment;
    light.radiance = mean_radiance(*scene.environment);
    light.power = std::numbers::pi * disk * mean(light.radiance);
    if ((light.radiance > 0).any()) beyond.push_back(light);
  }
  lights.insert(lights.end(), beyond.begin(), beyond.end());
  return lights;
}

Scene with_lights(Scene scene) {
  if (!list_lights(scene).empty()) return scene;
  fail(ExitCode::kBadInput,
       "{}: nothing in the scene emits; give a shape an <emitter type=\"area\">, or the scene an emitter", scene.name);
}

std::string missed_by_lights(const Scene& scene) {
  const bool compensated = scene.environment && scene.environment->map && scene.environment->mis_compensation;
  return compensated ? "what the envmap's mis_compensation leaves to the BSDF" : "";
}

bool is_delta(LightKind kind) {
  return kind == LightKind::kPoint || kind == LightKind::kSpot || kind == LightKind::kDirectional;
}

LazyTransport::LazyTransport(const Scene& scene, const Tracing& tracing, bool draws_delta_lights)
    : scene_(scene), tracing_(tracing), lights_(list_lights(scene)), chosen_(lights_.size()) {
  if (draws_delta_lights) return;
  const auto rest = std::stable_partition(lights_.begin(), lights_.end(),
                                          [](const LightSource& light) { return !is_delta(light.kind); });
  chosen_ = static_cast<std::size_t>(rest - lights_.begin());
}

template <class T>
void TransportData<T>::add_lights(const Scene& scene, const Tracing& tracing, const std::vector<LightSource>& lights,
                                  std::size_t chosen) {
  std::vector<double> uniform, power, surface;
  scene_.environment_light = -1;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const LightSource& light = lights[l];
    LightElement<T> element = {};
    element.kind = light.kind;
    element.piece = -1;
    copy(light.radiance, element.radiance);
    if (light.primitive >= 0) {
      element.piece = piece(light.primitive, light.triangle);
      element.pdf_area = static_cast<T>(1 / (light.area * tracing.unit * tracing.unit));
      sides_[static_cast<std::size_t>(element.piece)].light = static_cast<std::int32_t>(l);
    } else if (light.kind == LightKind::kEnvironment) {
      scene_.environment_light = static_cast<std::int32_t>(l);
    } else if (light.kind == LightKind::kDirectional) {
      copy(std::get<DirectionalLight>(scene.delta_lights[light.delta]).direction, element.axis);
    } else {
      // Intensity over a squared distance in the kernels' lengths is irradiance in the scene's.
      copy(Rgb(tracing.unit * tracing.unit * light.radiance), element.radiance);
      if (const auto* spot = std::get_if<SpotLight>(&scene.delta_lights[light.delta])) {
        copy(tracing.to_kernel(spot->position), element.position);
        copy(spot->axis, element.axis);
        element.cutoff = static_cast<T>(spot->cutoff_angle);
        element.beam_width = static_cast<T>(spot->beam_width);
        const double fade = spot->cutoff_angle - spot->beam_width;
        element.inverse_fade = static_cast<T>(fade > 0 ? 1 / fade : 0);
      } else {
        copy(tracing.to_kernel(std::get<PointLight>(scene.delta_lights[light.delta]).position), element.position);
      }
    }
    lights_.push_back(element);
    if (l >= chosen) continue;
    uniform.push_back(light.share);
    power.push_back(light.power);
    surface.push_back(light.area);
  }
  if (chosen > 0) {
    make_table(uniform, uniform_last_, uniform_probability_);
    make_table(power, power_last_, power_probability_);
    double dark = 0;
    for (const Primitive& primitive : scene.primitives) dark += area(primitive);
    for (const double lit : surface) dark -= lit;
    surface.push_back(std::max(dark, 0.0));
    make_table(surface, surface_last_, surface_probability_);
  }
  scene_.lights = lights_.data();
  scene_.light_count = static_cast<std::int32_t>(chosen);
  scene_.certain_count = static_cast<std::int32_t>(lights_.size() - chosen);
  scene_.uniform = {uniform_last_.data(), uniform_probability_.data()};
  scene_.power = {power_last_.data(), power_probability_.data()};
  scene_.surface = {surface_last_.data(), surface_probability_.data()};
  if (scene_.environment_light >= 0) {
    environment_ = std::make_unique<EnvironmentMap<T>>(*scene.environment);
    scene_.environment = &environment_->data();
  }
  if (chosen == 0) return;
  std::vector<LightLeaf> leaves;
  for (std::size_t l = 0; l < chosen; ++l) leaves.push_back(leaf_of(scene, tracing, lights[l]));
  bvh_ = std::make_unique<LightBvh<T>>(leaves);
  scene_.bvh = bvh_->data();
}

template void TransportData<float>::add_lights(const Scene&, const Tracing&, const std::vector<LightSource>&,
                                               std::size_t);
template void TransportData<double>::add_lights(const Scene&, const Tracing&, const std::vector<LightSource>&,
                                                std::size_t);

}  // namespace halfslope
