// The surface that a ray meets, inside a kernel.
#pragma once

#include <numbers>

#include "core/gather.h"
#include "estimators/transport_rays.h"

namespace halfslope::kernel {

/// A vector of each lane's own entry.
template <class F, class Entry>
inline Vec<F> gather_vec(const LaneEntries<F, Entry>& entries, scalar_t<F> (Entry::*field)[3]) {
  F xyz[3];
  entries(field, xyz);
  return {xyz[0], xyz[1], xyz[2]};
}

/// Lanes whose integer is `value`.
template <class F>
inline mask_t<F> lanes_with(const std::int32_t* numbers, std::int32_t value) {
  alignas(64) scalar_t<F> lanes[kLanes];
  for (int l = 0; l < kWidth<F>; ++l) lanes[l] = numbers[l] == value ? scalar_t<F>(1) : scalar_t<F>(0);
  return load_mask<F>(lanes);
}
/// Lanes whose integer is at least `value`.
template <class F>
inline mask_t<F> lanes_from(const std::int32_t* numbers, std::int32_t value) {
  alignas(64) scalar_t<F> lanes[kLanes];
  for (int l = 0; l < kWidth<F>; ++l) lanes[l] = numbers[l] >= value ? scalar_t<F>(1) : scalar_t<F>(0);
  return load_mask<F>(lanes);
}

/// An orthonormal frame in world space.
template <class F>
struct Frame {
  Vec<F> x, y, z;
};

/// Any frame about a unit normal (T. Duff and others, "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017).
template <class F>
inline Frame<F> frame_about(const Vec<F>& z) {
  const F zero(scalar_t<F>(0)), one(scalar_t<F>(1));
  const F sign = select(z.z < zero, -one, one), a = -one / (sign + z.z), b = z.x * z.y * a;
  return {{fma(sign * z.x * z.x, a, one), sign * b, -(sign * z.x)}, {b, fma(z.y * z.y, a, sign), -z.y}, z};
}

/// The frame about n whose x is nearest to `tangent`; any where that is along n.
template <class F>
inline Frame<F> frame_along(const Vec<F>& n, const Vec<F>& tangent) {
  using T = scalar_t<F>;
  const Vec<F> across = tangent - dot(n, tangent) * n;
  const F square = dot(across, across);
  const auto found = square > F(T(1e-12));
  const Vec<F> x = select_vec(found, (F(T(1)) / sqrt(select(found, square, F(T(1))))) * across, frame_about(n).x);
  return {x, cross(n, x), n};
}

template <class F>
inline Vec<F> to_local(const Frame<F>& frame, const Vec<F>& v) {
  return {dot(frame.x, v), dot(frame.y, v), dot(frame.z, v)};
}
template <class F>
inline Vec<F> to_world(const Frame<F>& frame, const Vec<F>& v) {
  return v.x * frame.x + v.y * frame.y + v.z * frame.z;
}

/// The angle of (x, y) in turns, in [0, 1].
template <class F>
inline F turns(const F& y, const F& x) {
  using T = scalar_t<F>;
  const F signed_turns = arctan2(y, x) * F(T(0.5) * std::numbers::inv_pi_v<T>);
  return select(signed_turns < F(T(0)), signed_turns + F(T(1)), signed_turns);
}

/// Azimuth/(2π) and polar angle/π of a direction, as Mitsuba's spheres have them.
template <class F>
inline void spherical_uv(const Vec<F>& d, F& u, F& v) {
  using T = scalar_t<F>;
  u = turns(d.y, d.x);
  v = arctan2(sqrt(fma(d.x, d.x, d.y * d.y)), d.z) * F(std::numbers::inv_pi_v<T>);
}

/// What a ray meets. Lanes that meet nothing hold numbers of some piece, finite and meaningless.
template <class F>
struct Surface {
  Vec<F> position;
  Vec<F> normal;   ///< the front's, geometric
  Frame<F> frame;  ///< its z the shading normal, on the front; turned to the ray's side on a back of its own
  Vec<F> wo;       ///< towards where the ray came from, in the frame
  F u, v;          ///< texture coordinates; only where something is textured
  F facing;        ///< cosine between `normal` and the way back: positive on the front
  alignas(64) std::int32_t material[kLanes];  ///< −1 where nothing is scattered
  alignas(64) std::int32_t light[kLanes];     ///< the light element whose front is seen, or −1
};

/// The part of a Surface that the kinds of pieces give in their own ways.
template <class F>
struct SurfacePoint {
  Vec<F> position, normal, shading, tangent;
  F u, v;
};

template <class F>
inline SurfacePoint<F> flat_point(const TransportScene<scalar_t<F>>& scene, const RayRow<scalar_t<F>>& row, int lane,
                                  const std::int32_t* piece) {
  using T = scalar_t<F>;
  F a = load<F>(row.a + lane), b = load<F>(row.b + lane);
  const LaneEntries<F, FlatPiece<T>> flats(scene.flats, piece);
  const Vec<F> p0 = gather_vec(flats, &FlatPiece<T>::p0), u = gather_vec(flats, &FlatPiece<T>::u),
               v = gather_vec(flats, &FlatPiece<T>::v);
  SurfacePoint<F> point;
  point.normal = gather_vec(flats, &FlatPiece<T>::normal);
  if (scene.embree && (scene.framed_flats || sizeof(T) == 8)) {
    // Embree knows a and b of triangles, with binary32's digits; the plane has all.
    const Vec<F> origin = row.origin.template load<F>(lane), direction = row.direction.template load<F>(lane);
    const F distance = dot(point.normal, p0 - origin) / dot(point.normal, direction);
    const Vec<F> from_corner = origin + distance * direction - p0;
    const F uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), along_u = dot(from_corner, u),
            along_v = dot(from_corner, v), inverse = F(T(1)) / (uu * vv - uv * uv);
    const F outline = flats(&FlatPiece<T>::outline);
    const mask_t<F> framed = outline != F(sizeof(T) == 8 ? T(-1) : static_cast<T>(LightKind::kTriangle));
    a = select(framed, (vv * along_u - uv * along_v) * inverse, a);
    b = select(framed, (uu * along_v - uv * along_u) * inverse, b);
  }
  point.position = p0 + a * u + b * v;
  point.shading = point.normal;
  if (scene.anisotropic) {
    // A disk's first texture coordinate grows outwards.
    const auto disk = flats(&FlatPiece<T>::outline) == F(static_cast<T>(LightKind::kDisk));
    point.tangent = select_vec(disk, a * u + b * v, gather_vec(flats, &FlatPiece<T>::tangent));
  }
  point.u = a;
  point.v = b;
  if (!scene.attributes) return point;
  alignas(64) T normals[3][3][kLanes], uvs[3][2][kLanes];
  for (int l = 0; l < kWidth<F>; ++l) {
    const TriangleAttributes& of_lane = scene.attributes[piece[l]];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) normals[i][k][l] = static_cast<T>(of_lane.normals[i][k]);
      for (int k = 0; k < 2; ++k) uvs[i][k][l] = static_cast<T>(of_lane.uvs[i][k]);
    }
  }
  const F c = F(T(1)) - a - b;
  const auto blend = [&](const auto& corners, int k) {
    return fma(c, load<F>(corners[0][k]), fma(a, load<F>(corners[1][k]), b * load<F>(corners[2][k])));
  };
  const Vec<F> smooth = {blend(normals, 0), blend(normals, 1), blend(normals, 2)};
  const F square = dot(smooth, smooth), one(T(1));
  const auto given = square > F(T(1e-12));
  point.shading = select_vec(given, (one / sqrt(select(given, square, one))) * smooth, point.shading);
  point.u = blend(uvs, 0);
  point.v = blend(uvs, 1);
  if (scene.textures) {
    const auto disk = flats(&FlatPiece<T>::outline) == F(static_cast<T>(LightKind::kDisk));
    point.u = select(disk, sqrt(fma(a, a, b * b)), point.u);
    point.v = select(disk, turns(b, a), point.v);
  }
  return point;
}

template <class F>
inline SurfacePoint<F> sphere_point(const TransportScene<scalar_t<F>>& scene, const Vec<F>& reached,
                                    const std::int32_t* sphere) {
  using T = scalar_t<F>;
  const LaneEntries<F, SpherePiece<T>> spheres(scene.spheres, sphere);
  const Vec<F> center = gather_vec(spheres, &SpherePiece<T>::center);
  const Vec<F> outward = normalise(reached - center);
  SurfacePoint<F> point;
  point.position = center + spheres(&SpherePiece<T>::radius) * outward;
  point.normal = spheres(&SpherePiece<T>::side) * outward;
  point.shading = point.normal;
  point.tangent = outward;
  point.u = point.v = F(T(0));
  if (!scene.textures && !scene.anisotropic) return point;
  const Vec<F> x = gather_vec(spheres, &SpherePiece<T>::x), y = gather_vec(spheres, &SpherePiece<T>::y),
               z = gather_vec(spheres, &SpherePiece<T>::z);
  const Vec<F> own = {dot(x, outward), dot(y, outward), dot(z, outward)};
  point.tangent = cross(z, outward);
  spherical_uv(own, point.u, point.v);
  return point;
}

template <class F>
inline SurfacePoint<F> cylinder_point(const TransportScene<scalar_t<F>>& scene, const Vec<F>& reached,
                                      const std::int32_t* cylinder) {
  using T = scalar_t<F>;
  const LaneEntries<F, CylinderPiece<T>> cylinders(scene.cylinders, cylinder);
  const Vec<F> p0 = gather_vec(cylinders, &CylinderPiece<T>::p0);
  const Vec<F> axis = gather_vec(cylinders, &CylinderPiece<T>::axis);
  const F height = dot(reached - p0, axis);
  const Vec<F> foot = p0 + height * axis;
  const Vec<F> outward = normalise(reached - foot);
  SurfacePoint<F> point;
  point.position = foot + cylinders(&CylinderPiece<T>::radius) * outward;
  point.normal = cylinders(&CylinderPiece<T>::side) * outward;
  point.shading = point.normal;
  point.tangent = cross(axis, outward);
  point.u = F(T(0));
  point.v = height / cylinders(&CylinderPiece<T>::length);
  if (scene.textures) {
    const Vec<F> start = gather_vec(cylinders, &CylinderPiece<T>::start);
    point.u = turns(dot(cross(axis, start), outward), dot(start, outward));
  }
  return point;
}

template <class F>
inline void blend_points(const mask_t<F>& mask, const SurfacePoint<F>& from, SurfacePoint<F>& to) {
  to.position = select_vec(mask, from.position, to.position);
  to.normal = select_vec(mask, from.normal, to.normal);
  to.shading = select_vec(mask, from.shading, to.shading);
  to.tangent = select_vec(mask, from.tangent, to.tangent);
  to.u = select(mask, from.u, to.u);
  to.v = select(mask, from.v, to.v);
}

/// The surface under the row's hits, lanes from `lane` on.
template <class F>
inline void surface_at(const TransportScene<scalar_t<F>>& scene, const RayRow<scalar_t<F>>& row, int lane,
                       Surface<F>& surface) {
  using T = scalar_t<F>;
  const F zero(T(0));
  const Vec<F> direction = row.direction.template load<F>(lane);
  const std::int32_t* piece = row.piece + lane;
  const std::int32_t spheres = scene.flat_count, cylinders = scene.flat_count + scene.sphere_count;
  std::int32_t some_flat = 0, some_sphere = 0, some_cylinder = 0;
  alignas(64) std::int32_t index[kLanes];
  for (int l = 0; l < kWidth<F>; ++l) {
    some_flat |= (piece[l] >= 0) & (piece[l] < spheres);
    some_sphere |= (piece[l] >= spheres) & (piece[l] < cylinders);
    some_cylinder |= static_cast<std::int32_t>(piece[l] >= cylinders);
  }
  SurfacePoint<F> point;
  point.position = point.normal = point.tangent = point.shading = {zero, zero, F(T(1))};
  point.u = point.v = zero;
  if (some_flat) {
    for (int l = 0; l < kWidth<F>; ++l) index[l] = (piece[l] >= 0) & (piece[l] < spheres) ? piece[l] : 0;
    point = flat_point<F>(scene, row, lane, index);
  }
  if (some_sphere | some_cylinder) {
    const Vec<F> origin = row.origin.template load<F>(lane);
    const Vec<F> reached = origin + load<F>(row.distance + lane) * direction;
    if (some_sphere) {
      for (int l = 0; l < kWidth<F>; ++l) {
        index[l] = (piece[l] >= spheres) & (piece[l] < cylinders) ? piece[l] - spheres : 0;
      }
      blend_points(lanes_from<F>(piece, spheres), sphere_point<F>(scene, reached, index), point);
    }
    if (some_cylinder) {
      for (int l = 0; l < kWidth<F>; ++l) index[l] = piece[l] >= cylinders ? piece[l] - cylinders : 0;
      blend_points(lanes_from<F>(piece, cylinders), cylinder_point<F>(scene, reached, index), point);
    }
  }
  surface.position = point.position;
  surface.normal = point.normal;
  surface.u = point.u;
  surface.v = point.v;
  surface.facing = -dot(point.normal, direction);
  surface.frame = scene.anisotropic ? frame_along(point.shading, point.tangent) : frame_about(point.shading);
  surface.wo = to_local(surface.frame, -direction);
  // Which side is seen decides what scatters there; the shading normal says which it is.
  alignas(64) T side[kLanes], facing[kLanes], turn[kLanes];
  store(side, surface.wo.z), store(facing, surface.facing);
  for (int l = 0; l < kWidth<F>; ++l) index[l] = piece[l] < 0 ? 0 : piece[l];
  alignas(64) std::int32_t sides[4 * kLanes];  // front, back, two_sided, light
  gather_quads<std::int32_t, kWidth<F>>(scene.sides, sizeof(PieceSides), index, sides);
  for (int l = 0; l < kWidth<F>; ++l) {
    const std::int32_t front = sides[l], back = sides[kLanes + l], two_sided = sides[2 * kLanes + l],
                       light = sides[3 * kLanes + l], seen = side[l] < T(0) ? back : front;
    surface.material[l] = piece[l] < 0 ? -1 : seen;
    surface.light[l] = (piece[l] >= 0) & (facing[l] > T(0)) ? light : -1;
    turn[l] = (side[l] < T(0)) & (two_sided != 0) ? T(1) : T(0);
  }
  if (!scene.two_sided) return;
  const auto turned = load_mask<F>(turn);
  surface.frame.y = select_vec(turned, -surface.frame.y, surface.frame.y);
  surface.frame.z = select_vec(turned, -surface.frame.z, surface.frame.z);
  surface.wo.y = select(turned, -surface.wo.y, surface.wo.y);
  surface.wo.z = select(turned, -surface.wo.z, surface.wo.z);
}

}  // namespace halfslope::kernel
