// Images of numbers: OpenEXR files of named binary32 channels.
#pragma once

#include <filesystem>
#include <string>
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

/// Reads a single-part scan-line or tiled image, all of its data window, channels in alphabetical order. HALF and UINT
/// become float (UINT is rounded to nearest above 2²⁴); infinities and NaNs are kept.
///
/// Throws Error(kBadInput) with the path and the reason if the file is missing, is not OpenEXR, is broken or was never
/// finished by its writer, has subsampled channels, several parts or deep pixels, or more than 2²⁸ values; the size is
/// refused before anything is allocated for it. Throws Error(kIo) if the file cannot be read.
ExrImage read_exr(const std::filesystem::path& path);

}  // namespace halfslope
