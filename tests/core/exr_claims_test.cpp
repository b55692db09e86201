#include "core/exr_claims.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/exr.h"

namespace halfslope {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ExrClaimsTest : public testing::Test {
 protected:
  ExrClaimsTest() {
    std::string pattern = (fs::temp_directory_path() / "halfslope-exr-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~ExrClaimsTest() override { fs::remove_all(folder_); }

  std::string file() const { return (folder_ / "a.exr").string(); }
  /// All values equal: what compresses best.
  void write_constant(Imf::Header header, Imf::PixelType type, float value) const {
    const auto& window = header.dataWindow();
    const auto pixels = static_cast<std::size_t>(window.max.x + 1) * static_cast<std::size_t>(window.max.y + 1);
    const std::vector<half> halves(pixels, half(value));
    const std::vector<float> floats(pixels, value);
    const std::vector<unsigned> whole(pixels, static_cast<unsigned>(value));
    Imf::FrameBuffer buffer;
    for (const char* name : {"R", "G", "B", "A", "id"}) {
      header.channels().insert(name, Imf::Channel(type));
      const void* values = type == Imf::HALF    ? static_cast<const void*>(halves.data())
                           : type == Imf::FLOAT ? static_cast<const void*>(floats.data())
                                                : static_cast<const void*>(whole.data());
      buffer.insert(name, Imf::Slice::Make(type, values, window));
    }
    if (header.hasTileDescription()) {
      Imf::TiledOutputFile out(file().c_str(), header);
      out.setFrameBuffer(buffer);
      out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
    } else {
      Imf::OutputFile out(file().c_str(), header);
      out.setFrameBuffer(buffer);
      out.writePixels(window.max.y + 1);
    }
  }
  std::string refusal() const {
    try {
      read_exr(file());
    } catch (const Error& error) {
      return error.code() == ExitCode::kBadInput ? error.what() : "another code";
    }
    return "was read";
  }

  fs::path folder_;
};

TEST_F(ExrClaimsTest, NoFinishedFileIsRefusedHoweverWellItIsCompressed) {
  double best = 0;
  for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression) {
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
      for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 700), std::pair(5000, 1), std::pair(600, 64)}) {
        for (const bool tiled : {false, true}) {
          Imf::Header header(width, height);
          header.compression() = static_cast<Imf::Compression>(compression);
          if (tiled) header.setTileDescription(Imf::TileDescription(256, 256));
          write_constant(header, type, compression % 2 == 0 ? 0.f : 1.f);
          best = std::max(
              best, width * height * 5 * (type == Imf::HALF ? 2.0 : 4.0) / static_cast<double>(fs::file_size(file())));
          EXPECT_EQ(refusal(), "was read") << compression << " " << type << " " << width << " x " << height;
        }
      }
    }
  }
  EXPECT_GT(best, 200);  // so the cases are hard ones
}

TEST_F(ExrClaimsTest, AHeaderThatClaimsMoreThanTheFileCanHoldIsRefused) {
  const std::string name = std::string("dataWindow\0box2i\0", 17);
  for (int compression = 0; compression < Imf::DWAA_COMPRESSION; ++compression) {
    Imf::Header header(16, 16);
    header.compression() = static_cast<Imf::Compression>(compression);
    write_constant(header, Imf::HALF, 1);
    const std::string bytes = read_file(file());
    for (const auto& [right, bottom] : {std::pair(9999, 1023), std::pair(1023, 9999), std::pair(0, 9999999)}) {
      std::string changed = bytes;
      const std::int32_t window[] = {0, 0, right, bottom};
      std::memcpy(changed.data() + changed.find(name) + name.size() + 4, window, sizeof window);
      write_file_atomically(file(), changed);
      EXPECT_THAT(refusal(), HasSubstr("bytes cannot hold")) << compression << " " << right << " " << bottom;
    }
  }
}

TEST_F(ExrClaimsTest, ATileMayBeLargerThanTheImageButNotTakeAllMemory) {
  Imf::Header header(16, 16);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.setTileDescription(Imf::TileDescription(16, 16));
  write_constant(header, Imf::FLOAT, 1);
  const std::string name = std::string("tiles\0tiledesc\0", 15);
  std::string bytes = read_file(file());
  for (const std::uint32_t size : {1024u, 5000u}) {
    const std::uint32_t tile[] = {size, size};
    std::memcpy(bytes.data() + bytes.find(name) + name.size() + 4, tile, sizeof tile);
    write_file_atomically(file(), bytes);
    EXPECT_THAT(refusal(), HasSubstr(size == 1024 ? "was read" : "bytes cannot hold"));
  }
}

TEST_F(ExrClaimsTest, AnAttributeThatClaimsMoreThanTheFileIsRefused) {
  Imf::Header header(4, 4);
  write_constant(header, Imf::FLOAT, 1);
  const std::string name = std::string("channels\0chlist\0", 16);
  for (const std::uint32_t size : {0x7fffffffu, 0xffffffffu, 100000u}) {
    std::string bytes = read_file(file());
    std::memcpy(bytes.data() + bytes.find(name) + name.size(), &size, sizeof size);
    write_file_atomically(file(), bytes);
    EXPECT_THAT(refusal(), HasSubstr("claims an attribute of"));
  }
}

}  // namespace
}  // namespace halfslope
