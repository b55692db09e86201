// Colours that vary over a surface.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace halfslope {

using Rgb = Eigen::Array3d;

/// Linear RGB, rows from the top, 3 floats a pixel.
struct Bitmap {
  int width = 0, height = 0;
  std::vector<float> rgb;
  std::string file;  ///< where it was read from
};

/// Whether every pixel's channels are equal.
bool is_grey(const Bitmap& bitmap);

/// A colour for each (u, v) of a surface. Its coordinates are first taken through `to_uv`, an affine map.
struct Texture {
  enum class Kind : std::uint8_t {
    kCheckerboard,  ///< color0 where ⌊2u⌋ + ⌊2v⌋ is even, color1 elsewhere: two checks a unit each way
    kBitmap         ///< texel centres at (i + ½)/width; v = 0 is the bottom row
  } kind = Kind::kCheckerboard;
  enum class Filter : std::uint8_t { kBilinear, kNearest } filter = Filter::kBilinear;
  enum class Wrap : std::uint8_t { kRepeat, kMirror, kClamp } wrap = Wrap::kRepeat;
  Rgb color0 = Rgb::Constant(0.4), color1 = Rgb::Constant(0.2);
  std::shared_ptr<const Bitmap> bitmap;  ///< of kBitmap, never null there
  Eigen::Matrix<double, 2, 3> to_uv = Eigen::Matrix<double, 2, 3>::Identity();
};

/// The colour at (u, v).
Rgb texture_value(const Texture& texture, double u, double v);

/// Over the unit square, where `to_uv` is the identity.
Rgb texture_mean(const Texture& texture);

}  // namespace halfslope
