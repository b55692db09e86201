#include "core/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "core/atomic_file.h"
#include "core/error.h"

namespace halfslope {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ExrTest : public testing::Test {
 protected:
  ExrTest() {
    std::string pattern = (fs::temp_directory_path() / "halfslope-exr-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~ExrTest() override { fs::remove_all(folder_); }
  fs::path folder_;
};

ExrImage noise_image(int width, int height, const std::vector<std::string>& names) {
  std::mt19937 random(7);
  ExrImage image{width, height, {}};
  for (const std::string& name : names) {
    std::vector<float> values(static_cast<std::size_t>(width * height));
    for (float& value : values)
      value = std::ldexp(static_cast<float>(random()), static_cast<int>(random() % 200) - 130);
    image.channels.push_back({name, values});
  }
  return image;
}

/// The message of the Error(kBadInput) that reading throws, or what happened instead.
std::string refusal(const fs::path& path) {
  try {
    read_exr(path);
  } catch (const Error& error) {
    return error.code() == ExitCode::kBadInput ? error.what() : "another code";
  }
  return "was read";
}

TEST_F(ExrTest, FloatsComeBackBitForBit) {
  ExrImage image = noise_image(33, 19, {"B", "G", "R", "bias.B", "mse.G", "variance.R"});
  const float special[] = {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), -0.0f,
                           1e-45f};
  std::copy(std::begin(special), std::end(special), image.channels[2].values.begin());
  image.channels[2].values[5] = std::numeric_limits<float>::quiet_NaN();
  write_exr(folder_ / "a.exr", image);
  const ExrImage back = read_exr(folder_ / "a.exr");
  EXPECT_EQ(back.width, 33);
  EXPECT_EQ(back.height, 19);
  ASSERT_EQ(back.channels.size(), image.channels.size());
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    EXPECT_EQ(back.channels[c].name, image.channels[c].name);
    ASSERT_EQ(back.channels[c].values.size(), image.channels[c].values.size());
    for (std::size_t i = 0; i < back.channels[c].values.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(back.channels[c].values[i]),
                std::bit_cast<std::uint32_t>(image.channels[c].values[i]));
    }
  }
}

TEST_F(ExrTest, TheFileIsWhatItSaysToOpenExrItself) {
  const ExrImage image = noise_image(3, 2, {"R", "variance.R"});
  write_exr(folder_ / "a.exr", image);
  Imf::InputFile file((folder_ / "a.exr").c_str());
  EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
  ASSERT_NE(file.header().channels().findChannel("variance.R"), nullptr);
  EXPECT_EQ(file.header().channels().findChannel("variance.R")->type, Imf::FLOAT);
  std::set<std::string> layers;
  file.header().channels().layers(layers);
  EXPECT_THAT(layers, testing::ElementsAre("variance"));
  // The first value is the top-left pixel's.
  std::vector<float> values(6);
  Imf::FrameBuffer buffer;
  buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, values.data(), file.header().dataWindow()));
  file.setFrameBuffer(buffer);
  file.readPixels(0, 0);
  EXPECT_EQ(values[0], image.channels[0].values[0]);
  EXPECT_EQ(values[2], image.channels[0].values[2]);
  EXPECT_EQ(values[3], 0.0f);
}

TEST_F(ExrTest, TheSameImageIsTheSameBytes) {
  ExrImage image = noise_image(40, 30, {"R", "G", "B"});
  write_exr(folder_ / "a.exr", image);
  std::swap(image.channels[0], image.channels[2]);  // order is no content
  write_exr(folder_ / "b.exr", image);
  const std::string bytes = read_file(folder_ / "a.exr");
  EXPECT_EQ(bytes, read_file(folder_ / "b.exr"));
  EXPECT_EQ(bytes.find("capDate"), std::string::npos);
}

TEST_F(ExrTest, HalfAndUnsignedChannelsBecomeFloat) {
  const std::vector<half> halves = {half(1.5f), half(-0.0009765625f), half(65504.f), half::posInf()};
  const std::vector<unsigned> ids = {0, 1, 16777216, 4294967295u};
  Imf::Header header(2, 2);
  header.channels().insert("Y", Imf::Channel(Imf::HALF));
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  {
    Imf::OutputFile file((folder_ / "h.exr").c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::HALF, halves.data(), header.dataWindow()));
    buffer.insert("id", Imf::Slice::Make(Imf::UINT, ids.data(), header.dataWindow()));
    file.setFrameBuffer(buffer);
    file.writePixels(2);
  }
  const ExrImage image = read_exr(folder_ / "h.exr");
  ASSERT_EQ(image.channels.size(), 2u);
  EXPECT_THAT(image.channels[0].values,
              testing::ElementsAre(1.5f, -0.0009765625f, 65504.f, std::numeric_limits<float>::infinity()));
  EXPECT_THAT(image.channels[1].values, testing::ElementsAre(0.f, 1.f, 16777216.f, 4294967296.f));
}

TEST_F(ExrTest, TiledImagesAndShiftedDataWindowsAreRead) {
  const Imath::Box2i window({-5, 1000000}, {1, 1000002});
  std::vector<float> values(21);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  Imf::Header header(window, window);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.setTileDescription(Imf::TileDescription(4, 2));
  {
    Imf::TiledOutputFile file((folder_ / "t.exr").c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), window));
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  const ExrImage image = read_exr(folder_ / "t.exr");
  EXPECT_EQ(image.width, 7);
  EXPECT_EQ(image.height, 3);
  EXPECT_EQ(image.channels.at(0).values, values);
}

TEST_F(ExrTest, SubsampledChannelsAreRefused) {
  const std::vector<float> full(16, 1.f), quarter(4, 1.f);
  Imf::Header header(4, 4);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.channels().insert("RY", Imf::Channel(Imf::FLOAT, 2, 2));
  {
    Imf::OutputFile file((folder_ / "s.exr").c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, full.data(), header.dataWindow()));
    buffer.insert("RY", Imf::Slice::Make(Imf::FLOAT, quarter.data(), header.dataWindow(), 0, 0, 2, 2));
    file.setFrameBuffer(buffer);
    file.writePixels(4);
  }
  EXPECT_THAT(refusal(folder_ / "s.exr"), testing::AllOf(HasSubstr("s.exr"), HasSubstr("'RY' is subsampled")));
}

TEST_F(ExrTest, ClaimsOfAbsurdSizeAreRefusedBeforeAllocation) {
  write_exr(folder_ / "a.exr", noise_image(4, 4, {"Y"}));
  const std::string bytes = read_file(folder_ / "a.exr");
  const std::string name = std::string("dataWindow\0box2i\0", 17);
  const std::size_t at = bytes.find(name) + name.size() + 4;
  const auto claim = [&](std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
    std::string changed = bytes;
    const std::int32_t window[] = {x0, y0, x1, y1};
    std::memcpy(changed.data() + at, window, sizeof window);
    write_file_atomically(folder_ / "claim.exr", changed);
    return refusal(folder_ / "claim.exr");
  };
  constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max(),
                         kMin = std::numeric_limits<std::int32_t>::min();
  for (const std::string& message : {claim(0, 0, 99999, 99999), claim(0, 0, 0, 2000000000), claim(0, 0, 2000000000, 0),
                                     claim(kMin, kMin, kMax, kMax), claim(0, 0, 16384, 16384), claim(3, 3, 2, 2)}) {
    EXPECT_THAT(message, HasSubstr("cannot be read as an image"));
  }
  EXPECT_THAT(claim(0, 0, 16384, 16384), HasSubstr("at most 2^28"));
}

TEST_F(ExrTest, ChannelsAreReadByNameInTheOrderAskedFor) {
  const ExrImage image = noise_image(6, 5, {"B", "G", "R", "variance.R"});
  write_exr(folder_ / "a.exr", image);
  const ExrFile file(folder_ / "a.exr");
  EXPECT_EQ(file.find("Z"), nullptr);
  ASSERT_NE(file.find("variance.R"), nullptr);
  EXPECT_FALSE(file.find("R")->half);
  const std::vector<std::string> names = {"R", "B"};
  const ExrImage some = file.read(names);
  ASSERT_EQ(some.channels.size(), 2u);
  EXPECT_EQ(some.channels[0].values, image.channels[2].values);
  EXPECT_EQ(some.channels[1].values, image.channels[0].values);
}

TEST_F(ExrTest, TheDataWindowIsPlacedInTheDisplayWindow) {
  const Imath::Box2i display({-10, 20}, {89, 79}), data({-5, 18}, {4, 30});
  const std::vector<half> values(10 * 13, half(1.f));
  Imf::Header header(display, data);
  header.channels().insert("Y", Imf::Channel(Imf::HALF));
  {
    Imf::OutputFile file((folder_ / "w.exr").c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::HALF, values.data(), data));
    file.setFrameBuffer(buffer);
    file.writePixels(13);
  }
  const ExrFile file(folder_ / "w.exr");
  EXPECT_EQ(file.width(), 10);
  EXPECT_EQ(file.height(), 13);
  EXPECT_EQ(file.x(), 5);
  EXPECT_EQ(file.y(), -2);
  EXPECT_EQ(file.display_width(), 100);
  EXPECT_EQ(file.display_height(), 60);
  EXPECT_TRUE(file.channels().at(0).half);
}

TEST_F(ExrTest, NoPrefixOfAFileIsRead) {
  write_exr(folder_ / "a.exr", noise_image(20, 40, {"R", "G"}));
  const std::string bytes = read_file(folder_ / "a.exr");
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 40) {
    write_file_atomically(folder_ / "cut.exr", std::string_view(bytes).substr(0, size));
    EXPECT_THAT(refusal(folder_ / "cut.exr"), HasSubstr("cannot be read as an image")) << size;
  }
}

TEST_F(ExrTest, AFlippedByteNeverCrashes) {
  write_exr(folder_ / "a.exr", noise_image(5, 20, {"R", "G"}));
  const std::string bytes = read_file(folder_ / "a.exr");
  int refused = 0;
  for (std::size_t at = 0; at < 480; ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x81);
    std::ofstream(folder_ / "flip.exr", std::ios::binary | std::ios::trunc) << changed;
    refused += refusal(folder_ / "flip.exr") != "was read";
  }
  EXPECT_GT(refused, 100);  // magic, version, names, types and sizes alone
}

TEST_F(ExrTest, HostileFilesAreRefusedAndOddOnesRead) {
  const fs::path hostile = fs::path(HALFSLOPE_SOURCE_DIR) / "tests/data/hostile_exr";
  const std::map<std::string, std::string> reasons = {{"01_empty", "not an OpenEXR file"},
                                                      {"02_magic_only", "not an OpenEXR file"},
                                                      {"03_trunc_header", "ends too early"},
                                                      {"05_trunc_pixels", "cannot be read"},
                                                      {"06_offsets_zero_killed_writer", "incomplete"},
                                                      {"07_dw_intmax", "cannot be read"},
                                                      {"08_dw_100k_square_400B", "2^28"},
                                                      {"10_dw_1x2e9", "cannot be read"},
                                                      {"13_attr_size_negative", "cannot be read"},
                                                      {"14_bad_compression", "cannot be read"},
                                                      {"23_png_renamed", "not an OpenEXR file"}};
  int read = 0;
  for (const auto& entry : fs::directory_iterator(hostile)) {
    const std::string name = entry.path().stem().string();
    const std::string message = refusal(entry.path());
    if (const auto reason = reasons.find(name); reason != reasons.end()) {
      EXPECT_THAT(message, HasSubstr(reason->second)) << name;
    } else {
      read += message == "was read";
    }
  }
  EXPECT_GE(read, 5);
  EXPECT_EQ(read_exr(hostile / "19_wrong_size_5x4.exr").width, 5);
  EXPECT_TRUE(std::ranges::any_of(read_exr(hostile / "15_nan_pixels.exr").channels.at(0).values,
                                  [](float value) { return std::isnan(value); }));
}

TEST_F(ExrTest, AMissingFileIsBadInputAndAnUnwritableFolderIo) {
  EXPECT_THAT(refusal(folder_ / "none.exr"), HasSubstr("none.exr"));
  try {
    write_exr(folder_ / "none" / "a.exr", noise_image(1, 1, {"Y"}));
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kIo);
  }
}

}  // namespace
}  // namespace halfslope
