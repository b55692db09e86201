// Direct lighting at a point: the reflection equation sampled in two forms.
//
// Directional form:  L_o = ∫ f_r(ω_i, ω_o) L_e(y(ω_i)) cos θ_i dω_i, sampled by the BSDF's own density.
// Surface form, by dω = cos ψ / r² dA:  L_o = ∫ f_r L_e(y) V(x, y) cos θ_i cos ψ / r² dA(y), sampled over the lights.
//
// Both densities are given in solid angle: p_ω = p_A r² / cos ψ. The receiving point x is the origin and its normal the
// z axis (estimators/pixel_data.h), which turns every test against a horizon into a sign.
#include <limits>
#include <numbers>

#include "core/coordinates.h"
#include "core/packet.h"
#include "core/point_block.h"
#include "estimators/kernel_functions.h"
#include "scenes/ggx.h"
#include "scenes/measure.h"
#include "scenes/vec.h"

namespace halfslope::kernel {
namespace {

constexpr std::size_t kChunk = 16 * kLanes;  // points converted at a time; their coordinates stay in the first cache

template <class F>
inline Vec<F> broadcast(const scalar_t<F>* v) {
  return {F(v[0]), F(v[1]), F(v[2])};
}

/// What a direction towards a light is worth.
template <class F>
struct Reflection {
  F cosine_brdf[3];  ///< f_r · cos θ_i, per channel
  F pdf;             ///< the BSDF technique's density of the direction
};

/// The receiver's BSDF with all that a pixel fixes.
template <class F, int C>
class Diffuse {
 public:
  using T = scalar_t<F>;
  explicit Diffuse(const PixelData<T>& pixel) {
    for (int c = 0; c < C; ++c) albedo_[c] = pixel.reflectance[c];
  }
  Reflection<F> evaluate(const Vec<F>& wi) const {
    Reflection<F> r;
    r.pdf = wi.z * F(std::numbers::inv_pi_v<T>);
    for (int c = 0; c < C; ++c) r.cosine_brdf[c] = F(albedo_[c]) * r.pdf;
    return r;
  }
  /// Cosine-weighted: the disc of radius √u raised to the hemisphere. `weight` receives f_r cos θ / p = albedo.
  Vec<F> sample(const F& u1, const F& u2, F* weight, F& pdf) const {
    const F radius = sqrt(u1);
    const auto azimuth = sin_cos_2pi(u2);
    const F z = sqrt(F(T(1)) - u1);
    pdf = z * F(std::numbers::inv_pi_v<T>);
    for (int c = 0; c < C; ++c) weight[c] = F(albedo_[c]);
    return {radius * azimuth.cos, radius * azimuth.sin, z};
  }

 private:
  T albedo_[3];
};

template <class F, int C>
class RoughConductor {
 public:
  using T = scalar_t<F>;
  explicit RoughConductor(const PixelData<T>& pixel)
      : pixel_(pixel),
        wo_(broadcast<F>(pixel.wo)),
        alpha_(pixel.alpha),
        quarter_g1_over_cos_(F(T(0.25)) * ggx_g1_over_cos(alpha_, wo_.z)),
        projected_o_(ggx_projected_length(alpha_, wo_.z)) {}

  Reflection<F> evaluate(const Vec<F>& wi) const {
    const Vec<F> h = wi + wo_;
    const F d = distribution(h);
    const F fr_cos = d * visibility(wi.z) * wi.z;
    Reflection<F> r;
    r.pdf = d * quarter_g1_over_cos_;
    fresnel(wi, h, r.cosine_brdf);
    for (int c = 0; c < C; ++c) r.cosine_brdf[c] = r.cosine_brdf[c] * fr_cos;
    return r;
  }
  /// Visible normals: f_r cos θ / p has no D left in it.
  Vec<F> sample(const F& u1, const F& u2, F* weight, F& pdf) const {
    const Vec<F> m = sample_ggx_visible_normal(alpha_, wo_, u1, u2);
    const Vec<F> wi = F(T(2)) * dot(m, wo_) * m - wo_;
    const Vec<F> h = wi + wo_;
    pdf = distribution(h) * quarter_g1_over_cos_;
    const F common = visibility(wi.z) * wi.z / quarter_g1_over_cos_;
    fresnel(wi, h, weight);
    for (int c = 0; c < C; ++c) weight[c] = weight[c] * common;
    return wi;
  }

 private:
  /// D of the unnormalised half vector: with |h|² in place of 1, D = (α|h|² / ((αh_z)² + h_x² + h_y²))² / π.
  F distribution(const Vec<F>& h) const {
    const F za = alpha_ * h.z, flat = fma(h.x, h.x, h.y * h.y);
    const F ratio = alpha_ * fma(h.z, h.z, flat) / fma(za, za, flat);
    return ratio * ratio * F(std::numbers::inv_pi_v<T>);
  }
  F visibility(const F& cos_i) const {
    return F(T(0.5)) / fma(wo_.z, ggx_projected_length(alpha_, cos_i), cos_i * projected_o_);
  }
  void fresnel(const Vec<F>& wi, const Vec<F>& h, F* out) const {
    for (int c = 0; c < C; ++c) out[c] = F(pixel_.reflectance[c]);
    if (pixel_.unit_fresnel) return;
    const F cosine = min(dot(wi, h) / sqrt(dot(h, h)), F(T(1)));
    for (int c = 0; c < C; ++c) out[c] = out[c] * fresnel_conductor(cosine, F(pixel_.eta[c]), F(pixel_.k[c]));
  }

  const PixelData<T>& pixel_;
  Vec<F> wo_;
  F alpha_, quarter_g1_over_cos_, projected_o_;
};

template <class F>
struct Intersection {
  mask_t<F> hit;
  F distance, cosine;  ///< cos ψ at the surface, ≥ 0; both hold where `hit`
};

/// Where the ray from the origin along the unit vector d meets the shape at a positive distance; false, and `result`
/// not to be read, where no lane does.
template <class F>
inline bool intersect(const LocalShape<scalar_t<F>>& shape, const Vec<F>& d, Intersection<F>& result) {
  using T = scalar_t<F>;
  const F zero(T(0));
  const Vec<F> center = broadcast<F>(shape.center);
  if (shape.is_sphere) {
    // From the point of closest approach: the textbook discriminant cancels for small, distant spheres.
    const F along = dot(center, d);
    const Vec<F> closest = center - along * d;
    const F radius(shape.radius);
    const F discriminant = fma(radius, radius, -dot(closest, closest));
    if (shape.inside) {
      const F root = sqrt(max(discriminant, zero));
      result = {along + root > zero, along + root, root / radius};
      return any_lane(result.hit);
    }
    result.hit = (discriminant > zero) & (along > zero);
    if (!any_lane(result.hit)) return false;
    const F root = sqrt(max(discriminant, zero));
    result.distance = along - root;
    result.cosine = root / radius;
    result.hit = result.hit & (result.distance > zero);
    return true;
  }
  const Vec<F> normal = broadcast<F>(shape.normal);
  const F slope = dot(normal, d);
  const F distance = F(shape.plane) / slope;
  const Vec<F> offset = distance * d - center;
  const F a = dot(offset, broadcast<F>(shape.u)) * F(shape.inv_u2),
          b = dot(offset, broadcast<F>(shape.v)) * F(shape.inv_v2);
  const F one(T(1));
  result.hit = (distance > zero) & (distance < F(std::numeric_limits<T>::max()));
  result.hit = result.hit & (abs(a) <= one) & (abs(b) <= one);
  result.distance = distance;
  result.cosine = abs(slope);
  return any_lane(result.hit);
}

/// Clears the lanes whose way along d is blocked before `distance`; `light` is the light that each lane aims at, which
/// does not block itself.
template <class F>
inline mask_t<F> unoccluded(const PixelData<scalar_t<F>>& pixel, const Vec<F>& d, const F& distance, const F& light,
                            mask_t<F> visible) {
  using T = scalar_t<F>;
  for (int o = 0; o < pixel.occluder_count; ++o) {
    const LocalShape<T>& shape = pixel.occluders[o];
    Intersection<F> x;
    if (!intersect(shape, d, x)) continue;
    const auto other = light != F(static_cast<T>(shape.light));
    visible = visible & !(x.hit & (x.distance < distance) & other);
  }
  return visible;
}

/// The parameters of the light that each lane chose.
template <class F>
struct ChosenLight {
  Vec<F> center, u, v, normal;
  F radius, pdf_area, sphere, radiance[3];
};

template <class F, int C>
inline void blend_light(const LocalLight<scalar_t<F>>& light, const mask_t<F>& here, bool rectangles,
                        ChosenLight<F>& chosen) {
  using T = scalar_t<F>;
  const auto pick = [&](F& to, T value) { to = select(here, F(value), to); };
  pick(chosen.center.x, light.shape.center[0]);
  pick(chosen.center.y, light.shape.center[1]);
  pick(chosen.center.z, light.shape.center[2]);
  pick(chosen.radius, light.shape.radius);
  pick(chosen.pdf_area, light.pdf_area);
  for (int c = 0; c < C; ++c) pick(chosen.radiance[c], light.radiance[c]);
  if (!rectangles) return;
  pick(chosen.sphere, light.shape.is_sphere ? T(1) : T(0));
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

template <class F, int C, class Bsdf>
void light_points(const LightingCall<scalar_t<F>>& call) {
  using T = scalar_t<F>;
  const PixelData<T>& pixel = *call.pixel;
  const Bsdf bsdf(pixel);
  const bool choose = pixel.light_count > 1;
  bool rectangles = false;
  for (int l = 0; l < pixel.light_count; ++l) rectangles |= !pixel.lights[l].shape.is_sphere;
  const Vec<F> row_x = broadcast<F>(pixel.world_to_local), row_y = broadcast<F>(pixel.world_to_local + 3),
               row_z = broadcast<F>(pixel.world_to_local + 6);
  const F zero(T(0)), one(T(1)), two(T(2));
  alignas(64) T choice[kChunk], u1[kChunk], u2[kChunk];
  const int first = choose ? 1 : 0;
  for (std::size_t begin = 0; begin < call.count; begin += kChunk) {
    const std::size_t size = call.count - begin < kChunk ? call.count - begin : kChunk;
    const auto low = [&](int d) { return call.low[d] ? call.low[d] + begin : nullptr; };
    if (choose) to_choices(call.high[0] + begin, static_cast<std::uint32_t>(pixel.light_count), size, choice);
    to_coordinates(call.high[first] + begin, low(first), size, u1);
    to_coordinates(call.high[first + 1] + begin, low(first + 1), size, u2);
    for (std::size_t i = 0; i < size; i += kWidth<F>) {
      const F index = choose ? load<F>(choice + i) : zero;
      ChosenLight<F> light;
      light.sphere = one;
      light.u = light.v = light.normal = {zero, zero, zero};
      light.center = light.u;
      light.radius = light.pdf_area = zero;
      for (int c = 0; c < C; ++c) light.radiance[c] = zero;
      for (int l = 0; l < pixel.light_count; ++l) {
        blend_light<F, C>(pixel.lights[l], index == F(static_cast<T>(l)), rectangles, light);
      }
      // A uniform point on the whole sphere: height 1 − 2u₁, radius 2√(u₁(1 − u₁)); axes are the world's.
      const F a = load<F>(u1 + i), b = load<F>(u2 + i);
      const auto azimuth = sin_cos_2pi(b);
      const F ring = two * sqrt(a * (one - a));
      const Vec<F> world = {ring * azimuth.cos, ring * azimuth.sin, fma(F(T(-2)), a, one)};
      Vec<F> normal = {dot(row_x, world), dot(row_y, world), dot(row_z, world)};
      Vec<F> y = light.center + light.radius * normal;
      if (rectangles) {
        const auto sphere = light.sphere == one;
        const F s = fma(two, a, F(T(-1))), t = fma(two, b, F(T(-1)));
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
      mask_t<F> visible = (cosine > zero) & (wi.z > zero);
      visible = unoccluded(pixel, wi, distance, index, visible);
      const Reflection<F> reflection = bsdf.evaluate(wi);
      const F pdf = pdf_solid_angle_from_area(light.pdf_area, distance, cosine);
      // f/p = f_r cos θ L_e / p_ω, with 1/p_ω = (cos ψ / r) / (p_A r): no quotient of two overflows.
      const F inverse_pdf = (cosine * inverse) / (light.pdf_area * distance);
      for (int c = 0; c < C; ++c) {
        store(call.values[c] + begin + i,
              select(visible, reflection.cosine_brdf[c] * light.radiance[c] * inverse_pdf, zero));
      }
      if (call.pdf_light) store(call.pdf_light + begin + i, select(visible, pdf, zero));
      if (call.pdf_bsdf) store(call.pdf_bsdf + begin + i, select(visible, reflection.pdf, zero));
    }
  }
}

template <class F, int C, class Bsdf>
void bsdf_points(const LightingCall<scalar_t<F>>& call) {
  using T = scalar_t<F>;
  const PixelData<T>& pixel = *call.pixel;
  const Bsdf bsdf(pixel);
  const F zero(T(0));
  alignas(64) T u1[kChunk], u2[kChunk];
  for (std::size_t begin = 0; begin < call.count; begin += kChunk) {
    const std::size_t size = call.count - begin < kChunk ? call.count - begin : kChunk;
    to_coordinates(call.high[0] + begin, call.low[0] ? call.low[0] + begin : nullptr, size, u1);
    to_coordinates(call.high[1] + begin, call.low[1] ? call.low[1] + begin : nullptr, size, u2);
    for (std::size_t i = 0; i < size; i += kWidth<F>) {
      F weight[3], pdf;
      const Vec<F> wi = bsdf.sample(load<F>(u1 + i), load<F>(u2 + i), weight, pdf);
      F nearest(std::numeric_limits<T>::max()), light(T(-1)), pdf_light = zero, radiance[3];
      for (int c = 0; c < C; ++c) radiance[c] = zero;
      mask_t<F> seen = zero > zero;
      for (int l = 0; l < pixel.light_count; ++l) {
        const LocalLight<T>& candidate = pixel.lights[l];
        Intersection<F> x;
        if (!candidate.reaches || !intersect(candidate.shape, wi, x)) continue;
        mask_t<F> first = x.hit & (x.distance < nearest);
        // A rectangle emits from its front, against which the ray must run.
        if (!candidate.shape.is_sphere) first = first & (dot(broadcast<F>(candidate.shape.normal), wi) < zero);
        nearest = select(first, x.distance, nearest);
        light = select(first, F(static_cast<T>(l)), light);
        pdf_light = select(first, pdf_solid_angle_from_area(F(candidate.pdf_area), x.distance, x.cosine), pdf_light);
        for (int c = 0; c < C; ++c) radiance[c] = select(first, F(candidate.radiance[c]), radiance[c]);
        seen = seen | first;
      }
      seen = seen & (wi.z > zero);
      if (any_lane(seen)) seen = unoccluded(pixel, wi, nearest, light, seen);
      for (int c = 0; c < C; ++c) store(call.values[c] + begin + i, select(seen, weight[c] * radiance[c], zero));
      if (call.pdf_light) store(call.pdf_light + begin + i, select(seen, pdf_light, zero));
      if (call.pdf_bsdf) store(call.pdf_bsdf + begin + i, select(seen, pdf, zero));
    }
  }
}

}  // namespace

template <class T>
void sample_light(const LightingCall<T>& call) {
  using F = NativePacket<T>;
  const bool grey = call.channels == 1;
  if (call.pixel->bsdf == BsdfKind::kDiffuse) {
    return grey ? light_points<F, 1, Diffuse<F, 1>>(call) : light_points<F, 3, Diffuse<F, 3>>(call);
  }
  return grey ? light_points<F, 1, RoughConductor<F, 1>>(call) : light_points<F, 3, RoughConductor<F, 3>>(call);
}
template void sample_light<float>(const LightingCall<float>&);
template void sample_light<double>(const LightingCall<double>&);

template <class T>
void sample_bsdf(const LightingCall<T>& call) {
  using F = NativePacket<T>;
  const bool grey = call.channels == 1;
  if (call.pixel->bsdf == BsdfKind::kDiffuse) {
    return grey ? bsdf_points<F, 1, Diffuse<F, 1>>(call) : bsdf_points<F, 3, Diffuse<F, 3>>(call);
  }
  return grey ? bsdf_points<F, 1, RoughConductor<F, 1>>(call) : bsdf_points<F, 3, RoughConductor<F, 3>>(call);
}
template void sample_bsdf<float>(const LightingCall<float>&);
template void sample_bsdf<double>(const LightingCall<double>&);

}  // namespace halfslope::kernel
