// The rays to follow.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace halfslope {

using Vec3 = Eigen::Vector3d;

struct Ray {
  Vec3 origin = Vec3::Zero(), direction = Vec3::UnitZ();  ///< direction is unit length
};

/// How light at (x, y) pixels from a pixel's centre counts for it: f(x) f(y), normalised to integral 1.
struct ReconstructionFilter {
  enum class Kind : std::uint8_t {
    kBox,      ///< 1 for |x| < radius
    kTent,     ///< 1 − |x|/radius
    kGaussian  ///< exp(−x²/(2 stddev²)) − exp(−radius²/(2 stddev²)), radius 4 stddev, as Mitsuba's
  } kind = Kind::kGaussian;
  double radius = 2;    ///< in pixels
  double stddev = 0.5;  ///< of kGaussian
};

/// perspective: a pinhole camera; thinlens: with a lens of `aperture_radius` focused at `focus_distance`; orthographic:
/// parallel rays, the image plane is [−1, 1]² scaled by `left` and `up`'s lengths there. radiancemeter and
/// mradiancemeter: rays given one by one, each a pixel of a 1 × n image.
struct Sensor {
  enum class Kind : std::uint8_t { kPerspective, kRays, kThinLens, kOrthographic } kind = Kind::kPerspective;
  Vec3 origin = Vec3::Zero();
  /// Orthogonal; left is the image's left. Unit length, but left and up of kOrthographic: half the image's extent.
  Vec3 left = Vec3::UnitX(), up = Vec3::UnitY(), forward = Vec3::UnitZ();
  double fov_degrees = 45;
  enum class FovAxis : std::uint8_t { kX, kY, kDiagonal, kSmaller, kLarger } fov_axis = FovAxis::kX;
  double aperture_radius = 0, focus_distance = 1;  ///< of kThinLens
  std::vector<Ray> rays;                           ///< where kind is kRays
  int width = 768, height = 576;
  ReconstructionFilter filter;  ///< of path estimators' pixels; rays given one by one have none

  /// The ray through the centre of pixel (x, y) of a width × height image, from the middle of the lens; y grows
  /// downwards. For kRays, y is 0 and x the ray's index.
  Ray ray(int x, int y, int image_width, int image_height) const;
};

}  // namespace halfslope
