// Path tracing with next event estimation: the rendering equation in its three-point form, vertex by vertex.
//
// At each vertex two samples are taken: a point on a light, connected by a shadow ray, and a direction from the BSDF,
// which is where the path goes on. A light found by the direction contributes to the vertex it was drawn at; so vertex
// k has two terms, throughput · f cos θ L / p, with the densities of both techniques at each, in solid angle. Their
// weights are not known here: heuristics fold the terms, all from the same paths (E. Veach, "Robust Monte Carlo Methods
// for Light Transport Simulation", 1997, chapters 8 and 9; throughputs do not depend on weights).
//
// What only one technique can find (light seen by the eye, through delta lobes, or from delta lights) goes to slot 0,
// which every heuristic adds whole.
#include "estimators/kernel_functions.h"
#include "estimators/transport_vertex.h"

namespace halfslope::kernel {
namespace {

/// The state of a row of paths between vertices.
template <class T, int C>
struct alignas(64) PathRow {
  RayRow<T> rays;
  T throughput[C][kLanes];
  T pdf[kLanes];               ///< of the direction, where it was drawn from a continuous lobe
  T delta[kLanes];             ///< 1 where it was drawn from a delta lobe, or is the eye's
  T eta[kLanes];               ///< product of the relative indices so far
  RowVec<T> position, normal;  ///< of the vertex that the rays leave
  T certain[C][kLanes];
};

/// Shadow rays, and what they bring if nothing is in the way.
template <class T, int C>
struct alignas(64) LightRow {
  RayRow<T> rays;
  std::int32_t to[kLanes];
  T limits[kLanes];
  T value[C][kLanes], pdf_light[kLanes], pdf_bsdf[kLanes], delta[kLanes];
};

template <class F, int C>
void camera_rays(const PathCall<scalar_t<F>>& call, const RowNumbers<scalar_t<F>>& numbers,
                 PathRow<scalar_t<F>, C>& row) {
  using T = scalar_t<F>;
  const CameraData<T>& camera = *call.camera;
  alignas(64) T film[2][kLanes] = {}, lens[2][kLanes] = {};
  if (call.dims.film >= 0) {
    for (int k = 0; k < 2; ++k) {
      numbers.load(call.dims.film + k, film[k]);
      for (int l = 0; l < kLanes; ++l) {
        const T at = film[k][l] * static_cast<T>(camera.filter_size - 1);
        const auto i = static_cast<std::int32_t>(at);
        const T rest = at - static_cast<T>(i);
        film[k][l] = static_cast<T>(camera.filter[i]) * (T(1) - rest) + static_cast<T>(camera.filter[i + 1]) * rest;
      }
    }
  }
  if (call.dims.lens >= 0) {
    for (int k = 0; k < 2; ++k) numbers.load(call.dims.lens + k, lens[k]);
  }
  for (int lane = 0; lane < kLanes; lane += kWidth<F>) {
    const F x = load<F>(film[0] + lane), y = load<F>(film[1] + lane);
    Vec<F> origin =
        broadcast_vec<F>(camera.origin) + x * broadcast_vec<F>(camera.origin_x) + y * broadcast_vec<F>(camera.origin_y);
    Vec<F> direction = broadcast_vec<F>(camera.direction) + x * broadcast_vec<F>(camera.direction_x) +
                       y * broadcast_vec<F>(camera.direction_y);
    if (camera.lens) {
      const DiskPoint<F> disk = uniform_disk(load<F>(lens[0] + lane), load<F>(lens[1] + lane));
      const Vec<F> aside = disk.x * broadcast_vec<F>(camera.lens_u) + disk.y * broadcast_vec<F>(camera.lens_v);
      origin = origin + aside;
      direction = F(camera.focus) * direction - aside;
    }
    row.rays.origin.template store<F>(lane, origin);
    row.rays.direction.template store<F>(lane, normalise(direction));
  }
  for (int l = 0; l < kLanes; ++l) {
    row.rays.from[l] = -1;
    row.rays.active[l] = row.delta[l] = row.eta[l] = T(1);
    row.pdf[l] = T(0);
    for (int c = 0; c < C; ++c) row.throughput[c][l] = T(1), row.certain[c][l] = T(0);
  }
}

/// The terms of one slot.
template <class T, int C>
struct Slot {
  T* base;
  std::size_t stride;
  T* value(int c) const { return base + static_cast<std::size_t>(c) * stride; }
  T* pdf_light() const { return base + C * stride; }
  T* pdf_bsdf() const { return base + (C + 1) * stride; }
};

/// Light that the rays have met adds to what the eye sees, or is the last vertex's BSDF term.
template <class F, int C>
void add_emission(const PathCall<scalar_t<F>>& call, int lane, const Surface<F>& surface, PathRow<scalar_t<F>, C>& row,
                  const Slot<scalar_t<F>, C>* bsdf_slot) {
  using T = scalar_t<F>;
  const F zero(T(0));
  alignas(64) std::int32_t element[kLanes];
  F radiance[C];
  const mask_t<F> seen = emitted<F, C>(*call.scene, row.rays, lane, surface, element, radiance);
  if (!any_lane(seen)) return;
  const mask_t<F> certain = load_mask<F>(row.delta + lane);
  for (int c = 0; c < C; ++c) {
    const F value = load<F>(row.throughput[c] + lane) * radiance[c];
    T* sum = row.certain[c] + lane;
    store(sum, load<F>(sum) + select(seen & certain, value, zero));
    if (bsdf_slot) store(bsdf_slot->value(c) + lane, select(certain, zero, value));
  }
  const mask_t<F> shared = seen & !certain;
  if (!bsdf_slot || !any_lane(shared)) return;
  const ReceiverPoint<F> from = {row.position.template load<F>(lane), row.normal.template load<F>(lane)};
  const F pdf = light_pdf<F>(*call.scene, call.way, element, from, row.rays.direction.template load<F>(lane),
                             surface.position, surface.facing);
  store(bsdf_slot->pdf_light() + lane, select(shared, pdf, zero));
  store(bsdf_slot->pdf_bsdf() + lane, select(shared, load<F>(row.pdf + lane), zero));
}

/// Draws a light and a direction at the surface; the shadow ray waits in `light`, the path goes on in `row`.
template <class F, int C>
void add_vertex(const PathCall<scalar_t<F>>& call, const RowNumbers<scalar_t<F>>& numbers, int dims, int vertex,
                int lane, const Surface<F>& surface, PathRow<scalar_t<F>, C>& row, LightRow<scalar_t<F>, C>& light,
                const scalar_t<F> (&u)[6][kLanes]) {
  using T = scalar_t<F>;
  const TransportScene<T>& scene = *call.scene;
  const F zero(T(0));
  const mask_t<F> active = load_mask<F>(row.rays.active + lane) & lanes_from<F>(surface.material, 0);
  // Scattering happens on the side of the shading normal that the ray came from; leaving goes by the geometric one.
  const ReceiverPoint<F> here = {surface.position, surface.frame.z};
  LightSample<F, C> drawn;
  const std::uint32_t* words = call.dims.choice >= 0 ? numbers.words(dims + call.dims.choice) + lane : nullptr;
  draw_light<F, C>(scene, call.way, words, here, load<F>(u[0] + lane), load<F>(u[1] + lane), drawn);
  Scattering<F, C> result;
  scatter<F, C>(scene, surface, active, to_local(surface.frame, drawn.wi), load<F>(u[2] + lane), load<F>(u[3] + lane),
                load<F>(u[4] + lane), result);

  // The connection.
  mask_t<F> wanted = no_lanes<F>();
  for (int c = 0; c < C; ++c) {
    const F value = load<F>(row.throughput[c] + lane) * result.light.cosine_bsdf[c] * drawn.weight[c];
    wanted = wanted | (value != zero);
    store(light.value[c] + lane, value);
  }
  wanted = wanted & active;
  store_mask<F>(light.rays.active + lane, wanted);
  store_mask<F>(light.delta + lane, drawn.delta);
  store(light.pdf_light + lane, drawn.pdf);
  store(light.pdf_bsdf + lane, result.light.pdf);
  if (any_lane(wanted)) {
    aim<F, C>(scene, surface, drawn, lane, light.rays, light.limits);
    for (int l = 0; l < kWidth<F>; ++l) {
      light.to[lane + l] = drawn.piece[l];
      light.rays.from[lane + l] = row.rays.piece[lane + l];
    }
  }

  // The way on.
  const Vec<F> direction = to_world(surface.frame, result.next.wi);
  F largest = zero;
  F throughput[C];
  const F eta = load<F>(row.eta + lane) * result.next.eta;
  for (int c = 0; c < C; ++c) {
    throughput[c] = load<F>(row.throughput[c] + lane) * result.next.weight[c];
    largest = max(throughput[c], largest);
  }
  mask_t<F> alive = active & (largest > zero);
  if (call.rr_depth > 0 && vertex + 1 >= call.rr_depth) {
    const F survive = min(largest * eta * eta, F(T(0.95)));
    alive = alive & (load<F>(u[5] + lane) < survive);
    for (int c = 0; c < C; ++c) throughput[c] = throughput[c] / survive;
  }
  for (int c = 0; c < C; ++c) store(row.throughput[c] + lane, select(alive, throughput[c], zero));
  store(row.eta + lane, eta);
  store(row.pdf + lane, result.next.pdf);
  store_mask<F>(row.delta + lane, result.next.delta);
  store_mask<F>(row.rays.active + lane, alive);
  row.position.template store<F>(lane, surface.position);
  row.normal.template store<F>(lane, surface.frame.z);
  row.rays.origin.template store<F>(lane, leave<F>(scene, surface.position, surface.normal, direction));
  row.rays.direction.template store<F>(lane, direction);
}

template <class F, int C>
void trace_row(const PathCall<scalar_t<F>>& call, std::size_t first) {
  using T = scalar_t<F>;
  const TransportScene<T>& scene = *call.scene;
  const RowNumbers<T> numbers(call.high, call.low, first);
  const std::size_t rows = C + 2;
  const auto slot = [&](int q) {
    return Slot<T, C>{call.terms + static_cast<std::size_t>(q) * rows * call.stride + first, call.stride};
  };
  PathRow<T, C> row;
  LightRow<T, C> light;
  camera_rays<F, C>(call, numbers, row);
  for (int vertex = 0;; ++vertex) {
    first_hits<F>(scene, row.rays);
    const bool scatters = vertex + 1 < call.max_depth;
    const int dims = call.dims.first_vertex + vertex * call.dims.per_vertex;
    alignas(64) T u[6][kLanes];
    if (scatters) {
      numbers.load(dims + call.dims.light, u[0]), numbers.load(dims + call.dims.light + 1, u[1]);
      if (call.dims.lobe >= 0)
        numbers.load(dims + call.dims.lobe, u[2]);
      else
        for (int l = 0; l < kLanes; ++l) u[2][l] = T(0);
      numbers.load(dims + call.dims.bsdf, u[3]), numbers.load(dims + call.dims.bsdf + 1, u[4]);
      if (call.dims.roulette >= 0) numbers.load(dims + call.dims.roulette, u[5]);
    }
    const Slot<T, C> before = slot(2 * vertex);  // of the vertex before: slot 2 + 2 (vertex − 1)
    for (int lane = 0; lane < kLanes; lane += kWidth<F>) {
      Surface<F> surface;
      surface_at<F>(scene, row.rays, lane, surface);
      add_emission<F, C>(call, lane, surface, row, vertex > 0 ? &before : nullptr);
      if (scatters) add_vertex<F, C>(call, numbers, dims, vertex, lane, surface, row, light, u);
    }
    if (!scatters) break;
    if (any_of(light.rays.active)) {
      block<F>(scene, light.rays, light.to, light.limits);
      const Slot<T, C> now = slot(1 + 2 * vertex);
      const F zero(T(0));
      for (int lane = 0; lane < kLanes; lane += kWidth<F>) {
        const mask_t<F> open = load_mask<F>(light.rays.active + lane), certain = load_mask<F>(light.delta + lane);
        for (int c = 0; c < C; ++c) {
          const F value = select(open, load<F>(light.value[c] + lane), zero);
          store(now.value(c) + lane, select(certain, zero, value));
          T* sum = row.certain[c] + lane;
          store(sum, load<F>(sum) + select(certain, value, zero));
        }
        const mask_t<F> shared = open & !certain;
        store(now.pdf_light() + lane, select(shared, load<F>(light.pdf_light + lane), zero));
        store(now.pdf_bsdf() + lane, select(shared, load<F>(light.pdf_bsdf + lane), zero));
      }
    }
    if (!any_of(row.rays.active)) break;
    for (int l = 0; l < kLanes; ++l) row.rays.from[l] = row.rays.piece[l];
  }
  const Slot<T, C> certain = slot(0);
  for (int c = 0; c < C; ++c) {
    for (int l = 0; l < kLanes; ++l) certain.value(c)[l] = row.certain[c][l];
  }
}

template <class F, int C>
void trace_all(const PathCall<scalar_t<F>>& call) {
  const std::size_t slots = 2 * static_cast<std::size_t>(call.max_depth) - 1;
  std::fill_n(call.terms, slots * (C + 2) * call.stride, scalar_t<F>(0));
  for (std::size_t first = 0; first < call.count; first += kLanes) trace_row<F, C>(call, first);
}

}  // namespace

template <class T>
void trace_paths(const PathCall<T>& call) {
  using F = NativePacket<T>;
  call.channels == 1 ? trace_all<F, 1>(call) : trace_all<F, 3>(call);
}
template void trace_paths<float>(const PathCall<float>&);
template void trace_paths<double>(const PathCall<double>&);

}  // namespace halfslope::kernel
