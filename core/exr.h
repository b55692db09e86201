// Images of numbers: OpenEXR files of named binary32 channels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halfslope {

/// An image of width × height pixels. A channel "layer.R" belongs to a layer, "R" to none.
struct ExrImage {
  struct Channel {
    std::string name;
    std::vector<float> values;  ///< width · height, row by row from the top-left pixel
  };
  int width = 0, height = 0;
  std::vector<Channel> channels;
};

/// Writes the image atomically (core/atomic_file.h) as one scan-line part, FLOAT channels, ZIP compression. The bytes
/// depend on the image alone (and on the OpenEXR and zlib installed): no date, no host, no thread count. The file keeps
/// channels in alphabetical order. Names must be distinct and of 1 to 255 letters, the image not empty.
/// Throws Error(kIo) if it cannot be written.
void write_exr(const std::filesystem::path& path, const ExrImage& image);

/// A file opened for reading: what it says of its image, and any of its channels.
///
/// Single-part scan-line or tiled images are read, all of their data window. HALF and UINT become float (UINT is
/// rounded to nearest above 2²⁴); infinities, NaNs and subnormals are kept. No more is allocated than the file and the
/// channels asked for: a header that claims more than a file of its size can hold is refused before
/// (core/exr_claims.h).
class ExrFile {
 public:
  struct Channel {
    std::string name;
    bool half;  ///< HALF: 11 bits of precision, infinite above 65504
  };

  /// Throws Error(kBadInput) with the path and the reason if the file is missing, is not OpenEXR, is broken or was
  /// never finished by its writer, has several parts or deep pixels, or more than 2²⁸ values. Throws Error(kIo) if the
  /// file cannot be read.
  explicit ExrFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  int width() const { return width_; }    ///< of the data window
  int height() const { return height_; }  ///< of the data window
  /// The data window's first pixel, counted from the display window's: 0, 0 unless the image was cropped or has a
  /// border.
  std::int64_t x() const { return x_; }
  std::int64_t y() const { return y_; }
  std::int64_t display_width() const { return display_width_; }
  std::int64_t display_height() const { return display_height_; }
  const std::vector<Channel>& channels() const { return channels_; }  ///< in alphabetical order
  const Channel* find(std::string_view name) const;                   ///< null if there is none

  /// The channels of these names, in their order; each must be there. Throws Error(kBadInput) with the path and the
  /// reason if the pixels are broken, the writer did not finish, or a channel is subsampled.
  ExrImage read(std::span<const std::string> names) const;

 private:
  std::filesystem::path path_;
  std::string bytes_;
  int width_ = 0, height_ = 0;
  std::int64_t x_ = 0, y_ = 0, display_width_ = 0, display_height_ = 0;
  std::vector<Channel> channels_;
};

/// All channels of a file, as ExrFile reads them.
ExrImage read_exr(const std::filesystem::path& path);

}  // namespace halfslope
