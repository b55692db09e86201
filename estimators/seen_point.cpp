#include "estimators/seen_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "estimators/transport_vertex.h"

namespace halfslope {
namespace {

using kernel::RayRow;
using kernel::Surface;

/// A row whose first ray alone is traced.
RayRow<double> lone_ray(const Vec<double>& origin, const Vec<double>& direction, std::int32_t from) {
  RayRow<double> rays = {};
  for (int l = 0; l < kLanes; ++l) {
    rays.origin.store(l, origin), rays.direction.store(l, direction);
    rays.from[l] = from;
  }
  rays.active[0] = 1;
  return rays;
}

/// What a delta lobe shows, for each such lobe once. At most two lobes lie behind a mask of any opacity, and one is the
/// way through it; the ends of the ranges of the number that chooses find them all.
void add_lobes(const TransportScene<double>& scene, const StartPoint<double>& start, const Surface<double>& surface,
               Color& sum) {
  constexpr double kLast = 1 - 0x1p-53;
  const double opacity = scene.opacities[start.material];
  std::vector<Vec<double>> seen;
  for (const double u : {0.0, std::nextafter(opacity, 0.0) * kLast, opacity < 1 ? kLast : 0.5}) {
    kernel::Scattering<double, 3> result;
    kernel::scatter<double, 3>(scene, surface, true, {0, 0, 1}, u, 0.5, 0.5, result);
    if (!result.next.delta || !(result.next.pdf > 0)) continue;
    const auto same = [&](const Vec<double>& other) {
      return dot(other - result.next.wi, other - result.next.wi) < 1e-24;
    };
    if (std::any_of(seen.begin(), seen.end(), same)) continue;
    seen.push_back(result.next.wi);
    const Vec<double> direction = to_world(surface.frame, result.next.wi);
    RayRow<double> rays =
        lone_ray(kernel::leave<double>(scene, surface.position, surface.normal, direction), direction, start.piece);
    kernel::first_hits<double>(scene, rays);
    Surface<double> met;
    kernel::surface_at<double>(scene, rays, 0, met);
    std::int32_t element[kLanes];
    double radiance[3];
    kernel::emitted<double, 3>(scene, rays, 0, met, element, radiance);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += result.next.weight[c] * result.next.pdf * radiance[c];
  }
}

void add_delta_light(const TransportScene<double>& scene, std::int32_t light, const StartPoint<double>& start,
                     const Surface<double>& surface, Color& sum) {
  std::array<std::int32_t, kLanes> element = {};
  element[0] = light;
  kernel::LightSample<double, 3> drawn;
  kernel::draw_on_light<double, 3>(scene, {}, element.data(), 1.0, {surface.position, surface.frame.z}, 0.5, 0.5,
                                   drawn);
  kernel::Scattering<double, 3> result;
  kernel::scatter<double, 3>(scene, surface, true, kernel::to_local(surface.frame, drawn.wi), 0, 0.5, 0.5, result);
  RayRow<double> rays = lone_ray(surface.position, drawn.wi, start.piece);
  std::array<double, kLanes> limits = {};
  std::array<std::int32_t, kLanes> to = {};
  kernel::aim<double, 3>(scene, surface, drawn, 0, rays, limits.data());
  to[0] = -1;
  kernel::block<double>(scene, rays, to.data(), limits.data());
  if (rays.active[0] == 0) return;
  for (std::size_t c = 0; c < 3; ++c) sum[c] += result.light.cosine_bsdf[c] * drawn.weight[c];
}

}  // namespace

SeenPoint see(const TransportScene<double>& scene, const Vec3& origin, const Vec3& direction) {
  const auto plain = [](const Vec3& v) { return Vec<double>{v.x(), v.y(), v.z()}; };
  RayRow<double> rays = lone_ray(plain(origin), plain(direction), -1);
  kernel::first_hits<double>(scene, rays);
  Surface<double> surface;
  kernel::surface_at<double>(scene, rays, 0, surface);
  SeenPoint seen;
  std::int32_t element[kLanes];
  double radiance[3];
  kernel::emitted<double, 3>(scene, rays, 0, surface, element, radiance);
  for (std::size_t c = 0; c < 3; ++c) seen.emitted[c] = radiance[c];
  if (rays.piece[0] < 0 || surface.material[0] < 0) return seen;
  const auto copy = [](const Vec<double>& from, double(&to)[3]) { to[0] = from.x, to[1] = from.y, to[2] = from.z; };
  StartPoint<double>& start = seen.start;
  copy(surface.position, start.position), copy(surface.normal, start.normal), copy(surface.wo, start.wo);
  copy(surface.frame.x, start.s), copy(surface.frame.y, start.t), copy(surface.frame.z, start.n);
  start.u = surface.u, start.v = surface.v;
  start.material = surface.material[0], start.piece = rays.piece[0];
  std::fill_n(surface.material, kLanes, start.material);
  add_lobes(scene, start, surface, seen.certain);
  for (std::int32_t l = 0; l < scene.certain_count; ++l) {
    add_delta_light(scene, scene.light_count + l, start, surface, seen.certain);
  }
  const BsdfKind kind = scene.materials[start.material].kind;
  seen.samples = scene.light_count > 0 && kind != BsdfKind::kConductor && kind != BsdfKind::kDielectric;
  return seen;
}

template <class T>
StartPoint<T> rounded(const StartPoint<double>& start) {
  StartPoint<T> result;
  const auto copy = [](const double(&from)[3], T(&to)[3]) {
    for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(from[i]);
  };
  copy(start.position, result.position), copy(start.normal, result.normal), copy(start.wo, result.wo);
  copy(start.s, result.s), copy(start.t, result.t), copy(start.n, result.n);
  result.u = static_cast<T>(start.u), result.v = static_cast<T>(start.v);
  result.material = start.material, result.piece = start.piece;
  return result;
}
template StartPoint<float> rounded<float>(const StartPoint<double>&);
template StartPoint<double> rounded<double>(const StartPoint<double>&);

}  // namespace halfslope
