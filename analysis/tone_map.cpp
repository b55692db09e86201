#include "analysis/tone_map.h"

#include <algorithm>
#include <cmath>

#include "core/assertion.h"

namespace halfslope {

double srgb_encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint8_t tone_mapped(double radiance, double stops) {
  const double exposed = std::exp2(stops) * radiance;
  if (!(exposed > 0)) return 0;
  return static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(std::min(exposed, 1.0))));
}

RgbImage tone_mapped_image(std::span<const double> values, int width, int height, int channels, double stops) {
  assert_equal(channels == 1 || channels == 3, true, "one channel or three");
  RgbImage image(width, height);
  assert_equal(values.size() * 3, image.values.size() * static_cast<std::size_t>(channels), "values of an image");
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = tone_mapped(values[channels == 3 ? i : i / 3], stops);
  }
  return image;
}

}  // namespace halfslope
