// Triangles that the rays of a packet are known to hit.
#pragma once

#include "scenes/ray_packet.h"

namespace halfslope {

/// The corners of a triangle for each lane, and whether there is one.
struct alignas(64) PacketTriangles {
  double x[3][RayPacket::kLanes] = {}, y[3][RayPacket::kLanes] = {}, z[3][RayPacket::kLanes] = {};
  std::int32_t present[RayPacket::kLanes] = {};  ///< −1 or 0
};

/// Sets tfar, u and v of the lanes with a triangle to where the ray meets its plane, in double precision until they are
/// stored, from the same formulas as hit_triangle (scenes/shape_hits.h). u and v are moved into the triangle, for rays
/// that only rounding brings there; a distance that is not finite and above 0 leaves the lane as it is.
void meet_triangles(const PacketTriangles& triangles, RayPacket& packet);

}  // namespace halfslope
