// Lights, chosen, sampled and met, inside a kernel.
//
// A light is chosen by one of the LightChoices and a point on it drawn by area or by solid angle. Densities are in
// solid angle at the receiver, the choice's probability included.
#pragma once

#include "estimators/transport_choice.h"
#include "scenes/measure.h"
#include "scenes/sphere_cone.h"
#include "scenes/spherical_rectangle.h"
#include "scenes/spherical_triangle.h"
#include "scenes/warp.h"

namespace halfslope::kernel {

/// A light drawn for each lane.
template <class F, int C>
struct LightSample {
  Vec<F> wi;      ///< unit length
  Vec<F> point;   ///< where `distance` along wi ends, on the light
  Vec<F> normal;  ///< the light's there; 0 where it is no surface
  F distance;
  F weight[C];                             ///< radiance over density, 0 where no light comes
  F pdf;                                   ///< 0 for delta lights
  mask_t<F> delta;                         ///< whether it is one that no other technique finds
  alignas(64) std::int32_t piece[kLanes];  ///< −1: no surface
};

/// The lights that are sampled by solid angle where that is asked for; disks and cylinders are by area always.
constexpr bool has_solid_angle(LightKind kind) {
  return kind == LightKind::kRectangle || kind == LightKind::kTriangle || kind == LightKind::kSphere;
}

/// Where drawn points lie, before it is asked whether they face the receiver.
template <class F>
struct LightPlace {
  Vec<F> point, normal;
  F pdf;  ///< in 1/area, or in 1/sr where they are drawn by solid angle
};

template <class F>
inline LightPlace<F> place_on_flat(const TransportScene<scalar_t<F>>& scene, LightKind kind, bool by_solid_angle,
                                   const LaneEntries<F, LightElement<scalar_t<F>>>& lights, const std::int32_t* piece,
                                   const ReceiverPoint<F>& receiver, const F& u1, const F& u2) {
  using T = scalar_t<F>;
  const F one(T(1));
  const LaneEntries<F, FlatPiece<T>> flats(scene.flats, piece);
  const Vec<F> p0 = gather_vec(flats, &FlatPiece<T>::p0), u = gather_vec(flats, &FlatPiece<T>::u),
               v = gather_vec(flats, &FlatPiece<T>::v);
  LightPlace<F> place;
  place.normal = gather_vec(flats, &FlatPiece<T>::normal);
  if (by_solid_angle && kind == LightKind::kTriangle) {
    const TrianglePoint<F> drawn = sample_triangle_solid_angle(p0 - receiver.position, u, v, u1, u2);
    place.point = p0 + drawn.b1 * u + drawn.b2 * v;
    place.pdf = one / drawn.solid_angle;
    return place;
  }
  if (by_solid_angle && kind == LightKind::kRectangle) {
    const RectanglePoint<F> drawn = sample_rectangle_solid_angle(p0 - receiver.position, u, v, u1, u2);
    place.point = p0 + drawn.a * u + drawn.b * v;
    place.pdf = one / drawn.solid_angle;
    return place;
  }
  F a = u1, b = u2;
  if (kind == LightKind::kTriangle) {
    const F root = sqrt(u1);
    a = root * (one - u2);
    b = root * u2;
  } else if (kind == LightKind::kDisk) {
    const DiskPoint<F> disk = uniform_disk(u1, u2);
    a = disk.x;
    b = disk.y;
  }
  place.point = p0 + a * u + b * v;
  place.pdf = lights(&LightElement<T>::pdf_area);
  return place;
}

template <class F>
inline LightPlace<F> place_on_cylinder(const TransportScene<scalar_t<F>>& scene,
                                       const LaneEntries<F, LightElement<scalar_t<F>>>& lights,
                                       const std::int32_t* cylinder, const F& u1, const F& u2) {
  using T = scalar_t<F>;
  const LaneEntries<F, CylinderPiece<T>> cylinders(scene.cylinders, cylinder);
  const Vec<F> axis = gather_vec(cylinders, &CylinderPiece<T>::axis);
  const Frame<F> about = frame_about(axis);
  const auto azimuth = sin_cos_2pi(u1);
  const Vec<F> outward = azimuth.cos * about.x + azimuth.sin * about.y;
  LightPlace<F> place;
  place.point = gather_vec(cylinders, &CylinderPiece<T>::p0) + u2 * cylinders(&CylinderPiece<T>::length) * axis +
                cylinders(&CylinderPiece<T>::radius) * outward;
  place.normal = cylinders(&CylinderPiece<T>::side) * outward;
  place.pdf = lights(&LightElement<T>::pdf_area);
  return place;
}

/// A point on a sphere: of its whole area, or of what the receiver sees of it.
template <class F>
inline LightPlace<F> place_on_sphere(const TransportScene<scalar_t<F>>& scene, bool by_solid_angle,
                                     const LaneEntries<F, LightElement<scalar_t<F>>>& lights,
                                     const std::int32_t* sphere, const ReceiverPoint<F>& receiver, const F& u1,
                                     const F& u2) {
  using T = scalar_t<F>;
  const LaneEntries<F, SpherePiece<T>> spheres(scene.spheres, sphere);
  const Vec<F> center = gather_vec(spheres, &SpherePiece<T>::center);
  const F radius = spheres(&SpherePiece<T>::radius), side = spheres(&SpherePiece<T>::side);
  if (by_solid_angle) {
    const SpherePoint<F> drawn = sample_sphere_solid_angle(center - receiver.position, radius, u1, u2);
    return {receiver.position + drawn.distance * drawn.direction, side * drawn.outward, drawn.pdf};
  }
  const Vec<F> outward = uniform_sphere(u1, u2);
  return {center + radius * outward, side * outward, lights(&LightElement<T>::pdf_area)};
}

/// Radiance of delta lights along the way to the receiver, r² divided out.
template <class F>
inline F from_spot(const LaneEntries<F, LightElement<scalar_t<F>>>& lights, const Vec<F>& wi) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  const F cosine = -dot(wi, gather_vec(lights, &LightElement<T>::axis));
  const F angle = arccos(min(max(cosine, -one), one));
  const F cutoff = lights(&LightElement<T>::cutoff), beam = lights(&LightElement<T>::beam_width),
          fade = lights(&LightElement<T>::inverse_fade);
  return select(angle <= beam, one, select(angle < cutoff, (cutoff - angle) * fade, zero));
}

/// Nothing drawn.
template <class F, int C>
inline void clear_light(LightSample<F, C>& sample) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  sample.delta = no_lanes<F>();
  sample.wi = {zero, zero, one};
  sample.point = sample.normal = {zero, zero, zero};
  sample.distance = one;
  sample.pdf = zero;
  for (int c = 0; c < C; ++c) sample.weight[c] = zero;
  for (int l = 0; l < kWidth<F>; ++l) sample.piece[l] = -1;
}

/// Draws a point of each lane's light `element`, which was chosen with that probability (0: there is none).
template <class F, int C>
inline void draw_on_light(const TransportScene<scalar_t<F>>& scene, const LightWay& way, const std::int32_t* element,
                          const F& probability, const ReceiverPoint<F>& receiver, const F& u1, const F& u2,
                          LightSample<F, C>& sample);

/// Draws a light for each lane, and a point on it with the numbers u₁, u₂ in [0, 1).
template <class F, int C>
inline void draw_light(const TransportScene<scalar_t<F>>& scene, const LightWay& way, const std::uint32_t* words,
                       const ReceiverPoint<F>& receiver, const F& u1, const F& u2, LightSample<F, C>& sample) {
  clear_light(sample);
  if (scene.light_count == 0) return;
  alignas(64) std::int32_t element[kLanes];
  const F probability = choose_light<F>(scene, way.choice, words, receiver, element);
  draw_on_light<F, C>(scene, way, element, probability, receiver, u1, u2, sample);
}

template <class F, int C>
inline void draw_on_light(const TransportScene<scalar_t<F>>& scene, const LightWay& way, const std::int32_t* element,
                          const F& probability, const ReceiverPoint<F>& receiver, const F& u1, const F& u2,
                          LightSample<F, C>& sample) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  clear_light(sample);
  const mask_t<F> chosen = probability > zero;
  alignas(64) std::int32_t kind[kLanes], index[kLanes];
  std::uint32_t present = 0;
  for (int l = 0; l < kWidth<F>; ++l) {
    const LightElement<T>& light = scene.lights[element[l]];
    kind[l] = static_cast<std::int32_t>(light.kind);
    sample.piece[l] = light.piece;
    present |= 1u << kind[l];
  }
  F radiance[C];
  const LaneEntries<F, LightElement<T>> lights(scene.lights, element);
  lights(&LightElement<T>::radiance, radiance);

  for (std::uint32_t left = present; left != 0; left &= left - 1) {
    const auto now = static_cast<LightKind>(std::countr_zero(left));
    const mask_t<F> lanes = lanes_with<F>(kind, static_cast<std::int32_t>(now)) & chosen;
    const bool surface = now <= LightKind::kCylinder;
    if (surface) {
      // Lanes of other kinds read the piece of one that is.
      std::int32_t some = 0;
      for (int l = 0; l < kWidth<F>; ++l) {
        if (kind[l] == static_cast<std::int32_t>(now)) some = sample.piece[l];
      }
      const std::int32_t first = now == LightKind::kSphere     ? scene.flat_count
                                 : now == LightKind::kCylinder ? scene.flat_count + scene.sphere_count
                                                               : 0;
      for (int l = 0; l < kWidth<F>; ++l) {
        index[l] = (kind[l] == static_cast<std::int32_t>(now) ? sample.piece[l] : some) - first;
      }
      const bool by_angle = way.by_solid_angle && has_solid_angle(now);
      LightPlace<F> place;
      if (now == LightKind::kSphere) {
        place = place_on_sphere<F>(scene, by_angle, lights, index, receiver, u1, u2);
      } else if (now == LightKind::kCylinder) {
        place = place_on_cylinder<F>(scene, lights, index, u1, u2);
      } else {
        place = place_on_flat<F>(scene, now, by_angle, lights, index, receiver, u1, u2);
      }
      const Vec<F> way_there = place.point - receiver.position;
      const F distance2 = dot(way_there, way_there), inverse = one / sqrt(distance2), distance = distance2 * inverse;
      const Vec<F> wi = inverse * way_there;
      const F cosine = -dot(place.normal, wi);
      const F pdf = by_angle ? place.pdf : pdf_solid_angle_from_area(place.pdf, distance, cosine);
      const F inverse_pdf = by_angle ? one / place.pdf : (cosine * inverse) / (place.pdf * distance);
      const mask_t<F> faces = lanes & (cosine > zero) & (distance2 > zero);
      sample.wi = select_vec(lanes & (distance2 > zero), wi, sample.wi);
      sample.point = select_vec(lanes, place.point, sample.point);
      sample.normal = select_vec(lanes, place.normal, sample.normal);
      sample.distance = select(lanes, distance, sample.distance);
      sample.pdf = select(faces, probability * pdf, sample.pdf);
      for (int c = 0; c < C; ++c) {
        sample.weight[c] = select(faces, radiance[c] * (inverse_pdf / probability), sample.weight[c]);
      }
    } else if (now == LightKind::kEnvironment) {
      const EnvironmentSample<F> drawn = sample_environment(*scene.environment, u1, u2);
      sample.wi = select_vec(lanes, drawn.direction, sample.wi);
      sample.distance = select(lanes, F(std::numeric_limits<T>::max()), sample.distance);
      const mask_t<F> some = lanes & (drawn.pdf > zero);
      sample.pdf = select(some, probability * drawn.pdf, sample.pdf);
      for (int c = 0; c < C; ++c) {
        sample.weight[c] = select(some, drawn.radiance[c] / (drawn.pdf * probability), sample.weight[c]);
      }
    } else {
      sample.delta = sample.delta | lanes;
      const Vec<F> axis = gather_vec(lights, &LightElement<T>::axis);
      if (now == LightKind::kDirectional) {
        sample.wi = select_vec(lanes, -axis, sample.wi);
        sample.distance = select(lanes, F(std::numeric_limits<T>::max()), sample.distance);
        for (int c = 0; c < C; ++c) sample.weight[c] = select(lanes, radiance[c] / probability, sample.weight[c]);
        continue;
      }
      const Vec<F> position = gather_vec(lights, &LightElement<T>::position);
      const Vec<F> way_there = position - receiver.position;
      const F distance2 = dot(way_there, way_there), inverse = one / sqrt(distance2);
      const mask_t<F> apart = lanes & (distance2 > zero);
      const Vec<F> wi = inverse * way_there;
      const F factor = now == LightKind::kSpot ? from_spot<F>(lights, wi) : one;
      sample.wi = select_vec(apart, wi, sample.wi);
      sample.point = select_vec(lanes, position, sample.point);
      sample.distance = select(lanes, distance2 * inverse, sample.distance);
      for (int c = 0; c < C; ++c) {
        sample.weight[c] = select(apart, radiance[c] * factor * inverse * (inverse / probability), sample.weight[c]);
      }
    }
  }
}

/// The density of draw_light for the light element that each lane's direction `wi` from the receiver has met at
/// `point`, under the cosine `cosine` on its front; lanes with element −1 hold nothing of use.
template <class F>
inline F light_pdf(const TransportScene<scalar_t<F>>& scene, const LightWay& way, const std::int32_t* element,
                   const ReceiverPoint<F>& receiver, const Vec<F>& wi, const Vec<F>& point, const F& cosine) {
  using T = scalar_t<F>;
  alignas(64) std::int32_t index[kLanes], kind[kLanes], piece[kLanes];
  std::uint32_t present = 0;
  for (int l = 0; l < kWidth<F>; ++l) {
    index[l] = element[l] < 0 ? 0 : element[l];
    kind[l] = static_cast<std::int32_t>(scene.lights[index[l]].kind);
    if (element[l] >= 0) present |= 1u << kind[l];
  }
  const F probability = light_probability<F>(scene, way.choice, index, receiver);
  const F distance = length(point - receiver.position);
  const LaneEntries<F, LightElement<T>> lights(scene.lights, index);
  F pdf = pdf_solid_angle_from_area(lights(&LightElement<T>::pdf_area), distance, cosine);
  if (present & (1u << static_cast<int>(LightKind::kEnvironment))) {
    const mask_t<F> beyond = lanes_with<F>(kind, static_cast<std::int32_t>(LightKind::kEnvironment));
    pdf = select(beyond, environment_pdf(*scene.environment, wi), pdf);
  }
  if (!way.by_solid_angle) return probability * pdf;
  for (const LightKind now : {LightKind::kRectangle, LightKind::kTriangle, LightKind::kSphere}) {
    if (!(present & (1u << static_cast<int>(now)))) continue;
    const mask_t<F> lanes = lanes_with<F>(kind, static_cast<std::int32_t>(now));
    std::int32_t some = 0;
    for (int l = 0; l < kWidth<F>; ++l) {
      if (kind[l] == static_cast<std::int32_t>(now)) some = scene.lights[index[l]].piece;
    }
    for (int l = 0; l < kWidth<F>; ++l) {
      piece[l] = kind[l] == static_cast<std::int32_t>(now) ? scene.lights[index[l]].piece : some;
    }
    if (now == LightKind::kSphere) {
      for (int l = 0; l < kWidth<F>; ++l) piece[l] -= scene.flat_count;
      const LaneEntries<F, SpherePiece<T>> spheres(scene.spheres, piece);
      const Vec<F> center = gather_vec(spheres, &SpherePiece<T>::center);
      const F radius = spheres(&SpherePiece<T>::radius);
      mask_t<F> outside;
      pdf = select(lanes, sphere_solid_angle_pdf(center - receiver.position, radius, outside), pdf);
      continue;
    }
    const LaneEntries<F, FlatPiece<T>> flats(scene.flats, piece);
    const Vec<F> corner = gather_vec(flats, &FlatPiece<T>::p0) - receiver.position,
                 u = gather_vec(flats, &FlatPiece<T>::u), v = gather_vec(flats, &FlatPiece<T>::v);
    const F angle =
        now == LightKind::kTriangle ? triangle_solid_angle(corner, u, v) : rectangle_solid_angle(corner, u, v);
    pdf = select(lanes, F(T(1)) / angle, pdf);
  }
  return probability * pdf;
}

/// Points a shadow ray at what was drawn, from the surface that it leaves.
template <class F, int C>
inline void aim(const TransportScene<scalar_t<F>>& scene, const Surface<F>& surface, const LightSample<F, C>& drawn,
                int lane, RayRow<scalar_t<F>>& rays, scalar_t<F>* limits) {
  using T = scalar_t<F>;
  if (!scene.embree) {
    rays.origin.template store<F>(lane, surface.position);
    rays.direction.template store<F>(lane, drawn.wi);
    store(limits + lane, drawn.distance);
    return;
  }
  // Both ends are off their surfaces; the ray between them may be a hair turned.
  const Vec<F> start = leave<F>(scene, surface.position, surface.normal, drawn.wi);
  const Vec<F> end = leave<F>(scene, drawn.point, drawn.normal, -drawn.wi);
  const Vec<F> between = end - start;
  const F distance = length(between);
  const mask_t<F> finite = drawn.distance < F(std::numeric_limits<T>::max());
  rays.origin.template store<F>(lane, start);
  rays.direction.template store<F>(lane,
                                   select_vec(finite & (distance > F(T(0))), (F(T(1)) / distance) * between, drawn.wi));
  store(limits + lane, select(finite, distance, drawn.distance));
}

}  // namespace halfslope::kernel
