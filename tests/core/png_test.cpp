#include "core/png.h"

#include <gmock/gmock.h>
#include <png.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "core/atomic_file.h"
#include "core/error.h"

namespace halfslope {
namespace {

RgbImage noise(int width, int height, unsigned seed) {
  RgbImage image(width, height);
  std::mt19937 random(seed);
  for (auto& value : image.values) value = static_cast<std::uint8_t>(random());
  return image;
}

/// libpng's own reader, by its simplified interface, which verifies every chunk's CRC.
RgbImage decode(const std::string& bytes, png_uint_32 stored = PNG_FORMAT_RGB) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()), 0) << png.message;
  EXPECT_EQ(png.warning_or_error, 0u) << png.message;
  EXPECT_EQ(png.format, stored);
  png.format = PNG_FORMAT_RGB;
  RgbImage image(static_cast<int>(png.width), static_cast<int>(png.height));
  EXPECT_NE(png_image_finish_read(&png, nullptr, image.values.data(), 0, nullptr), 0) << png.message;
  return image;
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t k = 0; k < 4; ++k) word = word << 8 | static_cast<unsigned char>(bytes[at + k]);
  return word;
}

TEST(Png, PixelsComeBackThroughLibpng) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 300}, {300, 1}, {257, 129}}) {
    const RgbImage image = noise(width, height, 1);
    const RgbImage back = decode(encode_png(image));
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.values, image.values);
  }
}

TEST(Png, AGreyImageTakesOneChannel) {
  RgbImage image = noise(257, 129, 5);
  for (std::size_t i = 0; i < image.values.size(); i += 3) image.values[i + 1] = image.values[i + 2] = image.values[i];
  const std::string bytes = encode_png(image);
  EXPECT_EQ(decode(bytes, PNG_FORMAT_GRAY).values, image.values);
  image.pixel(256, 128)[1] ^= 1;  // the last pixel alone has a colour
  EXPECT_EQ(decode(encode_png(image)).values, image.values);
  EXPECT_LT(bytes.size(), encode_png(image).size());
}

TEST(Png, BytesDependOnTheImageAlone) {
  const RgbImage image = noise(64, 48, 2);
  EXPECT_EQ(encode_png(image), encode_png(image));
  RgbImage other = image;
  other.pixel(63, 47)[2] ^= 1;
  EXPECT_NE(encode_png(image), encode_png(other));
  EXPECT_EQ(encode_png(image).find("tIME"), std::string::npos);
  EXPECT_EQ(encode_png(image).find("tEXt"), std::string::npos);
}

TEST(Png, PhysicalSizeIsInPixelsAMetre) {
  const std::string bytes = encode_png(noise(4, 4, 3), 288);
  const std::size_t chunk = bytes.find("pHYs");
  ASSERT_NE(chunk, std::string::npos);
  EXPECT_EQ(big_endian(bytes, chunk + 4), 11339u);  // 288 / 0.0254 = 11338.6
  EXPECT_EQ(big_endian(bytes, chunk + 8), 11339u);
  EXPECT_EQ(bytes[chunk + 12], 1);  // the unit is the metre
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);
  EXPECT_EQ(encode_png(noise(4, 4, 3)).find("pHYs"), std::string::npos);
}

TEST(Png, WhatCannotBeWrittenIsAnIoErrorWithThePath) {
  try {
    write_png("/dev/null/x.png", noise(2, 2, 4));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kIo);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/dev/null/x.png"));
  }
  const auto path = std::filesystem::temp_directory_path() / ("halfslope-png-" + std::to_string(::getpid()) + ".png");
  write_png(path, noise(5, 7, 5));
  EXPECT_EQ(decode(read_file(path)).values, noise(5, 7, 5).values);
  std::filesystem::remove(path);
}

// A width that libpng refuses (its limit is a million) comes back as our error, through C code.
TEST(Png, ARefusalOfLibpngIsOurError) {
  const RgbImage wide(2000000, 1);
  try {
    encode_png(wide);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kIo);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("2000000 x 1"));
  }
}

}  // namespace
}  // namespace halfslope
