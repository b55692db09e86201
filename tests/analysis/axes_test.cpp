#include "analysis/axes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "analysis/palette.h"
#include "analysis/text_fit.h"
#include "analysis/tone_map.h"
#include "analysis/typeface.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> found;
  for (const Tick& tick : ticks) {
    if (!tick.label.empty()) found.push_back(tick.label);
  }
  return found;
}

TEST(Axes, PowersHaveSuperscripts) {
  EXPECT_EQ(power_label(10, -3), "10⁻³");
  EXPECT_EQ(power_label(2, 10), "2¹⁰");
  EXPECT_EQ(power_label(10, 0), "10⁰");
  EXPECT_EQ(power_label(10, -256), "10⁻²⁵⁶");
}

TEST(Axes, LogTicksAreAtPowers) {
  EXPECT_THAT(labels(log_ticks(0.0007, 30, 10, 6)), ElementsAre("10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"));
  EXPECT_THAT(labels(log_ticks(1, 1000, 10, 6)), ElementsAre("10⁰", "10¹", "10²", "10³"));  // both ends
  EXPECT_THAT(labels(log_ticks(4, 1024, 2, 5)), ElementsAre("2²", "2⁴", "2⁶", "2⁸", "2¹⁰"));
  EXPECT_THAT(labels(log_ticks(1e-12, 1, 10, 5)), ElementsAre("10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "10⁰"));
  for (const Tick& tick : log_ticks(3e-7, 2e5, 10, 4)) {
    const double exponent = std::log10(tick.value);
    EXPECT_NEAR(exponent, std::round(exponent), 1e-12);
    EXPECT_EQ(tick.label.empty() || tick.label == power_label(10, static_cast<int>(std::lround(exponent))), true);
  }
}

TEST(Axes, NarrowLogRangesStillHaveLabels) {
  EXPECT_THAT(labels(log_ticks(0.15, 0.9, 10, 6)), ElementsAre("0.2", "0.5"));
  EXPECT_THAT(labels(log_ticks(1.5, 12, 10, 6)), ElementsAre("2", "5", "10"));
  for (double ratio = 1.01; ratio < 1e9; ratio *= 1.3) {
    for (const double lo : {1e-9, 0.0317, 1.0, 7.7, 1e5}) {
      const auto ticks = log_ticks(lo, lo * ratio, 10, 6);
      EXPECT_GE(labels(ticks).size(), 2u) << lo << " " << ratio;
      EXPECT_LE(labels(ticks).size(), 7u) << lo << " " << ratio;
      for (const Tick& tick : ticks) EXPECT_TRUE(tick.value >= lo * 0.999999 && tick.value <= lo * ratio * 1.000001);
    }
  }
}

TEST(Axes, LinearTicksAreRound) {
  EXPECT_THAT(labels(linear_ticks(0, 1, 6)), ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1"));
  EXPECT_THAT(labels(linear_ticks(-10, 10, 5)), ElementsAre("−10", "−5", "0", "5", "10"));
  EXPECT_THAT(labels(linear_ticks(0.1, 0.35, 6)), ElementsAre("0.1", "0.15", "0.2", "0.25", "0.3", "0.35"));
}

TEST(Axes, PlacesAreLogarithmsOfValues) {
  const Axes axes{{10, 20}, 300, 100, {{true, 1, 1000}, {}, ""}, {{true, 0.01, 1}, {}, ""}};
  EXPECT_NEAR(axes.at(1, 1).x, 10, 1e-9);
  EXPECT_NEAR(axes.at(1, 1).y, 20, 1e-9);
  EXPECT_NEAR(axes.at(1000, 0.01).x, 310, 1e-9);
  EXPECT_NEAR(axes.at(1000, 0.01).y, 120, 1e-9);
  EXPECT_NEAR(axes.at(10, 0.1).x, 110, 1e-9);
  EXPECT_NEAR(axes.at(10, 0.1).y, 70, 1e-9);
  const Axes linear{{0, 0}, 100, 100, {{false, -1, 1}, {}, ""}, {{false, 0, 4}, {}, ""}};
  EXPECT_NEAR(linear.at(0, 1).x, 50, 1e-9);
  EXPECT_NEAR(linear.at(0, 1).y, 75, 1e-9);
}

// A guide of slope −1/2 over three decades falls one and a half; one of −3/2 meets the lower edge of two decades first.
TEST(Axes, SlopeGuidesHaveTheirSlope) {
  const Axes axes{{0, 0}, 300, 200, {{true, 1, 1000}, {}, ""}, {{true, 0.01, 1}, {}, ""}};
  Canvas canvas(400, 300);
  draw_slope_guide(canvas, axes, 1, 1, -0.5, "a");
  draw_slope_guide(canvas, axes, 1, 1, -1.5, "b");
  const auto end = [&](std::size_t k) { return std::get<Canvas::Path>(canvas.elements()[k]).points.back(); };
  EXPECT_NEAR(end(0).x, 300, 1e-9);
  EXPECT_NEAR(end(0).y, 150, 1e-9);
  EXPECT_NEAR(end(2).x, 100 * 4.0 / 3, 1e-9);
  EXPECT_NEAR(end(2).y, 200, 1e-9);
}

// By more than colour: markers and dashes differ too, and greys of neighbours on the list are not alone in telling
// them.
TEST(Palette, EveryLookDiffersInColourMarkerAndDashes) {
  ASSERT_EQ(looks().size(), 8u);
  for (std::size_t a = 0; a < looks().size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_FALSE(looks()[a].ink == looks()[b].ink);
      EXPECT_NE(looks()[a].marker, looks()[b].marker);
      EXPECT_NE(looks()[a].dashes, looks()[b].dashes);
    }
  }
}

TEST(Palette, MarkersAreCentredAndOfLikeArea) {
  for (const Look& look : looks()) {
    Canvas canvas(40, 40);
    draw_marker(canvas, {20, 20}, 8, {kBlack, look.marker, {}});
    const RgbImage image = rasterize(canvas, 4);
    double area = 0, x = 0, y = 0;
    for (int py = 0; py < image.height; ++py) {
      for (int px = 0; px < image.width; ++px) {
        const double ink = (255 - image.pixel(px, py)[0]) / 255.0 / 16;
        area += ink, x += ink * (px + 0.5) / 4, y += ink * (py + 0.5) / 4;
      }
    }
    EXPECT_NEAR(x / area, 20, 0.05);
    EXPECT_NEAR(y / area, 20, 0.05);
    EXPECT_NEAR(area, 3.14159 * 64, 0.2 * 3.14159 * 64) << static_cast<int>(look.marker);
  }
}

// IEC 61966-2-1: the two branches meet, and mid grey 0.2140 is byte 128 (of 255 · 0.5019).
TEST(ToneMap, IsTheTransferFunctionOfSrgb) {
  EXPECT_NEAR(srgb_encoded(0.0031308), 12.92 * 0.0031308, 1e-6);
  EXPECT_NEAR(srgb_encoded(0.00313081), 0.04045, 1e-5);
  EXPECT_NEAR(srgb_encoded(1), 1, 1e-12);
  EXPECT_NEAR(srgb_encoded(0.21404114), 0.5, 1e-7);
  EXPECT_EQ(tone_mapped(0.2158605, 0), 128);
  EXPECT_EQ(tone_mapped(0.2158605 * 8, -3), 128);
  EXPECT_EQ(tone_mapped(0, 0), 0);
  EXPECT_EQ(tone_mapped(-1, 0), 0);
  EXPECT_EQ(tone_mapped(NAN, 0), 0);
  EXPECT_EQ(tone_mapped(INFINITY, 0), 255);
  EXPECT_EQ(tone_mapped(1, 0), 255);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(tone_mapped_image(std::vector<double>{nan, 1, -infinity}, 3, 1, 1, 0).values,
            (std::vector<std::uint8_t>{255, 0, 255, 255, 255, 255, 255, 0, 255}));
  EXPECT_EQ(tone_mapped_image(std::vector<double>{0, 1}, 2, 1, 1, 0).values,
            (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255}));
  EXPECT_EQ(tone_mapped_image(std::vector<double>{0, 1, 0}, 1, 1, 3, 0).values, (std::vector<std::uint8_t>{0, 255, 0}));
}

TEST(TextFit, KeepsToTheWidth) {
  EXPECT_EQ(fitted("halton", 7, 100), "halton");
  for (const char* text : {"hammersley-owen", "α½×é…α½×é…", "WWWWWWWW"}) {
    const std::string shorter = fitted(text, 7, 30);
    EXPECT_LE(text_width(shorter, 7), 30);
    EXPECT_TRUE(shorter.ends_with("…"));
    EXPECT_TRUE(std::string(text).starts_with(shorter.substr(0, shorter.size() - 3)));
  }
  EXPECT_EQ(fitted("wide", 7, 1), "…");
  const auto lines = wrapped("one two three four five six", 7, 40);
  EXPECT_GT(lines.size(), 1u);
  std::string all;
  for (const std::string& line : lines) {
    EXPECT_LE(text_width(line, 7), 40);
    all += (all.empty() ? "" : " ") + line;
  }
  EXPECT_EQ(all, "one two three four five six");
  EXPECT_THAT(wrapped("indivisible", 7, 5), ElementsAre("indivisible"));
  EXPECT_TRUE(wrapped("", 7, 5).empty());
}

}  // namespace
}  // namespace halfslope
