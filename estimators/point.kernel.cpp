// Direct lighting at one point of any scene: what path.kernel.cpp does at a vertex, by any of the techniques.
//
// Light that only one technique could find (delta lights, delta lobes) has no place here: at one point it is no
// integral, but a number (estimators/certain_light.h).
#include "estimators/kernel_functions.h"
#include "estimators/transport_vertex.h"

namespace halfslope::kernel {
namespace {

/// The same surface in every lane.
template <class F>
Surface<F> surface_of(const StartPoint<scalar_t<F>>& start) {
  Surface<F> surface;
  surface.position = broadcast_vec<F>(start.position);
  surface.normal = broadcast_vec<F>(start.normal);
  surface.frame = {broadcast_vec<F>(start.s), broadcast_vec<F>(start.t), broadcast_vec<F>(start.n)};
  surface.wo = broadcast_vec<F>(start.wo);
  surface.u = F(start.u);
  surface.v = F(start.v);
  surface.facing = F(scalar_t<F>(1));
  for (int l = 0; l < kLanes; ++l) surface.material[l] = start.material;
  return surface;
}

/// What one sample meets, in the lanes where it is worth something.
template <class F, int C>
struct Found {
  mask_t<F> lit;
  Vec<F> wi, point;  ///< world space
  F cosine;          ///< on the light's front
  F value[C];        ///< f cos θ L / p
  F pdf_bsdf;
  alignas(64) std::int32_t element[kLanes];
};

/// The density of each technique that is asked for.
template <class F, int C>
void store_found(const PointCall<scalar_t<F>>& call, std::size_t at, const Surface<F>& surface,
                 const Found<F, C>& found) {
  using T = scalar_t<F>;
  const F zero(T(0));
  for (int c = 0; c < C; ++c) store(call.values[c] + at, select(found.lit, found.value[c], zero));
  const ReceiverPoint<F> here = {surface.position, surface.frame.z};
  const F sides = call.scene->transmits ? F(T(0.5)) : F(T(1));
  for (int t = 0; t < kTransportTechniques; ++t) {
    if (!call.pdfs[t]) continue;
    const auto technique = static_cast<TransportTechnique>(t);
    F pdf = zero;
    if (any_lane(found.lit)) {
      if (technique == TransportTechnique::kBsdf) {
        pdf = found.pdf_bsdf;
      } else if (technique == TransportTechnique::kHemisphere) {
        pdf = sides * F(T(0.5) * std::numbers::inv_pi_v<T>);
      } else if (technique == TransportTechnique::kCosine) {
        pdf = sides * abs(dot(surface.frame.z, found.wi)) * F(std::numbers::inv_pi_v<T>);
      } else {
        pdf = light_pdf<F>(*call.scene, way_of(technique), found.element, here, found.wi, found.point, found.cosine);
      }
    }
    store(call.pdfs[t] + at, select(found.lit, pdf, zero));
  }
}

/// Points on lights.
template <class F, int C>
void connect_row(const PointCall<scalar_t<F>>& call, const Surface<F>& surface, std::size_t first) {
  using T = scalar_t<F>;
  const TransportScene<T>& scene = *call.scene;
  const RowNumbers<T> numbers(call.high, call.low, first);
  const int pair = call.choose ? 1 : 0;
  alignas(64) T u1[kLanes], u2[kLanes], limits[kLanes];
  alignas(64) std::int32_t to[kLanes];
  numbers.load(pair, u1), numbers.load(pair + 1, u2);
  const ReceiverPoint<F> here = {surface.position, surface.frame.z};
  const F zero(T(0)), one(T(1));
  RayRow<T> rays;
  Found<F, C> found[kLanes / kWidth<F>];
  for (int lane = 0, k = 0; lane < kLanes; lane += kWidth<F>, ++k) {
    LightSample<F, C> drawn;
    draw_light<F, C>(scene, way_of(call.technique), call.choose ? numbers.words(0) + lane : nullptr, here,
                     load<F>(u1 + lane), load<F>(u2 + lane), drawn);
    Scattering<F, C> result;
    scatter<F, C>(scene, surface, one > zero, to_local(surface.frame, drawn.wi), zero, zero, zero, result);
    Found<F, C>& at = found[k];
    at.lit = no_lanes<F>();
    for (int c = 0; c < C; ++c) {
      at.value[c] = result.light.cosine_bsdf[c] * drawn.weight[c];
      at.lit = at.lit | (at.value[c] != zero);
    }
    at.lit = at.lit & !drawn.delta;
    at.wi = drawn.wi, at.point = drawn.point;
    at.cosine = -dot(drawn.normal, drawn.wi);
    at.pdf_bsdf = result.light.pdf;
    store_mask<F>(rays.active + lane, at.lit);
    aim<F, C>(scene, surface, drawn, lane, rays, limits);
    for (int l = 0; l < kWidth<F>; ++l) {
      to[lane + l] = drawn.piece[l];
      rays.from[lane + l] = call.start->piece;
      at.element[l] = drawn.piece[l] >= 0 ? scene.sides[drawn.piece[l]].light : scene.environment_light;
    }
  }
  if (any_of(rays.active)) block<F>(scene, rays, to, limits);
  for (int lane = 0, k = 0; lane < kLanes; lane += kWidth<F>, ++k) {
    found[k].lit = load_mask<F>(rays.active + lane);
    store_found<F, C>(call, first + static_cast<std::size_t>(lane), surface, found[k]);
  }
}

/// Directions.
template <class F, int C>
void shoot_row(const PointCall<scalar_t<F>>& call, const Surface<F>& surface, std::size_t first) {
  using T = scalar_t<F>;
  const TransportScene<T>& scene = *call.scene;
  const RowNumbers<T> numbers(call.high, call.low, first);
  const bool by_bsdf = call.technique == TransportTechnique::kBsdf;
  const int pair = by_bsdf && call.choose ? 1 : 0;
  alignas(64) T lobe[kLanes] = {}, u1[kLanes], u2[kLanes];
  if (pair == 1) numbers.load(0, lobe);
  numbers.load(pair, u1), numbers.load(pair + 1, u2);
  const F zero(T(0)), one(T(1)), two(T(2));
  RayRow<T> rays;
  Scattering<F, C> results[kLanes / kWidth<F>];
  for (int lane = 0, k = 0; lane < kLanes; lane += kWidth<F>, ++k) {
    const F a = load<F>(u1 + lane), b = load<F>(u2 + lane);
    Scattering<F, C>& result = results[k];
    mask_t<F> worth = one > zero;
    Vec<F> wi;
    if (by_bsdf) {
      scatter<F, C>(scene, surface, worth, {zero, zero, one}, load<F>(lobe + lane), a, b, result);
      worth = (result.next.pdf > zero) & !result.next.delta;
      wi = result.next.wi;
    } else {
      // Where light may come through, either side by half of the first number.
      const mask_t<F> below = a >= F(T(0.5));
      const F height = scene.transmits ? select(below, fma(two, a, -one), two * a) : a;
      const bool uniform = call.technique == TransportTechnique::kHemisphere;
      wi = uniform ? uniform_hemisphere(height, b) : cosine_hemisphere(height, b);
      F inverse = uniform ? F(T(2) * std::numbers::pi_v<T>) : F(std::numbers::pi_v<T>) / wi.z;
      if (scene.transmits) {
        wi.z = select(below, -wi.z, wi.z);
        inverse = two * inverse;
      }
      scatter<F, C>(scene, surface, worth, wi, zero, zero, zero, result);
      result.next.pdf = result.light.pdf;
      for (int c = 0; c < C; ++c) result.next.weight[c] = result.light.cosine_bsdf[c] * inverse;
    }
    const Vec<F> direction = to_world(surface.frame, wi);
    rays.direction.template store<F>(lane, direction);
    rays.origin.template store<F>(lane, leave<F>(scene, surface.position, surface.normal, direction));
    store_mask<F>(rays.active + lane, worth);
    for (int l = 0; l < kWidth<F>; ++l) rays.from[lane + l] = call.start->piece;
  }
  first_hits<F>(scene, rays);
  for (int lane = 0, k = 0; lane < kLanes; lane += kWidth<F>, ++k) {
    Surface<F> met;
    surface_at<F>(scene, rays, lane, met);
    Found<F, C> found;
    F radiance[C];
    found.lit = emitted<F, C>(scene, rays, lane, met, found.element, radiance);
    found.wi = rays.direction.template load<F>(lane);
    found.point = met.position;
    found.cosine = met.facing;
    found.pdf_bsdf = results[k].next.pdf;
    for (int c = 0; c < C; ++c) found.value[c] = results[k].next.weight[c] * radiance[c];
    store_found<F, C>(call, first + static_cast<std::size_t>(lane), surface, found);
  }
}

template <class F, int C>
void sample_all(const PointCall<scalar_t<F>>& call) {
  const Surface<F> surface = surface_of<F>(*call.start);
  for (std::size_t first = 0; first < call.count; first += kLanes) {
    is_directional(call.technique) ? shoot_row<F, C>(call, surface, first) : connect_row<F, C>(call, surface, first);
  }
}

}  // namespace

template <class T>
void sample_point(const PointCall<T>& call) {
  using F = NativePacket<T>;
  call.channels == 1 ? sample_all<F, 1>(call) : sample_all<F, 3>(call);
}
template void sample_point<float>(const PointCall<float>&);
template void sample_point<double>(const PointCall<double>&);

}  // namespace halfslope::kernel
