// Rays through a scene, a row of kLanes at a time, inside a kernel.
#pragma once

#include <cstdint>
#include <limits>

#include "core/packet.h"
#include "estimators/transport_scene.h"
#include "scenes/bsdf_values.h"
#include "scenes/vec.h"

namespace halfslope::kernel {

template <class F>
inline Vec<F> broadcast_vec(const scalar_t<F>* v) {
  return {F(v[0]), F(v[1]), F(v[2])};
}

/// Three arrays of one number a lane.
template <class T>
struct alignas(64) RowVec {
  T x[kLanes], y[kLanes], z[kLanes];

  template <class F>
  Vec<F> load(int lane) const {
    return {halfslope::load<F>(x + lane), halfslope::load<F>(y + lane), halfslope::load<F>(z + lane)};
  }
  template <class F>
  void store(int lane, const Vec<F>& v) {
    halfslope::store(x + lane, v.x);
    halfslope::store(y + lane, v.y);
    halfslope::store(z + lane, v.z);
  }
};

/// Lanes as 1 or 0, which any number type loads.
template <class F>
inline mask_t<F> load_mask(const scalar_t<F>* flags) {
  return load<F>(flags) != F(scalar_t<F>(0));
}
template <class F>
inline void store_mask(scalar_t<F>* flags, const mask_t<F>& mask) {
  using T = scalar_t<F>;
  store(flags, select(mask, F(T(1)), F(T(0))));
}
template <class T>
inline bool any_of(const T* flags) {
  bool any = false;
  for (int l = 0; l < kLanes; ++l) any |= flags[l] != T(0);
  return any;
}

/// A row of rays, and where each first meets the scene.
template <class T>
struct alignas(64) RayRow {
  RowVec<T> origin, direction;  ///< directions of unit length
  std::int32_t
      from[kLanes];  ///< the piece that each ray leaves, or −1: flat ones and the way it came are not met again
  T active[kLanes];  ///< 1 or 0
  // Out: piece −1 where nothing is met, and in inactive lanes.
  T distance[kLanes], a[kLanes], b[kLanes];
  std::int32_t piece[kLanes];
};

/// Where a ray meets a flat piece's plane, and whether inside the piece. A hair's breadth more than the piece counts,
/// so that no ray slips between two pieces with a common edge. A plane that the ray starts on, within roundings of
/// coordinates up to 1, is not met: a ray that leaves one triangle's edge would meet its neighbour at once.
template <class F, LightKind kOutline>
inline mask_t<F> meets_flat(const FlatTest<scalar_t<F>>& flat, const Vec<F>& origin, const Vec<F>& direction,
                            F& distance, F& a, F& b) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), hair(T(8) * std::numeric_limits<T>::epsilon());
  const Vec<F> normal = broadcast_vec<F>(flat.normal);
  const F height = F(flat.plane) - dot(normal, origin);
  distance = select(abs(height) > hair, height, zero) / dot(normal, direction);
  const Vec<F> p = {fma(distance, direction.x, origin.x), fma(distance, direction.y, origin.y),
                    fma(distance, direction.z, origin.z)};
  a = dot(broadcast_vec<F>(flat.dual_u), p) - F(flat.offset_u);
  b = dot(broadcast_vec<F>(flat.dual_v), p) - F(flat.offset_v);
  const auto ahead = (distance > zero) & (distance < F(std::numeric_limits<T>::max()));
  if constexpr (kOutline == LightKind::kDisk) {
    return ahead & (fma(a, a, b * b) <= one);
  } else if constexpr (kOutline == LightKind::kTriangle) {
    return ahead & (a >= -hair) & (b >= -hair) & (a + b <= one + hair);
  } else {
    return ahead & (a >= -hair) & (b >= -hair) & (a <= one + hair) & (b <= one + hair);
  }
}

/// The distance to a sphere; from its own surface only its far side is met, from inside.
template <class F>
inline mask_t<F> meets_sphere(const SpherePiece<scalar_t<F>>& sphere, const Vec<F>& origin, const Vec<F>& direction,
                              const mask_t<F>& own, F& distance) {
  using T = scalar_t<F>;
  const F zero(T(0)), radius(sphere.radius);
  const Vec<F> to_center = broadcast_vec<F>(sphere.center) - origin;
  const F along = dot(to_center, direction);
  const Vec<F> closest = to_center - along * direction;
  const F depth = length(closest);
  const F square = (radius - depth) * (radius + depth);
  const F root = sqrt(max(square, zero));
  const F near = along - root, far = along + root;
  distance = select(own, along + along, select(near > zero, near, far));
  return (square > zero) & (distance > zero);
}

/// The distance to a cylinder's side, between its ends.
template <class F>
inline mask_t<F> meets_cylinder(const CylinderPiece<scalar_t<F>>& cylinder, const Vec<F>& origin,
                                const Vec<F>& direction, const mask_t<F>& own, F& distance) {
  using T = scalar_t<F>;
  const F zero(T(0)), radius(cylinder.radius), length_of(cylinder.length);
  const Vec<F> axis = broadcast_vec<F>(cylinder.axis);
  const Vec<F> from = origin - broadcast_vec<F>(cylinder.p0);
  const F slope = dot(direction, axis), start = dot(from, axis);
  const Vec<F> across = direction - slope * axis, offset = from - start * axis;
  // In units of the ray's speed across the axis.
  const F speed = length(across);
  const Vec<F> way = (F(T(1)) / speed) * across;
  const F along = -dot(offset, way);
  const Vec<F> closest = offset + along * way;
  const F depth = length(closest);
  const F square = (radius - depth) * (radius + depth);
  const F root = sqrt(max(square, zero));
  const F near = (along - root) / speed, far = select(own, along + along, along + root) / speed;
  const auto within = [&](const F& t) {
    const F height = fma(t, slope, start);
    return (t > zero) & (height >= zero) & (height <= length_of);
  };
  const auto near_counts = within(near) & !own;
  distance = select(near_counts, near, far);
  return (square > zero) & (speed > zero) & (near_counts | within(far)) & (distance < F(std::numeric_limits<T>::max()));
}

template <class F, LightKind kOutline>
inline void first_flats(const FlatTest<scalar_t<F>>* flats, int count, const Vec<F>& origin, const Vec<F>& direction,
                        const F& from, F& nearest, F& piece, F& a, F& b) {
  using T = scalar_t<F>;
  for (int i = 0; i < count; ++i) {
    F distance, u, v;
    const F own(static_cast<T>(flats[i].piece));
    const mask_t<F> met = meets_flat<F, kOutline>(flats[i], origin, direction, distance, u, v);
    const mask_t<F> first = met & (distance < nearest) & (from != own);
    nearest = select(first, distance, nearest);
    piece = select(first, own, piece);
    a = select(first, u, a);
    b = select(first, v, b);
  }
}

/// By our own shapes: each piece in turn.
template <class F>
inline void first_of_pieces(const TransportScene<scalar_t<F>>& scene, RayRow<scalar_t<F>>& row, int lane) {
  using T = scalar_t<F>;
  const Vec<F> origin = row.origin.template load<F>(lane), direction = row.direction.template load<F>(lane);
  alignas(64) T from_lanes[kLanes];
  for (int l = 0; l < kWidth<F>; ++l) from_lanes[l] = static_cast<T>(row.from[lane + l]);
  const F from = load<F>(from_lanes);
  F nearest(std::numeric_limits<T>::max()), piece(T(-1)), a(T(0)), b(T(0));
  const FlatTest<T>* flats = scene.tests;
  first_flats<F, LightKind::kRectangle>(flats, scene.parallelograms, origin, direction, from, nearest, piece, a, b);
  flats += scene.parallelograms;
  first_flats<F, LightKind::kTriangle>(flats, scene.triangles, origin, direction, from, nearest, piece, a, b);
  flats += scene.triangles;
  first_flats<F, LightKind::kDisk>(flats, scene.disks, origin, direction, from, nearest, piece, a, b);
  for (int i = 0; i < scene.sphere_count; ++i) {
    const F own(static_cast<T>(scene.flat_count + i));
    F distance;
    const mask_t<F> met = meets_sphere<F>(scene.spheres[i], origin, direction, from == own, distance);
    const mask_t<F> first = met & (distance < nearest);
    nearest = select(first, distance, nearest);
    piece = select(first, own, piece);
  }
  for (int i = 0; i < scene.cylinder_count; ++i) {
    const F own(static_cast<T>(scene.flat_count + scene.sphere_count + i));
    F distance;
    const mask_t<F> met = meets_cylinder<F>(scene.cylinders[i], origin, direction, from == own, distance);
    const mask_t<F> first = met & (distance < nearest);
    nearest = select(first, distance, nearest);
    piece = select(first, own, piece);
  }
  piece = select(load_mask<F>(row.active + lane), piece, F(T(-1)));
  store(row.distance + lane, nearest);
  store(row.a + lane, a);
  store(row.b + lane, b);
  store(from_lanes, piece);
  for (int l = 0; l < kWidth<F>; ++l) row.piece[lane + l] = static_cast<std::int32_t>(from_lanes[l]);
}

template <class F, LightKind kOutline>
inline void block_flats(const FlatTest<scalar_t<F>>* flats, int count, const Vec<F>& origin, const Vec<F>& direction,
                        const F& from, const F& to, const F& limit, mask_t<F>& open) {
  using T = scalar_t<F>;
  for (int i = 0; i < count && any_lane(open); ++i) {
    F distance, u, v;
    const F own(static_cast<T>(flats[i].piece));
    const mask_t<F> met = meets_flat<F, kOutline>(flats[i], origin, direction, distance, u, v);
    open = open & !(met & (distance < limit) & (from != own) & (to != own));
  }
}

/// Clears the active lanes whose way is blocked before `limit`; `to` is the piece that each lane aims at.
template <class F>
inline void block_by_pieces(const TransportScene<scalar_t<F>>& scene, RayRow<scalar_t<F>>& row, const std::int32_t* to,
                            const scalar_t<F>* limits, int lane) {
  using T = scalar_t<F>;
  mask_t<F> open = load_mask<F>(row.active + lane);
  if (!any_lane(open)) return;
  const Vec<F> origin = row.origin.template load<F>(lane), direction = row.direction.template load<F>(lane);
  alignas(64) T numbers[kLanes];
  for (int l = 0; l < kWidth<F>; ++l) numbers[l] = static_cast<T>(row.from[lane + l]);
  const F from = load<F>(numbers), limit = load<F>(limits + lane);
  for (int l = 0; l < kWidth<F>; ++l) numbers[l] = static_cast<T>(to[lane + l]);
  const F target = load<F>(numbers);
  const FlatTest<T>* flats = scene.tests;
  block_flats<F, LightKind::kRectangle>(flats, scene.parallelograms, origin, direction, from, target, limit, open);
  flats += scene.parallelograms;
  block_flats<F, LightKind::kTriangle>(flats, scene.triangles, origin, direction, from, target, limit, open);
  flats += scene.triangles;
  block_flats<F, LightKind::kDisk>(flats, scene.disks, origin, direction, from, target, limit, open);
  for (int i = 0; i < scene.sphere_count && any_lane(open); ++i) {
    // A sphere that is aimed at is convex: its near side blocks nothing of itself, its inside sees all of itself.
    const F own(static_cast<T>(scene.flat_count + i));
    F distance;
    const mask_t<F> met = meets_sphere<F>(scene.spheres[i], origin, direction, from == own, distance);
    open = open & !(met & (distance < limit) & (target != own));
  }
  for (int i = 0; i < scene.cylinder_count && any_lane(open); ++i) {
    // Its inside may be aimed at through an open end, or not: then its side is in the way, well before the target.
    const F own(static_cast<T>(scene.flat_count + scene.sphere_count + i));
    F distance;
    const F reach = select(target == own, limit * F(T(1) - T(0x1p-10)), limit);
    const mask_t<F> met = meets_cylinder<F>(scene.cylinders[i], origin, direction, from == own, distance);
    open = open & !(met & (distance < reach));
  }
  store_mask<F>(row.active + lane, open);
}

/// The rays of a row in Embree's form.
template <class T>
inline void to_packet(const RayRow<T>& row, RayPacket& packet) {
  for (int l = 0; l < kLanes; ++l) {
    packet.ox[l] = static_cast<float>(row.origin.x[l]);
    packet.oy[l] = static_cast<float>(row.origin.y[l]);
    packet.oz[l] = static_cast<float>(row.origin.z[l]);
    packet.dx[l] = static_cast<float>(row.direction.x[l]);
    packet.dy[l] = static_cast<float>(row.direction.y[l]);
    packet.dz[l] = static_cast<float>(row.direction.z[l]);
    packet.tnear[l] = 0;
    packet.tfar[l] = std::numeric_limits<float>::infinity();
    packet.active[l] = row.active[l] != T(0) ? -1 : 0;
  }
}

/// Where the active rays first meet the scene.
template <class F>
inline void first_hits(const TransportScene<scalar_t<F>>& scene, RayRow<scalar_t<F>>& row) {
  using T = scalar_t<F>;
  if (!scene.embree) {
    for (int lane = 0; lane < kLanes; lane += kWidth<F>) first_of_pieces<F>(scene, row, lane);
    return;
  }
  RayPacket packet;
  to_packet(row, packet);
  scene.embree_first(scene.embree, &packet);
  for (int l = 0; l < kLanes; ++l) {
    const bool met = row.active[l] != T(0) && packet.primitive[l] >= 0;
    row.piece[l] = met ? scene.first_piece[packet.primitive[l]] + packet.triangle[l] : -1;
    row.distance[l] = met ? static_cast<T>(packet.tfar[l]) : std::numeric_limits<T>::max();
    row.a[l] = static_cast<T>(packet.u[l]);
    row.b[l] = static_cast<T>(packet.v[l]);
  }
}

/// Clears the active lanes whose way to a point of piece `to` (−1: none), `limits` away, is blocked.
template <class F>
inline void block(const TransportScene<scalar_t<F>>& scene, RayRow<scalar_t<F>>& row, const std::int32_t* to,
                  const scalar_t<F>* limits) {
  using T = scalar_t<F>;
  if (!scene.embree) {
    for (int lane = 0; lane < kLanes; lane += kWidth<F>) block_by_pieces<F>(scene, row, to, limits, lane);
    return;
  }
  RayPacket packet;
  to_packet(row, packet);
  for (int l = 0; l < kLanes; ++l) packet.tfar[l] = static_cast<float>(limits[l]);
  scene.embree_occluded(scene.embree, &packet);
  for (int l = 0; l < kLanes; ++l) {
    if (packet.tfar[l] < 0) row.active[l] = T(0);
  }
}

/// Where a ray that leaves the surface at `p` on the side of `direction` may start so that Embree, in binary32, does
/// not find the surface again: moved along the normal by 16 of the roundings of the largest coordinate at hand. Our own
/// shapes need none of it: they know which piece a ray leaves.
template <class F>
inline Vec<F> leave(const TransportScene<scalar_t<F>>& scene, const Vec<F>& p, const Vec<F>& normal,
                    const Vec<F>& direction) {
  using T = scalar_t<F>;
  if (!scene.embree) return p;
  const F step(T(16) * std::numeric_limits<float>::epsilon() * scene.reach);
  const F side = select(dot(normal, direction) > F(T(0)), step, -step);
  return {fma(side, normal.x, p.x), fma(side, normal.y, p.y), fma(side, normal.z, p.z)};
}

}  // namespace halfslope::kernel
