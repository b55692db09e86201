// A scene as the kernels of one pixel see it (estimators/pixel_data.h), made from the scene and the point seen.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimators/occlusion.h"
#include "estimators/pixel_data.h"
#include "scenes/scene.h"

namespace halfslope {

/// What emits, and how technique `surface` finds it among all surfaces.
struct Emitters {
  std::vector<int> lights;  ///< indices of the emitting primitives
  /// PixelData::surface_last; each light has at least one of the 2³² words, so that the technique reaches it.
  std::vector<std::uint32_t> surface_last;
  std::vector<double> surface_probability;  ///< of choosing each light, exactly: its words · 2⁻³²
};
Emitters find_emitters(const Scene& scene);

/// Whether primitive `shape` may come between the receiver and light `light` (an index into the primitives).
bool may_shade(const Scene& scene, const Receiver& receiver, int light, int shape);

/// One pixel in one precision: the data and the arrays that it points to.
template <class T>
struct LocalPixel {
  PixelData<T> data;
  std::vector<LocalLight<T>> lights;
  std::vector<LocalShape<T>> occluders;

  /// `to_eye` is unit length and on the side of the receiver's normal. Refers to `emitters` from then on.
  LocalPixel(const Scene& scene, const Emitters& emitters, const Receiver& receiver, const Vec3& to_eye);
  LocalPixel(const LocalPixel&) = delete;
  LocalPixel& operator=(const LocalPixel&) = delete;
};

extern template struct LocalPixel<float>;
extern template struct LocalPixel<double>;

}  // namespace halfslope
