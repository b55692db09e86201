// The SVG, read by an XML parser.
#include <gmock/gmock.h>

#include <pugixml.hpp>

#include "analysis/canvas.h"

namespace halfslope {
namespace {

pugi::xml_document parse(const std::string& svg) {
  pugi::xml_document document;
  const auto result = document.load_string(svg.c_str());
  EXPECT_TRUE(result) << result.description() << "\n" << svg;
  return document;
}

std::string decode_base64(std::string_view text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return bytes;
}

TEST(Svg, EveryElementIsThereWithItsNumbers) {
  Canvas canvas(100, 50.5);
  canvas.begin_group("a line");
  canvas.line({{1, 2}, {3.14159, -0.00001}}, {{255, 0, 1}, 0.75, {1.5, 2}});
  canvas.end_group();
  canvas.polygon({{0, 0}, {1, 0}, {0, 1}}, {.fill = kBlack, .opacity = 0.25, .stroke = std::nullopt});
  canvas.disc({5, 6}, 7, {.fill = kWhite, .opacity = 1, .stroke = Stroke{kBlack, 1}});
  canvas.text({8, 9}, "N", {.size = 6, .anchor = Anchor::kEnd, .bold = true, .degrees = 90, .ink = {1, 2, 3}});
  const auto document = parse(svg_text(canvas));
  const auto svg = document.child("svg");
  EXPECT_STREQ(svg.attribute("width").value(), "100pt");
  EXPECT_STREQ(svg.attribute("viewBox").value(), "0 0 100 50.5");
  const auto group = svg.child("g");
  EXPECT_STREQ(group.child_value("title"), "a line");
  const auto line = group.child("polyline");
  EXPECT_STREQ(line.attribute("points").value(), "1,2 3.142,0");
  EXPECT_STREQ(line.attribute("fill").value(), "none");
  EXPECT_STREQ(line.attribute("stroke").value(), "#ff0001");
  EXPECT_STREQ(line.attribute("stroke-dasharray").value(), "1.5 2");
  const auto polygon = svg.child("polygon");
  EXPECT_STREQ(polygon.attribute("fill-opacity").value(), "0.25");
  EXPECT_FALSE(polygon.attribute("stroke"));
  const auto circle = svg.child("circle");
  EXPECT_EQ(circle.attribute("cx").as_double(), 5);
  EXPECT_EQ(circle.attribute("r").as_double(), 7);
  const auto text = svg.child("text");
  EXPECT_STREQ(text.attribute("text-anchor").value(), "end");
  EXPECT_STREQ(text.attribute("font-weight").value(), "bold");
  EXPECT_STREQ(text.attribute("transform").value(), "rotate(-90 8 9)");
  EXPECT_STREQ(text.attribute("fill").value(), "#010203");
}

TEST(Svg, AnyTextIsWellFormed) {
  for (const std::string nasty : {"<script>&\"'</text>", "]]>", "a\tb", "±½α×", "&amp;"}) {
    Canvas canvas(10, 10);
    canvas.begin_group(nasty);
    canvas.text({1, 1}, nasty);
    canvas.end_group();
    const auto document = parse(svg_text(canvas));
    EXPECT_EQ(document.child("svg").child("g").child_value("text"), nasty);
    EXPECT_EQ(document.child("svg").child("g").child_value("title"), nasty);
  }
  // What XML cannot hold, and bytes that are no UTF-8, become the replacement character.
  Canvas canvas(10, 10);
  canvas.text({1, 1}, std::string("a\x01") + "b\xff" + "c\xc0\xaf" + "d\xed\xa0\x80" + "e\xe2\x82");
  const std::string bad = "\xef\xbf\xbd";
  EXPECT_EQ(parse(svg_text(canvas)).child("svg").child_value("text"),
            "a" + bad + "b" + bad + "c" + bad + bad + "d" + bad + bad + bad + "e" + bad + bad);
}

TEST(Svg, PicturesArePngInside) {
  for (const int width : {1, 2, 3}) {  // each padding of base 64
    RgbImage image(width, 5);
    for (std::size_t k = 0; k < image.values.size(); ++k) image.values[k] = static_cast<std::uint8_t>(37 * k + 5);
    Canvas canvas(10, 10);
    canvas.picture({1, 2}, 3, 4, image);
    const auto document = parse(svg_text(canvas));
    const auto element = document.child("svg").child("image");
    EXPECT_THAT(element.attribute("style").value(), ::testing::HasSubstr("image-rendering:pixelated"));
    EXPECT_EQ(element.attribute("height").as_double(), 4);
    const std::string href = element.attribute("xlink:href").value(), head = "data:image/png;base64,";
    ASSERT_TRUE(href.starts_with(head));
    EXPECT_EQ((href.size() - head.size()) % 4, 0u);
    EXPECT_EQ(decode_base64(href.substr(head.size())), encode_png(image));
  }
}

}  // namespace
}  // namespace halfslope
