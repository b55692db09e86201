// Sixteen rays at once, as kernels trace them.
#pragma once

#include <cstdint>

namespace halfslope {

/// Sixteen rays and what they meet, plain data in Embree's own layout. Fields marked “own” belong to the tracer.
///
/// In: origins, directions (not zero; distances are counted in their lengths), tnear ≥ 0, tfar (may be infinite) and
/// active, −1 or 0; what lies at distances in (tnear, tfar) counts. An inactive lane may hold anything.
///
/// Out of first(): in active lanes `primitive`, or −1 where nothing was met; where it is not −1, tfar is the distance,
/// and of a mesh `triangle` with the hit at (1 − u − v) p0 + u p1 + v p2, else 0, u = v = 0. Inactive lanes: −1. Out of
/// occluded(): tfar is −∞ in active lanes with something on the way; the rest is as it was.
struct alignas(64) RayPacket {
  static constexpr int kLanes = 16;
  float ox[16], oy[16], oz[16], tnear[16];
  float dx[16], dy[16], dz[16], time[16];  ///< time: own
  float tfar[16];
  std::uint32_t mask[16], id[16], flags[16];  ///< own
  float nx[16], ny[16], nz[16];               ///< own
  float u[16], v[16];
  std::int32_t triangle[16];   ///< index into Mesh::triangles
  std::int32_t primitive[16];  ///< index into Scene::primitives
  std::int32_t instance[16];   ///< own
  std::int32_t active[16];
};

/// What traces a packet, as kernels call it; `scene` is the tracer's own.
using TracePacket = void (*)(const void* scene, RayPacket* packet);

}  // namespace halfslope
