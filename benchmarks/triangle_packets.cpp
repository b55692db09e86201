// Compiled for the processor that builds it: kernels have this loop for each instruction set.
#include "benchmarks/triangle_packets.h"

#include "core/packet.h"

namespace halfslope {

void first_of_triangles(const TrianglePlanes* triangles, std::size_t count, RayPacket* packet) {
  using F = NativePacket<float>;
  for (int first = 0; first < RayPacket::kLanes; first += kWidth<F>) {
    const F ox = load<F>(packet->ox + first), oy = load<F>(packet->oy + first), oz = load<F>(packet->oz + first);
    const F dx = load<F>(packet->dx + first), dy = load<F>(packet->dy + first), dz = load<F>(packet->dz + first);
    const F near = load<F>(packet->tnear + first);
    F best = load<F>(packet->tfar + first), best_u(0.0F), best_v(0.0F), found(-1.0F);
    for (std::size_t i = 0; i < count; ++i) {
      const TrianglePlanes& t = triangles[i];
      const auto along = [&](const float* p, const F& x, const F& y, const F& z, const F& w) {
        return fma(F(p[0]), x, fma(F(p[1]), y, fma(F(p[2]), z, w)));
      };
      const F distance = -along(t.plane, ox, oy, oz, F(t.plane[3])) / along(t.plane, dx, dy, dz, F(0.0F));
      const F x = fma(distance, dx, ox), y = fma(distance, dy, oy), z = fma(distance, dz, oz);
      const F u = along(t.u, x, y, z, F(t.u[3])), v = along(t.v, x, y, z, F(t.v[3]));
      const auto hit = (distance > near) & (distance < best) & (u >= F(0.0F)) & (v >= F(0.0F)) & (u + v <= F(1.0F));
      best = select(hit, distance, best);
      best_u = select(hit, u, best_u);
      best_v = select(hit, v, best_v);
      found = select(hit, F(static_cast<float>(i)), found);
    }
    store(packet->tfar + first, best);
    store(packet->u + first, best_u);
    store(packet->v + first, best_v);
    for (int k = 0; k < kWidth<F>; ++k) {
      float lanes[kWidth<F>];
      found.store_unaligned(lanes);
      packet->triangle[first + k] = static_cast<std::int32_t>(lanes[k]);
      packet->primitive[first + k] = packet->active[first + k] && lanes[k] >= 0 ? 0 : -1;
    }
  }
}

}  // namespace halfslope
