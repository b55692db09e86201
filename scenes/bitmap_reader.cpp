#include "scenes/bitmap_reader.h"

#include <png.h>

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <string_view>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/exr.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;
// Deflate writes at most 258 bytes for two bits.
constexpr std::uint64_t kMostOfDeflate = 1032;

/// libpng's view of us: the bytes left to read, and what went wrong.
struct Source {
  std::string_view bytes;
  std::string problem = {};
};

void keep_problem(png_structp png, png_const_charp text) {
  static_cast<Source*>(png_get_error_ptr(png))->problem = text;
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void take(png_structp png, png_bytep data, png_size_t size) {
  auto& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (size > source.bytes.size()) png_error(png, "it ends too early");
  std::memcpy(data, source.bytes.data(), size);
  source.bytes.remove_prefix(size);
}

/// What the header says, once palettes and few bits are made 8 or 16 bits of grey or RGB.
struct PngSize {
  png_uint_32 width = 0, height = 0;
  std::size_t channels = 0, bytes_per_channel = 0, row_bytes = 0;
};

/// False where libpng jumped out; nothing in these two has a destructor that the jump could skip.
bool read_header(png_structp png, png_infop info, PngSize& size) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  png_set_expand(png);
  png_set_strip_alpha(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  size = {png_get_image_width(png, info), png_get_image_height(png, info), png_get_channels(png, info),
          png_get_bit_depth(png, info) == 16 ? 2u : 1u, png_get_rowbytes(png, info)};
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

/// IEC 61966-2-1.
double linear_of_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Every value that a channel of so many bytes can take, as light.
std::vector<float> decoding_table(std::size_t bytes_per_channel, bool raw) {
  const std::size_t levels = bytes_per_channel == 2 ? 65536 : 256;
  std::vector<float> table(levels);
  for (std::size_t i = 0; i < levels; ++i) {
    const double value = static_cast<double>(i) / static_cast<double>(levels - 1);
    table[i] = static_cast<float>(raw ? value : linear_of_srgb(value));
  }
  return table;
}

/// Ends libpng's reader whichever way the scope is left.
struct PngReader {
  png_structp png;
  png_infop info;
  explicit PngReader(Source& source)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keep_problem, ignore_warning)),
        info(png ? png_create_info_struct(png) : nullptr) {
    if (png) png_set_read_fn(png, &source, take);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void check_pixels(const std::string& path, std::uint64_t width, std::uint64_t height) {
  if (width * height > kMostPixels) {
    fail(ExitCode::kBadInput, "{}: is {} x {} pixels, allowed: 2^26 of them", path, width, height);
  }
}

Bitmap read_png(const std::string& path, std::string_view bytes, bool raw) {
  Source source{bytes};
  const PngReader reader(source);
  PngSize size;
  const auto broken = [&] {
    fail(ExitCode::kBadInput, "{}: is no PNG that can be read: {}", path,
         source.problem.empty() ? "libpng does not start" : source.problem);
  };
  if (!reader.info || !read_header(reader.png, reader.info, size)) broken();
  check_pixels(path, size.width, size.height);
  // A palette's index may be one bit of the file and three bytes here.
  if (std::uint64_t{size.row_bytes} * size.height / 24 > kMostOfDeflate * bytes.size()) {
    fail(ExitCode::kBadInput, "{}: claims {} x {} pixels, more than {} bytes can hold", path, size.width, size.height,
         bytes.size());
  }
  std::vector<std::uint8_t> values(size.row_bytes * size.height);
  std::vector<png_bytep> rows(size.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = values.data() + y * size.row_bytes;
  if (!read_rows(reader.png, rows.data())) broken();

  Bitmap bitmap{static_cast<int>(size.width), static_cast<int>(size.height), {}, path};
  const std::vector<float> table = decoding_table(size.bytes_per_channel, raw);
  const std::size_t pixels = std::size_t{size.width} * size.height, stride = size.channels * size.bytes_per_channel;
  bitmap.rgb.resize(3 * pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint8_t* value = values.data() + pixel * stride + (size.channels < 3 ? 0 : c) * size.bytes_per_channel;
      const std::size_t level = size.bytes_per_channel == 2 ? std::size_t{value[0]} * 256 + value[1] : value[0];
      bitmap.rgb[3 * pixel + c] = table[level];
    }
  }
  return bitmap;
}

Bitmap read_open_exr(const std::filesystem::path& path) {
  const ExrFile file(path);
  check_pixels(path.string(), static_cast<std::uint64_t>(file.width()), static_cast<std::uint64_t>(file.height()));
  std::vector<std::string> names = {"R", "G", "B"};
  if (!file.find("R") && file.find("Y")) names = {"Y"};
  for (const std::string& name : names) {
    if (file.find(name)) continue;
    std::string found;
    for (const auto& channel : file.channels()) found += (found.empty() ? "" : ", ") + channel.name;
    fail(ExitCode::kBadInput, "{}: has the channels {}, allowed: R, G and B, or Y", path.string(), found);
  }
  const ExrImage image = file.read(names);
  Bitmap bitmap{image.width, image.height, {}, path.string()};
  const std::size_t pixels = image.channels.front().values.size();
  bitmap.rgb.resize(3 * pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = image.channels[names.size() == 1 ? 0 : c].values[pixel];
      if (!(value >= 0 && std::isfinite(value))) {
        const auto width = static_cast<std::size_t>(image.width);
        fail(ExitCode::kBadInput, "{}: pixel ({}, {}) is {}, allowed: finite numbers from 0", path.string(),
             pixel % width, pixel / width, value);
      }
      bitmap.rgb[3 * pixel + c] = value;
    }
  }
  return bitmap;
}

struct Signature {
  std::string_view bytes, name;
};

constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n", kExr = "\x76\x2f\x31\x01";
constexpr std::array<Signature, 8> kOthers = {{{"\xff\xd8\xff", "a JPEG"},
                                               {"BM", "a BMP"},
                                               {"#?", "a Radiance RGBE"},
                                               {"PF", "a PFM"},
                                               {"Pf", "a PFM"},
                                               {"GIF8", "a GIF"},
                                               {"II*", "a TIFF"},
                                               {"MM", "a TIFF"}}};

}  // namespace

Bitmap read_bitmap(const std::filesystem::path& path, bool raw) {
  const std::string bytes = read_file(path);
  if (bytes.starts_with(kPng)) return read_png(path.string(), bytes, raw);
  if (bytes.starts_with(kExr)) return read_open_exr(path);
  std::string found = "no image of a kind that is known";
  for (const Signature& other : kOthers) {
    if (bytes.starts_with(other.bytes)) found = std::string(other.name) + " image";
  }
  fail(ExitCode::kBadInput, "{}: is {}, allowed: PNG and OpenEXR", path.string(), found);
}

}  // namespace halfslope
