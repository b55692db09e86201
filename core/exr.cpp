#include "core/exr.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/assertion.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/exr_claims.h"

namespace halfslope {
namespace {

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
  check_attribute_sizes(bytes);
  MemoryReader stream(bytes);
  stream.seekg(8);
  Imf::Header header;
  header.readFrom(stream, version);
  header.sanityCheck(Imf::isTiled(version));
  return header;
}

[[noreturn]] void fail_to_read(const std::filesystem::path& path, const std::exception& error) {
  fail(ExitCode::kBadInput, "{}: cannot be read as an image: {}", path.string(), error.what());
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

ExrFile::ExrFile(std::filesystem::path path) : path_(std::move(path)), bytes_(read_file(path_)) {
  try {
    const Imf::Header header = read_header(bytes_);
    check_claims(header, bytes_.size());
    const auto &window = header.dataWindow(), &display = header.displayWindow();
    width_ = window.max.x - window.min.x + 1;
    height_ = window.max.y - window.min.y + 1;
    x_ = std::int64_t{window.min.x} - display.min.x;
    y_ = std::int64_t{window.min.y} - display.min.y;
    display_width_ = std::int64_t{display.max.x} - display.min.x + 1;
    display_height_ = std::int64_t{display.max.y} - display.min.y + 1;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
      channels_.push_back({channel.name(), channel.channel().type == Imf::HALF});
  } catch (const std::exception& error) {
    fail_to_read(path_, error);
  }
}

const ExrFile::Channel* ExrFile::find(std::string_view name) const {
  const auto found = std::ranges::find(channels_, name, &Channel::name);
  return found == channels_.end() ? nullptr : &*found;
}

ExrImage ExrFile::read(std::span<const std::string> names) const {
  try {
    MemoryReader stream(bytes_);
    Imf::InputFile file(stream, kNoThreads);
    if (!file.isComplete()) throw Iex::InputExc("it is incomplete: its writer did not finish");
    const auto& window = file.header().dataWindow();
    const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    ExrImage image{width_, height_, {}};
    for (const std::string& name : names) {
      const Imf::Channel* channel = file.header().channels().findChannel(name);
      assert_equal(channel != nullptr, true, "a channel that the file has");
      if (channel->xSampling != 1 || channel->ySampling != 1)
        throw Iex::InputExc(fmt::format("its channel '{}' is subsampled; one value a pixel is allowed", name));
      image.channels.push_back({name, std::vector<float>(pixels)});
    }
    Imf::FrameBuffer buffer;
    for (ExrImage::Channel& channel : image.channels)
      buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return image;
  } catch (const std::exception& error) {
    fail_to_read(path_, error);
  }
}

ExrImage read_exr(const std::filesystem::path& path) {
  const ExrFile file(path);
  std::vector<std::string> names;
  for (const ExrFile::Channel& channel : file.channels()) names.push_back(channel.name);
  return file.read(names);
}

}  // namespace halfslope
