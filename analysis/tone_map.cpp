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
  constexpr std::uint8_t kMagenta[3] = {255, 0, 255};
  const auto of_pixel = static_cast<std::size_t>(channels);
  for (std::size_t p = 0; 3 * p < image.values.size(); ++p) {
    const auto pixel = values.subspan(p * of_pixel, of_pixel);
    const bool finite = std::all_of(pixel.begin(), pixel.end(), [](double v) { return std::isfinite(v); });
    for (std::size_t c = 0; c < 3; ++c)
      image.values[3 * p + c] = finite ? tone_mapped(pixel[c % of_pixel], stops) : kMagenta[c];
  }
  return image;
}

}  // namespace halfslope
