#include "core/exr_claims.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfTileDescription.h>
#include <fmt/format.h>

#include <algorithm>

namespace halfslope {
namespace {

constexpr std::int64_t kMaxValues = std::int64_t{1} << 28;
constexpr std::uint64_t kFreeChunkBytes = std::uint64_t{64} << 20;
constexpr std::uint64_t kScanLineChunkBytes = 8 + 8;  // offset; y and size
constexpr std::uint64_t kTileChunkBytes = 8 + 20;     // offset; tile, level and size

/// Scan lines of a chunk, and a bound of the bytes that one byte of data becomes.
struct CompressionLimits {
  std::uint64_t lines, ratio;
};

CompressionLimits limits_of(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
      return {1, 1};
    case Imf::RLE_COMPRESSION:
      return {1, 64};  // two bytes for a run of 128
    case Imf::ZIPS_COMPRESSION:
      return {1, 1032};
    case Imf::ZIP_COMPRESSION:
      return {16, 1032};
    case Imf::PIZ_COMPRESSION:
      return {32, 512};  // ten bits for a run of 256 two-byte words
    case Imf::PXR24_COMPRESSION:
      return {16, 1376};  // deflate of three bytes of four
    case Imf::B44_COMPRESSION:
      return {32, 3};  // 14 bytes for 16 halves
    case Imf::B44A_COMPRESSION:
      return {32, 11};  // 3 bytes for 16 equal halves
    case Imf::DWAA_COMPRESSION:
      return {32, 66048};  // deflated run lengths, 64 · 1032
    case Imf::DWAB_COMPRESSION:
      return {256, 66048};
    default:
      throw Iex::InputExc("its compression is unknown");
  }
}

std::uint64_t chunks_across(std::int64_t pixels, std::uint64_t chunk) {
  return (static_cast<std::uint64_t>(pixels) + chunk - 1) / chunk;
}

void check_size(std::int64_t width, std::int64_t height, std::int64_t channels, const char* what) {
  // Divisions, since the product of what a header claims may not fit in 64 bits.
  if (width < 1 || height < 1 || channels < 1 || width > kMaxValues / channels ||
      height > kMaxValues / channels / width) {
    throw Iex::InputExc(
        fmt::format("its {} is {} x {} with {} channels; at least one value and at most 2^28 are allowed", what, width,
                    height, channels));
  }
}

}  // namespace

// A header is a list of attributes, each a name and a type that end with a zero byte, a 4-byte size, and so many bytes;
// an empty name ends it.
void check_attribute_sizes(std::string_view bytes) {
  std::size_t at = 8;
  while (true) {
    for (int text = 0; text < 2; ++text) {
      const std::size_t end = bytes.find('\0', at);
      if (end == std::string_view::npos) throw Iex::InputExc("the file ends too early, in its header");
      if (text == 0 && end == at) return;
      at = end + 1;
    }
    if (bytes.size() - at < 4) throw Iex::InputExc("the file ends too early, in its header");
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < 4; ++i)
      size |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    at += 4;
    if (size > bytes.size() - at) {
      throw Iex::InputExc(fmt::format("its header claims an attribute of {} bytes where {} are left",
                                      static_cast<std::int32_t>(size), bytes.size() - at));
    }
    at += size;
  }
}

void check_claims(const Imf::Header& header, std::uint64_t file_bytes) {
  const auto& window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  std::int64_t channels = 0;
  std::uint64_t pixel_bytes = 0, data_bytes = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    ++channels;
    pixel_bytes += channel.channel().type == Imf::HALF ? 2 : 4;
  }
  check_size(width, height, channels, "data window");
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    const Imf::Channel& c = channel.channel();
    data_bytes += static_cast<std::uint64_t>(width / std::max(c.xSampling, 1) * (height / std::max(c.ySampling, 1))) *
                  (c.type == Imf::HALF ? 2 : 4);
  }
  const CompressionLimits limits = limits_of(header.compression());
  std::uint64_t least = data_bytes / limits.ratio, chunk_bytes = 0;
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tile = header.tileDescription();
    check_size(tile.xSize, tile.ySize, channels, "tile");
    least += chunks_across(width, tile.xSize) * chunks_across(height, tile.ySize) * kTileChunkBytes;
    // A row of tiles is decoded at once.
    chunk_bytes = std::max<std::uint64_t>(tile.xSize, static_cast<std::uint64_t>(width)) * tile.ySize * pixel_bytes;
  } else {
    least += chunks_across(height, limits.lines) * kScanLineChunkBytes;
    chunk_bytes = static_cast<std::uint64_t>(width) * limits.lines * pixel_bytes;
  }
  if (least > file_bytes || (chunk_bytes > kFreeChunkBytes && chunk_bytes / limits.ratio > file_bytes)) {
    throw Iex::InputExc(fmt::format("its header claims {} x {} pixels with {} channels, which {} bytes cannot hold",
                                    width, height, channels, file_bytes));
  }
}

}  // namespace halfslope
