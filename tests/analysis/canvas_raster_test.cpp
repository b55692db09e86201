// Areas and places of what is drawn, against geometry.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "analysis/canvas.h"
#include "analysis/typeface.h"

namespace halfslope {
namespace {

/// Black ink on white: what each pixel has of it, and its centre of mass.
struct Coverage {
  double area = 0, x = 0, y = 0;  ///< in points² and points
};

Coverage coverage_of(const Canvas& canvas, double scale) {
  const RgbImage image = rasterize(canvas, scale);
  Coverage c;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double ink = (255 - image.pixel(x, y)[1]) / 255.0;
      c.area += ink, c.x += ink * (x + 0.5), c.y += ink * (y + 0.5);
    }
  }
  c.x /= c.area * scale;
  c.y /= c.area * scale;
  c.area /= scale * scale;
  return c;
}

const Paint kInk = {.fill = kBlack, .opacity = 1, .stroke = std::nullopt};

TEST(Raster, ADiscHasItsAreaAndCentre) {
  for (const double radius : {0.7, 1.5, 4.0, 17.3}) {
    Canvas canvas(60, 50);
    canvas.disc({31.13, 22.71}, radius, kInk);
    const Coverage c = coverage_of(canvas, 4);
    EXPECT_NEAR(c.area, std::numbers::pi * radius * radius, 0.01 * std::numbers::pi * radius * radius) << radius;
    EXPECT_NEAR(c.x, 31.13, 0.01) << radius;
    EXPECT_NEAR(c.y, 22.71, 0.01) << radius;
  }
}

// Coverage is exact: a rectangle's edge at a quarter of a pixel gives a quarter of the ink.
TEST(Raster, RectanglesCoverPixelsByTheirArea) {
  Canvas canvas(4, 4);
  canvas.rectangle({1, 1}, 1.25, 2.5, kInk);
  const RgbImage image = rasterize(canvas, 1);
  const auto ink = [&](int x, int y) { return (255 - image.pixel(x, y)[0]) / 255.0; };
  EXPECT_NEAR(ink(1, 1), 1, 0.005);
  EXPECT_NEAR(ink(1, 2), 1, 0.005);
  EXPECT_NEAR(ink(2, 1), 0.25, 0.005);
  EXPECT_NEAR(ink(1, 3), 0.5, 0.005);
  EXPECT_NEAR(ink(2, 3), 0.125, 0.005);
  EXPECT_EQ(ink(0, 1), 0);
  EXPECT_EQ(ink(3, 1), 0);
}

TEST(Raster, OpacityMixesColours) {
  Canvas canvas(2, 2);
  canvas.rectangle({0, 0}, 2, 2, {.fill = Ink{200, 100, 0}, .opacity = 0.4, .stroke = std::nullopt});
  const RgbImage image = rasterize(canvas, 1);
  EXPECT_EQ(image.pixel(0, 0)[0], 233);  // 255 − 0.4 · 55
  EXPECT_EQ(image.pixel(0, 0)[1], 193);
  EXPECT_EQ(image.pixel(1, 1)[2], 153);
}

TEST(Raster, AStrokeIsAsLongAndWideAsItSays) {
  Canvas solid(60, 60);
  solid.line({{10, 10}, {50, 40}}, {kBlack, 1.5});
  const double length = 50;
  EXPECT_NEAR(coverage_of(solid, 4).area, length * 1.5, 0.01 * length * 1.5);
  EXPECT_NEAR(coverage_of(solid, 4).x, 30, 0.02);
  Canvas dashed(60, 60);
  dashed.line({{10, 10}, {30, 25}, {50, 40}}, {kBlack, 1.5, {3, 2}});  // 10 dashes of 3, the corner among them
  EXPECT_NEAR(coverage_of(dashed, 4).area, 30 * 1.5, 0.02 * 30 * 1.5);
  Canvas square(60, 60);
  square.rectangle({10, 10}, 30, 20, {.fill = std::nullopt, .opacity = 1, .stroke = Stroke{kBlack, 2}});
  const double corners = 4 * (1 - std::numbers::pi / 4);  // round joins leave this of each corner's square
  EXPECT_NEAR(coverage_of(square, 4).area, 32 * 22 - 28 * 18 - corners, 1);
}

// A line that starts and ends in one place, and pieces of a dash that short, once ended the program.
TEST(Raster, LinesWithoutLengthDrawNothing) {
  Canvas canvas(10, 10);
  canvas.line({{5, 5}, {5, 5}}, {kBlack, 2});
  canvas.line({{5, 5}, {5.0001, 5}, {5, 5}}, {kBlack, 2});
  canvas.line({{5, 5}, {5, 5}}, {kBlack, 2, {1, 1}});
  canvas.line({{5, 5}}, {kBlack, 2});
  canvas.polygon({}, kInk);
  const RgbImage image = rasterize(canvas, 4);
  EXPECT_EQ(image.values, RgbImage(40, 40).values);
  for (int k = 0; k < 200; ++k) {  // a last dash of any length down to nothing
    canvas.line({{0, 1}, {2 + 0.01 * k, 1 + 0.003 * k}}, {kBlack, 1, {1, 1}});
  }
  EXPECT_GT(coverage_of(canvas, 4).area, 0);
}

TEST(Raster, WhatLiesOutsideIsCut) {
  Canvas canvas(10, 10);
  canvas.disc({0, 0}, 6, kInk);
  canvas.disc({-50, 3}, 6, kInk);
  canvas.line({{-20, 9}, {40, 9}}, {kBlack, 1});
  EXPECT_NEAR(coverage_of(canvas, 8).area, std::numbers::pi * 36 / 4 + 10, 0.1);
}

TEST(Raster, PicturesKeepTheirPixels) {
  RgbImage image(3, 2);
  for (std::size_t k = 0; k < image.values.size(); ++k) image.values[k] = static_cast<std::uint8_t>(10 * k);
  Canvas canvas(8, 8);
  canvas.picture({1, 2}, 6, 4, image);
  const RgbImage drawn = rasterize(canvas, 2);  // a pixel is 4 × 4 of ours
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const bool inside = x >= 2 && x < 14 && y >= 4 && y < 12;
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(drawn.pixel(x, y)[c], inside ? image.pixel((x - 2) / 4, (y - 4) / 4)[c] : 255) << x << "," << y;
      }
    }
  }
}

TEST(Raster, TextIsAnchoredAndTurned) {
  // "I" of a sans serif is a bar that is symmetric about its middle.
  Canvas middle(40, 40);
  middle.text({20, 30}, "I", {.size = 20, .anchor = Anchor::kMiddle});
  EXPECT_NEAR(coverage_of(middle, 4).x, 20, 0.1);
  EXPECT_LT(coverage_of(middle, 4).y, 30);
  EXPECT_GT(coverage_of(middle, 4).y, 15);
  Canvas end(40, 40);
  end.text({30, 30}, "I", {.size = 20, .anchor = Anchor::kEnd});
  EXPECT_NEAR(coverage_of(end, 4).x, 30 - text_width("I", 20) / 2, 0.1);
  // Turned a quarter counter-clockwise, what was above the baseline lies left of it.
  Canvas turned(40, 40);
  turned.text({30, 20}, "I", {.size = 20, .anchor = Anchor::kMiddle, .degrees = 90});
  EXPECT_NEAR(coverage_of(turned, 4).y, 20, 0.1);
  EXPECT_NEAR(30 - coverage_of(turned, 4).x, 30 - coverage_of(middle, 4).y, 0.05);
  EXPECT_NEAR(coverage_of(turned, 4).area, coverage_of(middle, 4).area, 0.05);
}

TEST(Typeface, WidthsAddUpAndBoldIsWider) {
  EXPECT_EQ(text_width("", 10), 0);
  EXPECT_NEAR(text_width("nnnn", 10), 4 * text_width("n", 10), 1e-9);
  EXPECT_NEAR(text_width("halton", 20), 2 * text_width("halton", 10), 1e-9);
  EXPECT_GT(text_width("halton", 10, true), text_width("halton", 10));
  EXPECT_LT(text_width("AV", 10), text_width("A", 10) + text_width("V", 10));  // kerned
  // Everything our labels use has a letter of its own.
  const Typeface typeface(false);
  for (const char* letter : {"⁰", "⁹", "⁻", "−", "½", "¾", "α", "×", "…", "é"}) {
    const auto line = typeface.set(letter);
    ASSERT_EQ(line.glyphs.size(), 1u) << letter;
    EXPECT_NE(line.glyphs[0].index, 0u) << letter;
  }
}

}  // namespace
}  // namespace halfslope
