#include "core/exr.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/assertion.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace halfslope {
namespace {

constexpr std::int64_t kMaxValues = std::int64_t{1} << 28;
constexpr int kNoThreads = 0;  // OpenEXR's own pool: we are parallel above it

class MemoryWriter : public Imf::OStream {
 public:
  MemoryWriter() : OStream("memory") {}
  void write(const char source[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, source, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

class MemoryReader : public Imf::IStream {
 public:
  explicit MemoryReader(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char target[], int count) override {
    const auto size = static_cast<std::size_t>(std::max(count, 0));
    if (position_ > bytes_.size() || size > bytes_.size() - position_) throw Iex::InputExc("the file ends too early");
    std::memcpy(target, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
};

/// Little-endian 32-bit word at `offset`, as OpenEXR writes them.
int word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  return static_cast<int>(word);
}

/// The header alone. Imf::InputFile's constructor already allocates by the height that a header claims, so what it
/// claims is judged before one is made.
Imf::Header read_header(std::string_view bytes) {
  if (bytes.size() < 8 || word_at(bytes, 0) != Imf::MAGIC) throw Iex::InputExc("it is not an OpenEXR file");
  int version = word_at(bytes, 4);
  if (Imf::getVersion(version) != Imf::EXR_VERSION || !Imf::supportsFlags(Imf::getFlags(version))) {
    throw Iex::InputExc("its OpenEXR version is unknown");
  }
  if (Imf::isMultiPart(version)) throw Iex::InputExc("it has several parts; one is allowed");
  if (Imf::isNonImage(version)) throw Iex::InputExc("it has deep pixels; flat ones are allowed");
  MemoryReader stream(bytes);
  stream.seekg(8);
  Imf::Header header;
  header.readFrom(stream, version);
  header.sanityCheck(Imf::isTiled(version));
  return header;
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

ExrImage decode(std::string_view bytes) {
  const Imf::Header header = read_header(bytes);
  const auto& window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  std::int64_t channels = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) ++channels;
  check_size(width, height, channels, "data window");
  if (header.hasTileDescription()) {
    check_size(header.tileDescription().xSize, header.tileDescription().ySize, channels, "tile");
  }

  ExrImage image{static_cast<int>(width), static_cast<int>(height), {}};
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
      throw Iex::InputExc(fmt::format("its channel '{}' is subsampled; one value a pixel is allowed", channel.name()));
    }
    image.channels.push_back({channel.name(), std::vector<float>(static_cast<std::size_t>(width * height))});
  }

  MemoryReader stream(bytes);
  Imf::InputFile file(stream, kNoThreads);
  if (!file.isComplete()) throw Iex::InputExc("it is incomplete: its writer did not finish");
  Imf::FrameBuffer buffer;
  for (ExrImage::Channel& channel : image.channels) {
    buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const ExrImage& image) {
  assert_equal(image.width > 0 && image.height > 0, true, "an image that is not empty");
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  for (const ExrImage::Channel& channel : image.channels) {
    const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    assert_equal(channel.values.size(), pixels, "values of an image's channel");
    assert_equal(header.channels().findChannel(channel.name) == nullptr, true, "channel names that are distinct");
    header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
    // OpenEXR takes a mutable pointer for reading and writing alike; writing only reads through it.
    buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), header.dataWindow()));
  }
  MemoryWriter stream;
  try {
    Imf::OutputFile file(stream, header, kNoThreads);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  } catch (const std::exception& error) {
    fail(ExitCode::kIo, "{}: cannot be encoded: {}", path.string(), error.what());
  }
  write_file_atomically(path, stream.bytes());
}

ExrImage read_exr(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  try {
    return decode(bytes);
  } catch (const std::exception& error) {
    fail(ExitCode::kBadInput, "{}: cannot be read as an image: {}", path.string(), error.what());
  }
}

}  // namespace halfslope
