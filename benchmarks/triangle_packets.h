// Each ray of a packet against each of a few triangles: what Embree has to beat.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/ray_packet.h"

namespace halfslope {

/// The planes of a triangle: with x = (p, 1), plane · x is the distance from it times its normal's length, and u · x
/// and v · x are the barycentrics of a point p of it.
struct TrianglePlanes {
  float plane[4], u[4], v[4];
};

/// The nearest of the triangles for each active lane, as RayPacket has it; `primitive` is 0 where one is met.
void first_of_triangles(const TrianglePlanes* triangles, std::size_t count, RayPacket* packet);

}  // namespace halfslope
