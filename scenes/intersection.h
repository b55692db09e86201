// A ray and a sphere, by the form that holds for small and distant spheres.
#pragma once

#include "core/packet.h"
#include "scenes/vec.h"

namespace halfslope {

/// R² − l², the square of the half chord that a line cuts from a sphere, negative where it misses; l is the distance of
/// the line's closest approach to the centre, `from_center` the ray's origin less the centre, |direction| = 1 and
/// `along` = from_center · direction. A quarter of the discriminant b² − 4ac, which would cancel where |from_center|
/// is large beside R (E. Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019).
template <class F>
inline F half_chord_squared(const Vec<F>& from_center, const Vec<F>& direction, const F& along, const F& radius) {
  const F closest = length(from_center - along * direction);
  return (radius - closest) * (radius + closest);
}

}  // namespace halfslope
