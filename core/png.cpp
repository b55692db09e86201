#include "core/png.h"

#include <png.h>

#include <cmath>
#include <csetjmp>
#include <exception>

#include "core/assertion.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace halfslope {
namespace {

/// libpng's view of us: where bytes go, and what went wrong.
struct Sink {
  std::string bytes, problem;
};

void keep_problem(png_structp png, png_const_charp text) {
  static_cast<Sink*>(png_get_error_ptr(png))->problem = text;
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

// No exception may pass through libpng, which is C.
void append(png_structp png, png_bytep data, png_size_t size) {
  bool appended = true;
  try {
    static_cast<Sink*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), size);
  } catch (const std::exception&) {
    appended = false;
  }
  if (!appended) png_error(png, "out of memory");
}

/// The rows of an image: of three channels, or of one where all three are equal everywhere.
struct Rows {
  int width, height, channels;
  const std::uint8_t* values;
};

/// Every third byte where each is followed by two like it; empty for an image with colour.
std::vector<std::uint8_t> grey_values(const RgbImage& image) {
  std::vector<std::uint8_t> grey;
  for (std::size_t i = 0; i < image.values.size(); i += 3) {
    const std::uint8_t value = image.values[i];
    if (image.values[i + 1] != value || image.values[i + 2] != value) return {};
    grey.push_back(value);
  }
  return grey;
}

/// False where libpng jumped out; nothing here has a destructor that the jump could skip.
bool write_chunks(png_structp png, png_infop info, const Rows& image, double pixels_per_inch) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               image.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (pixels_per_inch > 0) {
    const auto per_metre = static_cast<png_uint_32>(std::lround(pixels_per_inch / 0.0254));
    png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);
  }
  png_write_info(png, info);
  const auto stride = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  for (int y = 0; y < image.height; ++y) png_write_row(png, image.values + static_cast<std::size_t>(y) * stride);
  png_write_end(png, info);
  return true;
}

}  // namespace

std::string encode_png(const RgbImage& image, double pixels_per_inch) {
  assert_equal(image.width > 0 && image.height > 0, true, "an image that is not empty");
  assert_equal(image.values.size(), RgbImage(image.width, image.height).values.size(), "bytes of an image");
  const std::vector<std::uint8_t> grey = grey_values(image);
  const Rows rows = {image.width, image.height, grey.empty() ? 3 : 1, grey.empty() ? image.values.data() : grey.data()};
  Sink sink;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, keep_problem, ignore_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (png) png_set_write_fn(png, &sink, append, nullptr);
  const bool written = info && write_chunks(png, info, rows, pixels_per_inch);
  png_destroy_write_struct(&png, &info);
  if (!written) {
    fail(ExitCode::kIo, "an image of {} x {} pixels cannot be encoded as PNG: {}", image.width, image.height,
         sink.problem.empty() ? "libpng does not start" : sink.problem);
  }
  return std::move(sink.bytes);
}

void write_png(const std::filesystem::path& path, const RgbImage& image, double pixels_per_inch) {
  write_file_atomically(path, encode_png(image, pixels_per_inch));
}

}  // namespace halfslope
