// What a ray from the eye sees, as the kernels of one point start from it.
#pragma once

#include "core/integral.h"
#include "estimators/transport_calls.h"
#include "scenes/scene.h"

namespace halfslope {

/// A point that the eye sees, or what lies beyond all shapes.
struct SeenPoint {
  Color emitted = {0, 0, 0};  ///< towards the eye
  /// Light that delta lobes at the point send to the eye from the emitters they meet, and light from those delta lights
  /// that are not chosen from: its directions are given, so there is nothing to sample.
  Color certain = {0, 0, 0};
  /// Whether anything is left to sample: something scatters there in a continuous lobe, and there is a light to choose.
  bool samples = false;
  StartPoint<double> start = {};
};

/// What the ray, in the kernels' lengths, sees first.
SeenPoint see(const TransportScene<double>& scene, const Vec3& origin, const Vec3& direction);

/// The same in another precision.
template <class T>
StartPoint<T> rounded(const StartPoint<double>& start);

}  // namespace halfslope
