#include "scenes/packet_triangles.h"

#include <algorithm>
#include <limits>

#include "scenes/vec.h"

namespace halfslope {

void meet_triangles(const PacketTriangles& triangles, RayPacket& packet) {
  constexpr int kLanes = RayPacket::kLanes;
  alignas(64) double t[kLanes], u[kLanes], v[kLanes];
  // Without branches, so that it is done several lanes at a time.
  for (int i = 0; i < kLanes; ++i) {
    const auto corner = [&](int k) { return Vec<double>{triangles.x[k][i], triangles.y[k][i], triangles.z[k][i]}; };
    const Vec<double> origin = {packet.ox[i], packet.oy[i], packet.oz[i]};
    const Vec<double> direction = {packet.dx[i], packet.dy[i], packet.dz[i]};
    const Vec<double> p0 = corner(0), p1 = corner(1), p2 = corner(2);
    const Vec<double> to0 = p0 - origin, to1 = p1 - origin, to2 = p2 - origin;
    const double v0 = dot(direction, cross(p2 - p1, to2 + to1));
    const double v1 = dot(direction, cross(p0 - p2, to0 + to2));
    const double v2 = dot(direction, cross(p1 - p0, to1 + to0));
    const double over_whole = 1 / (v0 + v1 + v2);
    const Vec<double> normal = cross(p1 - p0, p2 - p0);
    t[i] = dot(normal, to0) / dot(normal, direction);
    u[i] = std::min(std::max(v1 * over_whole, 0.0), 1.0);
    v[i] = std::min(std::max(v2 * over_whole, 0.0), 1.0 - u[i]);
  }
  for (int i = 0; i < kLanes; ++i) {
    const bool met = triangles.present[i] != 0 && t[i] > 0 && t[i] <= std::numeric_limits<double>::max();
    packet.tfar[i] = met ? static_cast<float>(t[i]) : packet.tfar[i];
    packet.u[i] = met ? static_cast<float>(u[i]) : packet.u[i];
    packet.v[i] = met ? static_cast<float>(v[i]) : packet.v[i];
  }
}

}  // namespace halfslope
