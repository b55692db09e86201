#include "scenes/bitmap_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/exr.h"
#include "tests/scenes/scene_folder.h"

namespace halfslope {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A PNG of any format that libpng's simplified interface writes.
std::string png(png_uint_32 format, int width, int height, const void* values) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  png_alloc_size_t size = 0;
  png_image_write_to_memory(&image, nullptr, &size, 0, values, 0, nullptr);
  std::string bytes(size, '\0');
  EXPECT_TRUE(png_image_write_to_memory(&image, bytes.data(), &size, 0, values, 0, nullptr));
  bytes.resize(size);
  return bytes;
}

class BitmapReader : public testing::Test {
 protected:
  Bitmap read(const std::string& bytes, bool raw = true) { return read_bitmap(folder_.write("image", bytes), raw); }
  std::string failure(const std::string& bytes) {
    try {
      read(bytes);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      const std::string path = (folder_ / "image").string(), text = error.what();
      EXPECT_TRUE(text.starts_with(path)) << text;
      return text.substr(path.size());
    }
    return "no error";
  }
  SceneFolder folder_;
};

TEST_F(BitmapReader, GreyRgbAndAlpha) {
  const std::uint8_t grey[] = {0, 51, 255}, rgb[] = {255, 0, 51}, rgba[] = {255, 0, 51, 0};
  EXPECT_THAT(read(png(PNG_FORMAT_GRAY, 3, 1, grey)).rgb, ElementsAre(0, 0, 0, 0.2f, 0.2f, 0.2f, 1, 1, 1));
  EXPECT_THAT(read(png(PNG_FORMAT_RGB, 1, 1, rgb)).rgb, ElementsAre(1, 0, 0.2f));
  EXPECT_THAT(read(png(PNG_FORMAT_RGBA, 1, 1, rgba)).rgb, ElementsAre(1, 0, 0.2f));  // whatever its opacity
  EXPECT_EQ(read(png(PNG_FORMAT_GRAY, 3, 1, grey)).width, 3);
}

TEST_F(BitmapReader, SrgbBecomesLinear) {
  const std::uint8_t grey[] = {0, 10, 128, 255};
  const Bitmap bitmap = read(png(PNG_FORMAT_GRAY, 4, 1, grey), false);
  // IEC 61966-2-1: the straight part up to 0.04045, the power beyond.
  EXPECT_EQ(bitmap.rgb[0], 0);
  EXPECT_NEAR(bitmap.rgb[3], 10 / 255.0 / 12.92, 1e-9);
  EXPECT_NEAR(bitmap.rgb[6], 0.215861, 1e-6);
  EXPECT_EQ(bitmap.rgb[9], 1);
}

TEST_F(BitmapReader, SixteenBits) {
  const std::uint16_t grey[] = {0, 257, 65535};  // given as linear, which libpng writes as it is in 16 bits
  const Bitmap bitmap = read(png(PNG_FORMAT_LINEAR_Y, 3, 1, grey));
  EXPECT_FLOAT_EQ(bitmap.rgb[3], 1.0f / 255);
  EXPECT_FLOAT_EQ(bitmap.rgb[6], 1);
}

TEST_F(BitmapReader, PalettesAndFewBits) {
  // A palette of 2 colours takes one bit a pixel.
  const std::uint8_t indices[] = {0, 1, 1};
  const std::uint8_t colours[] = {255, 0, 0, 0, 0, 255};
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 3;
  image.height = 1;
  image.format = PNG_FORMAT_RGB_COLORMAP;
  image.colormap_entries = 2;
  png_alloc_size_t size = 0;
  png_image_write_to_memory(&image, nullptr, &size, 0, indices, 0, colours);
  std::string bytes(size, '\0');
  ASSERT_TRUE(png_image_write_to_memory(&image, bytes.data(), &size, 0, indices, 0, colours));
  bytes.resize(size);
  EXPECT_THAT(read(bytes).rgb, ElementsAre(1, 0, 0, 0, 0, 1, 0, 0, 1));
}

TEST_F(BitmapReader, OpenExr) {
  const auto exr = [&](const ExrImage& image) {
    write_exr(folder_ / "image.exr", image);
    return read_file(folder_ / "image.exr");
  };
  EXPECT_THAT(read(exr({1, 1, {{"R", {1}}, {"G", {2}}, {"B", {30}}, {"A", {0}}}})).rgb, ElementsAre(1, 2, 30));
  EXPECT_THAT(read(exr({1, 1, {{"Y", {4}}}}), false).rgb, ElementsAre(4, 4, 4));  // linear already
  EXPECT_EQ(failure(exr({1, 1, {{"depth", {4}}, {"R", {4}}}})),
            ": has the channels R, depth, allowed: R, G and B, or Y");
  EXPECT_EQ(failure(exr({2, 1, {{"Y", {4, -1}}}})), ": pixel (1, 0) is -1, allowed: finite numbers from 0");
  EXPECT_EQ(failure(exr({1, 1, {{"Y", {std::numeric_limits<float>::infinity()}}}})),
            ": pixel (0, 0) is inf, allowed: finite numbers from 0");
}

TEST_F(BitmapReader, OtherKindsAreNamed) {
  EXPECT_EQ(failure("\xff\xd8\xff\xe0 JFIF"), ": is a JPEG image, allowed: PNG and OpenEXR");
  EXPECT_EQ(failure("#?RADIANCE\n"), ": is a Radiance RGBE image, allowed: PNG and OpenEXR");
  EXPECT_EQ(failure("hello"), ": is no image of a kind that is known, allowed: PNG and OpenEXR");
  EXPECT_EQ(failure(""), ": is no image of a kind that is known, allowed: PNG and OpenEXR");
}

TEST_F(BitmapReader, EveryPrefixAndManyBrokenBytesAreErrors) {
  std::vector<std::uint8_t> noise(3 * 16 * 16);
  std::mt19937 random(1);
  for (auto& value : noise) value = static_cast<std::uint8_t>(random());
  const std::string whole = png(PNG_FORMAT_RGB, 16, 16, noise.data());
  for (std::size_t length = 0; length + 12 < whole.size(); length += 7) {  // the last 12 bytes say only that it ends
    EXPECT_NE(failure(whole.substr(0, length)), "no error") << length;
  }
  for (int i = 0; i < 300; ++i) {
    std::string broken = whole;
    broken[random() % broken.size()] = static_cast<char>(random());
    failure(broken);  // an error or a picture, but nothing worse
  }
}

TEST_F(BitmapReader, AClaimThatTheFileCannotHoldIsRefusedBeforeItIsAllocated) {
  const std::uint8_t grey[] = {7};
  std::string bytes = png(PNG_FORMAT_GRAY, 1, 1, grey);
  const auto claim = [&](std::uint32_t width, std::uint32_t height) {
    for (int i = 0; i < 4; ++i) {
      bytes[16 + static_cast<std::size_t>(i)] = static_cast<char>(width >> (24 - 8 * i));
      bytes[20 + static_cast<std::size_t>(i)] = static_cast<char>(height >> (24 - 8 * i));
    }
    const auto crc = static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const std::uint8_t*>(bytes.data()) + 12, 17));
    for (int i = 0; i < 4; ++i) bytes[29 + static_cast<std::size_t>(i)] = static_cast<char>(crc >> (24 - 8 * i));
  };
  claim(1 << 13, 1 << 13);
  EXPECT_THAT(failure(bytes), HasSubstr(": claims 8192 x 8192 pixels, more than"));
  claim(1 << 16, 1 << 16);
  EXPECT_EQ(failure(bytes), ": is 65536 x 65536 pixels, allowed: 2^26 of them");
}

}  // namespace
}  // namespace halfslope
