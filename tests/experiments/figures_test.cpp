// veach, points and glossy, and how `figure` is called.
#include <gmock/gmock.h>
#include <png.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "analysis/tone_map.h"
#include "core/atomic_file.h"
#include "core/exr.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/csv_table.h"
#include "tests/experiments/svg_reading.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Figures : public CommandLine {
 protected:
  std::string path(const char* name) const { return (folder_ / name).string(); }
  pugi::xml_document draw(const std::vector<std::string>& arguments) const {
    const Ended ended =
        command(std::vector<std::string>{"figure"} + arguments + std::vector<std::string>{"--out", path("f.svg")});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, IsEmpty());
    pugi::xml_document document;
    EXPECT_TRUE(document.load_file(path("f.svg").c_str()));
    return document;
  }
};

RgbImage decoded(const std::string& bytes) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()), 0) << png.message;
  png.format = PNG_FORMAT_RGB;
  RgbImage pixels(static_cast<int>(png.width), static_cast<int>(png.height));
  EXPECT_NE(png_image_finish_read(&png, nullptr, pixels.values.data(), 0, nullptr), 0) << png.message;
  return pixels;
}

RgbImage embedded(const pugi::xml_node& image) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::string href = image.attribute("xlink:href").value();
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t k = href.find(',') + 1; k < href.size() && href[k] != '='; ++k) {
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(href[k]));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return decoded(bytes);
}

// Its panels are the pictures that `render` writes, tone-mapped.
TEST_F(Figures, VeachShowsWhatRenderRenders) {
  const std::vector<std::string> size = {"--resolution", "36,24", "--samples", "8", "--seed", "5", "--replicate", "2"};
  const auto document = draw(std::vector<std::string>{"veach", "--exposure", "-1.5"} + size);
  const auto images = document.select_nodes("//image");
  ASSERT_EQ(images.size(), 3u);
  std::size_t k = 0;
  for (const char* estimator : {"light", "bsdf", "power"}) {
    ASSERT_EQ(command(std::vector<std::string>{"render", "--scene", "veach-mis", "--estimator", estimator, "--sampler",
                                               "independent", "-o", path("p.exr")} +
                      size)
                  .code,
              0);
    const ExrImage exr = read_exr(path("p.exr"));
    const RgbImage panel = embedded(images[k++].node());
    ASSERT_EQ(panel.width, 36);
    ASSERT_EQ(panel.height, 24);
    for (std::size_t p = 0; p < 36 * 24; ++p) {
      for (std::size_t c = 0; c < 3; ++c) {
        // Channels are in alphabetical order in the file. Binary32 there may round to the neighbouring byte.
        EXPECT_NEAR(panel.values[3 * p + c], tone_mapped(exr.channels[2 - c].values[p], -1.5), 1);
      }
    }
  }
  EXPECT_THAT(texts(document),
              AllOf(Contains("α = 0.005"), Contains("α = 0.1"), Contains("light radius"), Contains("0.9"),
                    Contains(HasSubstr("(c) power")), Contains(HasSubstr("N = 8 samples a pixel (independent points)")),
                    Contains(HasSubstr("exposure −1.5 stops"))));
}

TEST_F(Figures, RenderWritesAPngThatIsTheToneMappedExr) {
  const std::vector<std::string> words = {"render",       "--scene", "environment-mesh", "--estimator",
                                          "path-power",   "--quiet", "--samples",        "4",
                                          "--resolution", "24,18"};
  ASSERT_EQ(command(words + std::vector<std::string>{"-o", path("p.exr")}).code, 0);
  ASSERT_EQ(command(words + std::vector<std::string>{"-o", path("p.png"), "--exposure", "-2"}).code, 0);
  const ExrImage exr = read_exr(path("p.exr"));
  std::ifstream file(path("p.png"), std::ios::binary);
  const RgbImage pixels = decoded(std::string(std::istreambuf_iterator<char>(file), {}));
  ASSERT_EQ(pixels.width, 24);
  for (std::size_t p = 0; p < 24 * 18; ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(pixels.values[3 * p + c], tone_mapped(exr.channels[2 - c].values[p], -2), 1);
    }
  }
  const Ended ended = command(words + std::vector<std::string>{"-o", path("p.jpg")});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("allowed: a name that ends in .exr or .png"));
}

TEST_F(Figures, GlossyMagnifiesTheSamePartOfEach) {
  const auto document = draw({"glossy", "--scene", "veach-mis", "--resolution", "48,32", "--samples", "4",
                              "--estimators", "light", "--samplers", "independent,stratified"});
  const auto images = document.select_nodes("//image");
  ASSERT_EQ(images.size(), 4u);
  const RgbImage whole[] = {embedded(images[0].node()), embedded(images[2].node())};
  const RgbImage part[] = {embedded(images[1].node()), embedded(images[3].node())};
  EXPECT_NE(whole[0].values, whole[1].values);
  ASSERT_EQ(part[0].width, 12);
  ASSERT_EQ(part[0].height, 8);
  const auto is_part_at = [](const RgbImage& image, const RgbImage& piece, int x0, int y0) {
    for (int y = 0; y < piece.height; ++y) {
      for (int x = 0; x < piece.width; ++x) {
        if (!std::equal(piece.pixel(x, y), piece.pixel(x, y) + 3, image.pixel(x0 + x, y0 + y))) return false;
      }
    }
    return true;
  };
  int places = 0;
  for (int y = 0; y + 8 <= 32; ++y) {
    for (int x = 0; x + 12 <= 48; ++x)
      places += is_part_at(whole[0], part[0], x, y) && is_part_at(whole[1], part[1], x, y);
  }
  EXPECT_EQ(places, 1);
  EXPECT_THAT(texts(document), AllOf(Contains("(a) independent"), Contains("(b) stratified")));
}

TEST_F(Figures, PointsAreTheSamplersOwn) {
  const auto document =
      draw({"points", "--samplers", "halton-owen,stratified,n-rooks", "--samples", "25", "--seed", "3"});
  const auto groups = document.select_nodes("//g");
  ASSERT_EQ(groups.size(), 3u);
  for (const auto& group : groups) {
    const std::string sampler = group.node().child_value("title");
    const CsvTable points(command({"points", "--sampler", sampler, "--count", "25", "--seed", "3"}).out);
    // The frame is the one polygon; strata are lines of light grey between its edges.
    std::istringstream frame(group.node().child("polygon").attribute("points").value());
    double left, top, right, bottom, skip;
    char comma;
    frame >> left >> comma >> top >> right >> comma >> skip >> skip >> comma >> bottom;
    EXPECT_NEAR(right - left, bottom - top, 1e-3) << "a square";
    std::size_t row = 0;
    for (const auto& circle : group.node().children("circle")) {
      EXPECT_NEAR((circle.attribute("cx").as_double() - left) / (right - left), points.number(row, "x0"), 1e-5);
      EXPECT_NEAR((bottom - circle.attribute("cy").as_double()) / (bottom - top), points.number(row, "x1"), 1e-5);
      ++row;
    }
    EXPECT_EQ(row, 25u);
    int strata = 0;
    for (const auto& line : group.node().children("polyline")) {
      strata += std::string(line.attribute("stroke").value()) == "#d7d7d7";
    }
    EXPECT_EQ(strata, sampler == "stratified" ? 4 + 4 : sampler == "n-rooks" ? 24 + 24 : 0);
  }
  EXPECT_THAT(texts(document), AllOf(Contains("halton-owen"), Contains(HasSubstr("N = 25 points")), Contains("0.5")));
}

TEST_F(Figures, TheSameBytesWhateverTheThreads) {
  for (const char* name : {"f.png", "f.svg"}) {
    std::vector<std::string> bytes;
    for (const char* threads : {"1", "3"}) {
      ASSERT_EQ(command({"figure", "veach", "--resolution", "30,20", "--samples", "4", "--threads", threads, "--quiet",
                         "-o", path(name)})
                    .code,
                0);
      bytes.push_back(read_file(path(name)));
    }
    EXPECT_EQ(bytes[0], bytes[1]) << name;
  }
}

// 7 inches at 288 pixels.
TEST_F(Figures, PngHasThePagesSize) {
  ASSERT_EQ(command({"figure", "points", "--samplers", "independent", "-o", path("p.png")}).code, 0);
  const std::string bytes = read_file(path("p.png"));
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(png.width, 2016u);
  png_image_free(&png);
}

TEST_F(Figures, WrongUsageSaysWhatIsAllowed) {
  for (const auto& [arguments, message] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, "name is required"},
           {{"vaech"}, "did you mean 'veach'?"},
           {{"points", "--out", "x.jpg"}, "'x.jpg' must end in .png or .svg"},
           {{"points", "--out", "png"}, "'png' must end in .png or .svg"},
           {{"points", "--run", "out"}, "--run: the figure 'points' does not take it"},
           {{"convergence", "--run", "out", "--threads", "2"}, "--threads: the figure 'convergence' does not take it"},
           {{"points", "--samplers", "haltn-owen"}, "did you mean 'halton-owen'?"},
           {{"points", "--samplers", "independent", "--samples", "0"}, "--samples"},
           {{"points", "--samplers", "independent", "--samples", "4:16"}, "one N at a time"},
           {{"points", "--samplers", "independent", "--samples", "100000"}, "can be told apart"},
           {{"points", "--samplers", "independent", "--replicate", "-1"}, "--replicate: found '-1'"},
           {{"veach", "--samples", "7"}, "the nearest legal: 6 and 8"},
           {{"veach", "--scene", "vaech-mis"}, "did you mean 'veach-mis'?"},
           {{"veach", "--scene", "mis-toy", "--resolution", "3,3"}, "has no picture"},
           {{"veach", "--resolution", "0,3"}, "--resolution"},
           {{"veach", "--exposure", "bright"}, "--exposure: found 'bright'"},
           {{"veach", "--exposure", "nan"}, "--exposure"},
           {{"veach", "--samplers", "independent,stratified"}, "at most 4 pictures"}}) {
    std::vector<std::string> all = std::vector<std::string>{"figure"} + arguments;
    if (std::find(all.begin(), all.end(), "--out") == all.end() && all.size() > 1)
      all = all + std::vector<std::string>{"--out", path("x.png")};
    const Ended ended = command(all);
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_THAT(ended.err, AllOf(::testing::StartsWith("halfslope: "), HasSubstr(message)));
    EXPECT_THAT(ended.out, IsEmpty());
  }
  EXPECT_FALSE(std::filesystem::exists(path("x.png")));
}

TEST_F(Figures, WhatCannotBeWrittenIsToldBeforeTheWork) {
  const Ended ended = command({"figure", "veach", "--samples", "1048576", "--out", "/dev/null/x.png"});
  EXPECT_EQ(ended.code, 4);
  EXPECT_THAT(ended.err, HasSubstr("/dev/null/x.png"));
  EXPECT_LT(ended.seconds, 5);  // the pictures would take hours
  EXPECT_EQ(command({"figure", "veach", "--scene", path("none.xml"), "--out", path("x.png")}).code, 3);
}

TEST_F(Figures, AnInterruptLeavesNothingBehind) {
  Child child({"figure", "veach", "--samples", "1048576", "--out", path("x.png")}, options());
  const auto temporary = [&] {
    for (const auto& file : std::filesystem::directory_iterator(folder_.path()))
      if (file.path().extension() == ".tmp") return true;
    return false;
  };
  while (!temporary()) ASSERT_TRUE(child.running());
  child.signal(SIGINT);
  const Ended ended = child.wait();
  EXPECT_EQ(ended.code, 130) << ended.err;
  EXPECT_FALSE(temporary());
  EXPECT_FALSE(std::filesystem::exists(path("x.png")));
}

}  // namespace
}  // namespace halfslope
