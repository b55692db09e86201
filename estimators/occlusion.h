// Which shapes can come between a point and a light: decided once a pixel, so that rays need not ask.
#pragma once

#include "scenes/scene.h"

namespace halfslope {

/// A receiving point and the side of it that reflects.
struct Receiver {
  Vec3 position, normal;
  int primitive;
};

/// Whether some point of the light's emitting side can be above the receiver's horizon and face it; `own` where the
/// receiver lies on the light. Never false for a light that contributes, but for contact: planes that are closer than
/// 1e-9 of the sizes at hand count as one.
bool light_reaches(const Receiver& receiver, const Primitive& light, bool own);

/// Whether the shape can block a segment from the receiver to a point of the light. Never false for one that does, but
/// for contact: a rectangle that the receiver lies in, or that the light is flush with, blocks nothing.
bool can_occlude(const Receiver& receiver, const Primitive& light, const Primitive& shape);

/// Whether the point is inside the sphere; on its surface, where `own` says so, the side of `normal` decides.
bool inside_sphere(const Receiver& receiver, const Sphere& sphere, bool own);

}  // namespace halfslope
