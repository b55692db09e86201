// Radiance as the bytes of a screen.
#pragma once

#include <cstdint>
#include <span>

#include "core/png.h"

namespace halfslope {

/// The opto-electronic transfer function of sRGB, IEC 61966-2-1: 12.92 x up to 0.0031308, else
/// 1.055 x^(1/2.4) − 0.055. Domain: [0, 1].
double srgb_encoded(double linear);

/// The byte of a radiance: round(255 · srgb_encoded(min(max(x, 0), 1))) of x = 2^stops · radiance. NaN is 0.
std::uint8_t tone_mapped(double radiance, double stops);

/// `values` of width × height pixels, `channels` (1: grey, or 3: R, G, B) a pixel, row by row from the top-left. A
/// pixel with a value that is not finite is magenta, which no grey picture has.
RgbImage tone_mapped_image(std::span<const double> values, int width, int height, int channels, double stops);

}  // namespace halfslope
