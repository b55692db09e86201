// Pictures for the screen and for print: PNG files of 8-bit RGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace halfslope {

/// width × height pixels of red, green, blue in sRGB, row by row from the top-left pixel: 3 · width · height bytes.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> values;

  RgbImage() = default;
  /// All white.
  RgbImage(int image_width, int image_height)
      : width(image_width),
        height(image_height),
        values(3 * static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height), 255) {}
  std::uint8_t* pixel(int x, int y) { return values.data() + offset(x, y); }
  const std::uint8_t* pixel(int x, int y) const { return values.data() + offset(x, y); }

 private:
  std::size_t offset(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

/// The bytes of a PNG file (W3C, Portable Network Graphics, 2nd ed.) of 8 bits a channel, one channel where
/// the image is grey throughout and three elsewhere, marked as sRGB, and with its physical size where `pixels_per_inch`
/// > 0. They depend on the image alone (and on the libpng and zlib installed): no date, no text. The image must not be
/// empty. Throws Error(kIo) where it cannot be encoded.
std::string encode_png(const RgbImage& image, double pixels_per_inch = 0);

/// Writes encode_png()'s bytes atomically (core/atomic_file.h). Throws Error(kIo).
void write_png(const std::filesystem::path& path, const RgbImage& image, double pixels_per_inch = 0);

}  // namespace halfslope
