// Shapes that are no mesh, as Embree calls for them. For scenes/embree_scene.cpp alone.
#pragma once

#include <embree3/rtcore.h>

#include "scenes/scene.h"

namespace halfslope {

template <class Shape>
struct UserShape {
  Shape shape;
  double margin;  ///< added to its box
};

/// Makes `geometry`, of Embree's user type, the one shape, which must outlive it.
void set_callbacks(RTCGeometry geometry, UserShape<Sphere>& shape);
void set_callbacks(RTCGeometry geometry, UserShape<Flat>& shape);
void set_callbacks(RTCGeometry geometry, UserShape<Cylinder>& shape);

}  // namespace halfslope
