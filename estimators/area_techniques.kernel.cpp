// Direct lighting in surface form: the reflection equation over points y of surfaces, by dω = cos ψ / r² dA,
//
//   L_o = ∫ f_r(x, ω_i, ω_o) L_e(y) V(x, y) cos θ_i cos ψ / r² dA(y).
//
// Technique `light` chooses one of the lights, each as likely, technique `surface` a point of all surfaces alike (most
// of which do not emit, and are worth nothing); both draw the point uniformly on the whole shape. Densities are given
// in solid angle, p_ω = p_A r² / cos ψ, so that they compare with those of directions.
#include "core/coordinates.h"
#include "core/point_block.h"
#include "estimators/kernel_functions.h"
#include "estimators/lighting_rays.h"

namespace halfslope::kernel {
namespace {

constexpr std::size_t kChunk = 16 * kLanes;  // points converted at a time; their coordinates stay in the first cache

/// Which light's interval each word is in; `lights` where it is in none.
template <class T>
inline void to_intervals(const std::uint32_t* __restrict words, const std::uint32_t* last, int lights,
                         std::size_t count, T* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    std::int32_t index = 0;
    for (int l = 0; l < lights; ++l) index += words[i] > last[l] ? 1 : 0;
    out[i] = static_cast<T>(index);
  }
}

/// The parameters of the light that each lane chose.
template <class F>
struct ChosenLight {
  Vec<F> center, u, v, normal;
  F radius, sphere, disk, pdf_area, pdf_area_surface, radiance[3];
};

/// What of it the scene and the call need at all.
struct Needs {
  bool flats = false, disks = false, pdf_light = false, pdf_surface = false;
};

template <class F, int C>
inline void blend_light(const LocalLight<scalar_t<F>>& light, const mask_t<F>& here, const Needs& needs,
                        ChosenLight<F>& chosen) {
  using T = scalar_t<F>;
  const auto pick = [&](F& to, T value) { to = select(here, F(value), to); };
  pick(chosen.center.x, light.shape.center[0]);
  pick(chosen.center.y, light.shape.center[1]);
  pick(chosen.center.z, light.shape.center[2]);
  pick(chosen.radius, light.shape.radius);
  if (needs.pdf_light) pick(chosen.pdf_area, light.pdf_area);
  if (needs.pdf_surface) pick(chosen.pdf_area_surface, light.pdf_area_surface);
  for (int c = 0; c < C; ++c) pick(chosen.radiance[c], light.radiance[c]);
  if (!needs.flats) return;
  pick(chosen.sphere, light.shape.kind == ShapeKind::kSphere ? T(1) : T(0));
  if (needs.disks) pick(chosen.disk, light.shape.kind == ShapeKind::kDisk ? T(1) : T(0));
  pick(chosen.u.x, light.shape.u[0]);
  pick(chosen.u.y, light.shape.u[1]);
  pick(chosen.u.z, light.shape.u[2]);
  pick(chosen.v.x, light.shape.v[0]);
  pick(chosen.v.y, light.shape.v[1]);
  pick(chosen.v.z, light.shape.v[2]);
  pick(chosen.normal.x, light.shape.normal[0]);
  pick(chosen.normal.y, light.shape.normal[1]);
  pick(chosen.normal.z, light.shape.normal[2]);
}

template <class F, class Bsdf>
void area_points(const LightingCall<scalar_t<F>>& call, const Bsdf& bsdf) {
  using T = scalar_t<F>;
  constexpr int C = Bsdf::kChannels;
  const PixelData<T>& pixel = *call.pixel;
  const bool surface = call.technique == LightingTechnique::kSurface;
  Needs needs;
  for (int l = 0; l < pixel.light_count; ++l) {
    needs.flats |= pixel.lights[l].shape.kind != ShapeKind::kSphere;
    needs.disks |= pixel.lights[l].shape.kind == ShapeKind::kDisk;
  }
  needs.pdf_light = !surface || call.pdfs[static_cast<int>(LightingTechnique::kLight)];
  needs.pdf_surface = surface || call.pdfs[static_cast<int>(LightingTechnique::kSurface)];
  const Vec<F> row_x = broadcast<F>(pixel.world_to_local), row_y = broadcast<F>(pixel.world_to_local + 3),
               row_z = broadcast<F>(pixel.world_to_local + 6);
  const F zero(T(0)), one(T(1)), two(T(2)), lights(static_cast<T>(pixel.light_count));
  alignas(64) T choice[kChunk], u1[kChunk], u2[kChunk];
  const int first = call.choose ? 1 : 0;
  for (std::size_t begin = 0; begin < call.count; begin += kChunk) {
    const std::size_t size = call.count - begin < kChunk ? call.count - begin : kChunk;
    const auto low = [&](int d) { return call.low[d] ? call.low[d] + begin : nullptr; };
    if (call.choose && surface) {
      to_intervals(call.high[0] + begin, pixel.surface_last, pixel.light_count, size, choice);
    } else if (call.choose) {
      to_choices(call.high[0] + begin, static_cast<std::uint32_t>(pixel.light_count), size, choice);
    }
    to_coordinates(call.high[first] + begin, low(first), size, u1);
    to_coordinates(call.high[first + 1] + begin, low(first + 1), size, u2);
    for (std::size_t i = 0; i < size; i += kWidth<F>) {
      const F index = call.choose ? load<F>(choice + i) : zero;
      mask_t<F> visible = index < lights;
      if (surface && !any_lane(visible)) {
        store_nothing<F, C>(call, begin + i);
        continue;
      }
      ChosenLight<F> light;
      light.sphere = one;
      light.u = light.v = light.normal = light.center = {zero, zero, zero};
      light.radius = light.disk = light.pdf_area = light.pdf_area_surface = zero;
      for (int c = 0; c < C; ++c) light.radiance[c] = zero;
      for (int l = 0; l < pixel.light_count; ++l) {
        blend_light<F, C>(pixel.lights[l], index == F(static_cast<T>(l)), needs, light);
      }
      // A uniform point on the whole sphere; axes are the world's.
      const F a = load<F>(u1 + i), b = load<F>(u2 + i);
      const Vec<F> world = uniform_sphere(a, b);
      Vec<F> normal = {dot(row_x, world), dot(row_y, world), dot(row_z, world)};
      Vec<F> y = light.center + light.radius * normal;
      if (needs.flats) {
        const auto sphere = light.sphere == one;
        F s = fma(two, a, F(T(-1))), t = fma(two, b, F(T(-1)));
        if (needs.disks) {
          const auto disk = light.disk == one;
          const DiskPoint<F> inside = uniform_disk(a, b);
          s = select(disk, inside.x, s);
          t = select(disk, inside.y, t);
        }
        const Vec<F> flat = light.center + s * light.u + t * light.v;
        y = {select(sphere, y.x, flat.x), select(sphere, y.y, flat.y), select(sphere, y.z, flat.z)};
        normal = {select(sphere, normal.x, light.normal.x), select(sphere, normal.y, light.normal.y),
                  select(sphere, normal.z, light.normal.z)};
      }
      const F distance2 = dot(y, y), inverse = one / sqrt(distance2), distance = distance2 * inverse;
      const Vec<F> wi = inverse * y;
      // A sphere that emits inwards shows its inside; its radiance is 0 here unless the receiver is on the right side,
      // and then the side that faces the receiver is the one that emits.
      const F facing = -dot(normal, wi);
      F cosine = facing;
      for (int l = 0; l < pixel.light_count; ++l) {
        if (pixel.lights[l].shape.inside) cosine = select(index == F(static_cast<T>(l)), -facing, cosine);
      }
      visible = visible & (cosine > zero) & (wi.z > zero);
      visible = unoccluded(pixel, wi, distance, index, visible);
      if (!any_lane(visible)) {
        store_nothing<F, C>(call, begin + i);
        continue;
      }
      const Reflection<F> reflection = bsdf.evaluate(wi);
      // f/p = f_r cos θ L_e / p_ω, with 1/p_ω = (cos ψ / r) / (p_A r): no quotient of two overflows.
      const F inverse_pdf = (cosine * inverse) / ((surface ? light.pdf_area_surface : light.pdf_area) * distance);
      for (int c = 0; c < C; ++c) {
        store(call.values[c] + begin + i,
              select(visible, reflection.cosine_brdf[c] * light.radiance[c] * inverse_pdf, zero));
      }
      store_pdfs<F>(call, begin + i, visible, {wi, distance, cosine, light.pdf_area, light.pdf_area_surface},
                    reflection.pdf);
    }
  }
}

}  // namespace

template <class T>
void sample_area(const LightingCall<T>& call) {
  with_bsdf(*call.pixel, call.channels, [&](const auto& bsdf) { area_points<NativePacket<T>>(call, bsdf); });
}
template void sample_area<float>(const LightingCall<float>&);
template void sample_area<double>(const LightingCall<double>&);

}  // namespace halfslope::kernel
