// Pages from means that are written here, read back from their SVG.
#include "experiments/measured_pages.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "analysis/canvas.h"
#include "core/numbers.h"
#include "scenes/pairs.h"
#include "tests/experiments/svg_reading.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

MeasuredPoints points_named(const std::string& sampler, std::int64_t replicates = 64, int dims = 2) {
  MeasuredPoints points;
  points.sampler = sampler;
  points.layout = pairs(dims);
  points.replicates = replicates;
  return points;
}

pugi::xml_document parsed(const Canvas& canvas) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(svg_text(canvas).c_str()));
  return document;
}

double g_of(double r, int sampler) { return sampler == 0 ? 1 + 0.02 * std::sin(40 * r) : std::min(1.0, 30 * r); }

std::vector<MeasuredMean> correlations(const std::vector<MeasuredPoints>& points, std::uint64_t count = 1024) {
  std::vector<MeasuredMean> means;
  for (std::size_t s = 0; s < points.size(); ++s) {
    for (int k = 0; k < 40; ++k) {
      const double r = (k + 0.5) * 0.15 / 40, g = g_of(r, static_cast<int>(s));
      const double half = points[s].replicates > 1 ? 0.05 : 0;
      means.push_back({&points[s], count, "pcf:r=" + format_number(r), g, g - half, g + half, "mean"});
    }
  }
  return means;
}

TEST(MeasuredPages, PairCorrelationStandsAtRTimesTheRootOfN) {
  const std::vector<MeasuredPoints> points = {points_named("independent"), points_named("jittered")};
  const auto document = parsed(draw_line_page(pair_correlation_page(correlations(points), false)));
  EXPECT_THAT(texts(document), AllOf(Contains("Pair correlation"), Contains("distance r · √N"), Contains("independent"),
                                     Contains("jittered"), Contains("pair correlation g(r)")));
  const LinearMap x(place_of(document, "0", true), 0, place_of(document, "4", true), 4);
  const LinearMap y(place_of(document, "0", false), 0, place_of(document, "1", false), 1);
  const auto groups = document.select_nodes("//g");
  ASSERT_EQ(groups.size(), 2u);
  for (int s = 0; s < 2; ++s) {
    const auto group = groups[static_cast<std::size_t>(s)].node();
    EXPECT_EQ(group.child_value("title"), points[static_cast<std::size_t>(s)].sampler);
    const std::vector<Place> line = points_of(group.child("polyline")), band = points_of(group.child("polygon"));
    ASSERT_EQ(line.size(), 40u);
    ASSERT_EQ(band.size(), 80u);
    for (std::size_t k = 0; k < 40; ++k) {
      const double r = (static_cast<double>(k) + 0.5) * 0.15 / 40, g = g_of(r, s);
      EXPECT_NEAR(x.value(line[k].x), 32 * r, 1e-4);
      EXPECT_NEAR(y.value(line[k].y), g, 1e-4);
      EXPECT_NEAR(y.value(band[k].y), g + 0.05, 1e-4);
      EXPECT_NEAR(y.value(band[79 - k].y), std::max(0.0, g - 0.05), 1e-4);
    }
  }
  // Independent points' 1 is a grey line from edge to edge.
  bool level = false;
  for (const auto& node : document.select_nodes("/svg/polyline[@stroke='#6e6e6e']")) {
    const auto ends = points_of(node.node());
    level = level || (ends.size() == 2 && std::fabs(y.value(ends[0].y) - 1) < 1e-4 && ends[0].y == ends[1].y &&
                      std::fabs(x.value(ends[0].x)) < 1e-4);
  }
  EXPECT_TRUE(level);
}

TEST(MeasuredPages, DistancesAreInUnitsOfTheMeanOneInAnyDimension) {
  const std::vector<MeasuredPoints> points = {points_named("a", 64, 3)};
  const LinePage page = pair_correlation_page(correlations(points, 1000), false);
  EXPECT_EQ(page.charts.front().style.x_label, "distance r · N^(1/3)");
  EXPECT_NEAR(page.charts.front().lines.front().points[39].x, 10 * 39.5 * 0.15 / 40, 1e-12);
}

TEST(MeasuredPages, SideBySideEachSamplerHasADiagramOfTheSameScales) {
  const std::vector<MeasuredPoints> points = {points_named("a"), points_named("file:/some/where/b.txt"),
                                              points_named("c", 1)};
  const std::vector<MeasuredMean> means = correlations(points);
  EXPECT_THAT(pair_correlation_page(means, false).charts, SizeIs(1));
  EXPECT_THAT(pair_correlation_page(means, false).caption, HasSubstr("Bands: 95 % intervals"));
  const std::vector<MeasuredPoints> one = {points_named("c", 1)};
  const LinePage bare = pair_correlation_page(correlations(one), false);
  EXPECT_THAT(bare.caption, Not(HasSubstr("Bands")));
  EXPECT_TRUE(parsed(draw_line_page(bare)).select_nodes("//circle").empty());  // a lone curve needs no marker
  const LinePage page = pair_correlation_page(means, true);
  ASSERT_THAT(page.charts, SizeIs(3));
  const auto document = parsed(draw_line_page(page));
  EXPECT_EQ(document.select_nodes("//text[@font-weight='bold' and text()='file:b.txt']").size(), 1u);
  EXPECT_EQ(document.select_nodes("//text[text()='a']").size(), 1u);  // its title; there is no legend
  EXPECT_EQ(document.select_nodes("//circle").size(), 0u);            // nor markers, which tell lines apart
  const auto groups = document.select_nodes("//g");
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_TRUE(groups[1].node().child("polygon"));
  EXPECT_FALSE(groups[2].node().child("polygon")) << "one set has no interval";
  EXPECT_NEAR(points_of(groups[1].node().child("polyline"))[39].y, points_of(groups[2].node().child("polyline"))[39].y,
              1e-9);

  std::vector<MeasuredPoints> nine;
  for (int k = 0; k < 9; ++k) nine.push_back(points_named("s" + std::to_string(k)));
  EXPECT_THAT(pair_correlation_page(correlations(nine), false).charts, SizeIs(9)) << "more lines than looks";
}

std::vector<MeasuredMean> rings(const std::vector<MeasuredPoints>& points, std::uint64_t first, std::uint64_t second,
                                double anisotropy) {
  std::vector<MeasuredMean> means;
  for (std::size_t s = 0; s < points.size(); ++s) {
    const std::uint64_t count = s == 0 ? first : second;
    for (int f = 1; f <= 50; ++f)
      means.push_back({&points[s], count, fmt::format("radial-spectrum:f={}", f), 0.01 * f, 0.01 * f, 0.01 * f, "m"});
    for (int f = 1; f <= 50; ++f)
      means.push_back({&points[s], count, fmt::format("anisotropy:f={}", f), anisotropy, anisotropy, anisotropy, "m"});
  }
  return means;
}

TEST(MeasuredPages, RadialSpectraAreOverFrequencyAndItsShareOfTheRootOfN) {
  const std::vector<MeasuredPoints> points = {points_named("a"), points_named("b")};
  const LinePage same = radial_spectrum_page(rings(points, 400, 400, -1), false);
  ASSERT_THAT(same.charts, SizeIs(2));
  EXPECT_EQ(same.charts[0].style.x_label, "frequency f");
  EXPECT_EQ(same.charts[0].style.x_above_label, "f/√N");
  EXPECT_EQ(same.charts[0].style.x_above_unit, 20);
  EXPECT_EQ(same.charts[0].lines[1].points[49].x, 50);
  EXPECT_NEAR(same.charts[0].lines[1].points[49].y, 0.5, 1e-12);
  EXPECT_EQ(same.charts[1].style.y_label, "anisotropy (dB)");
  EXPECT_EQ(same.charts[1].lines[0].points[7].y, -1);
  const auto document = parsed(draw_line_page(same));
  EXPECT_EQ(document.select_nodes("//text[text()='f/√N']").size(), 2u);
  // The mark 2 above stands over 40 below.
  EXPECT_NEAR(place_of(document, "2", true), place_of(document, "40", true), 1e-3);

  const LinePage different = radial_spectrum_page(rings(points, 400, 2500, -1), false);
  EXPECT_EQ(different.charts[0].style.x_label, "frequency f/√N");
  EXPECT_THAT(different.charts[0].style.x_above_label, IsEmpty());
  EXPECT_EQ(different.charts[0].lines[0].points[49].x, 2.5);
  EXPECT_EQ(different.charts[0].lines[1].points[49].x, 1);
  EXPECT_EQ(different.charts[0].lines[1].label, "b, N = 2500");
}

// Grids have no anisotropy to speak of: their rings are all 0 but for a few peaks.
TEST(MeasuredPages, WhatIsNotFiniteIsNotDrawn) {
  const std::vector<MeasuredPoints> points = {points_named("a")};
  for (const double nothing : {-std::numeric_limits<double>::infinity(), std::nan("")}) {
    const std::string svg = svg_text(draw_line_page(radial_spectrum_page(rings(points, 400, 400, nothing), false)));
    EXPECT_THAT(svg, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
  }
}

TEST(MeasuredPages, DiscrepancyStandsAtItsLogarithmsWithItsInterval) {
  const std::vector<MeasuredPoints> points = {points_named("independent", 16), points_named("halton", 1)};
  std::vector<MeasuredMean> means;
  for (std::size_t s = 0; s < 2; ++s) {
    for (const std::uint64_t n : {16, 64, 256, 1024}) {
      const double value = s == 0 ? 1 / std::sqrt(static_cast<double>(n)) : 2.0 / static_cast<double>(n);
      const double factor = s == 0 ? 1.25 : 1;
      means.push_back({&points[s], n, "star", value, value / factor, value * factor, "mean"});
      means.push_back({&points[s], n, "l2-star", s == 0 ? value / 4 : 0, 0, 0, "mean"});
    }
  }
  const std::vector<MeasuredSlope> slopes = {{&points[0], "star", {-0.5, Interval{-0.52, -0.48}, 16, 1024, "ok"}},
                                             {&points[1], "star", {-1, std::nullopt, 16, 1024, "deterministic"}},
                                             {&points[1], "l2-star", {std::nullopt, std::nullopt, 0, 0, "exact"}}};
  const LinePage page = discrepancy_page(means, slopes);
  ASSERT_THAT(page.charts, SizeIs(2));
  const auto document = parsed(draw_line_page(page));
  EXPECT_THAT(texts(document), AllOf(Contains("star"), Contains("l2-star"), Contains("points N"),
                                     Contains("slope [95 %]"), Contains("−0.50 [−0.52, −0.48]"), Contains("−1.00"),
                                     Contains("exact"), Contains(HasSubstr("not above 0 are left out"))));
  const LogMap x(place_of(document, "16", true), 16, place_of(document, "1024", true), 1024);
  const LogMap y(place_of(document, "10⁻¹", false), 0.1, place_of(document, "10⁻²", false), 0.01);
  const auto first = document.select_nodes("//g")[0].node(), second = document.select_nodes("//g")[1].node();
  EXPECT_STREQ(first.child_value("title"), "star, independent");
  const auto line = points_of(first.child("polyline"));
  ASSERT_EQ(line.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const double n = 16 * std::pow(4, k), value = 1 / std::sqrt(n);
    EXPECT_NEAR(x.value(line[k].x), n, 3e-4 * n);
    EXPECT_NEAR(y.value(line[k].y), value, 3e-4 * value);
  }
  auto bar = first.child("polyline").next_sibling("polyline");
  EXPECT_NEAR(y.value(points_of(bar)[0].y), 0.25 / 1.25, 1e-4);
  EXPECT_NEAR(y.value(points_of(bar)[1].y), 0.25 * 1.25, 1e-4);
  EXPECT_FALSE(second.child("polyline").next_sibling("polyline")) << "one replicate has no interval";
  // l2-star of the second sampler is 0 throughout.
  EXPECT_FALSE(document.select_nodes("//g")[3].node().child("polyline"));
}

// The least-squares slope of N^-0.7 is -0.7; where replicates differ by a factor alone, each of them has that slope,
// and so has every resample of them.
TEST(MeasuredPages, SlopesAreThoseOfTheMeans) {
  MeasuresPlan plan;
  plan.points.push_back(points_named("a", 32));
  Measurements measured;
  for (const std::uint64_t n : {16, 32, 64, 128, 1024}) {
    plan.points[0].counts.push_back({n, {0}, {"star"}});
    for (int r = 0; r < 32; ++r) {
      const double value = (1 + 0.01 * r) * std::pow(static_cast<double>(n), -0.7);
      measured.push_back({value, value, value, "exact"});
    }
  }
  const auto slopes = measured_slopes(plan, measured);
  ASSERT_THAT(slopes, SizeIs(1));
  ASSERT_TRUE(slopes[0].fit.rate);
  EXPECT_EQ(slopes[0].points, plan.points.data());
  EXPECT_EQ(slopes[0].measure, "star");
  EXPECT_NEAR(*slopes[0].fit.rate, -0.7, 1e-12);
  if (slopes[0].fit.interval) {
    EXPECT_NEAR(slopes[0].fit.interval->lo, -0.7, 1e-9);
    EXPECT_NEAR(slopes[0].fit.interval->hi, -0.7, 1e-9);
  }
}

std::vector<MeasuredMean> grid_of(const MeasuredPoints& points, int most) {
  std::vector<MeasuredMean> means;
  for (int ky = -most; ky <= most; ++ky) {
    for (int kx = -most; kx <= most; ++kx) {
      // 0 at the left, 1.25 in the middle and 2.5 at the right; far more at the top.
      const double power = kx == 0 && ky == 0 ? 1e6 : ky == most ? 100 : 1.25 * (1 + static_cast<double>(kx) / most);
      means.push_back({&points, 1024, fmt::format("spectrum:kx={},ky={}", kx, ky), power, power, power, "m"});
    }
  }
  return means;
}

TEST(MeasuredPages, SpectraAreGreysThatTheCaptionExplains) {
  const MeasuredPoints a = points_named("a", 16), b = points_named("b", 1);
  std::vector<MeasuredMean> means = grid_of(a, 10);
  const auto more = grid_of(b, 10);
  means.insert(means.end(), more.begin(), more.end());
  const Canvas canvas = spectrum_page(means, "Seed 1");
  std::vector<const Canvas::Picture*> pictures;
  for (const Canvas::Element& element : canvas.elements()) {
    if (const auto* picture = std::get_if<Canvas::Picture>(&element)) pictures.push_back(picture);
  }
  ASSERT_THAT(pictures, SizeIs(3));  // the last is the scale of greys
  const RgbImage& image = pictures[0]->image;
  ASSERT_EQ(image.width, 21);
  ASSERT_EQ(image.height, 21);
  const auto grey = [&](int kx, int ky) {
    const std::uint8_t* p = image.pixel(kx + 10, 10 - ky);
    EXPECT_TRUE(p[0] == p[1] && p[1] == p[2]);
    return static_cast<int>(p[0]);
  };
  EXPECT_EQ(grey(-10, 0), 0);
  EXPECT_EQ(grey(10, 0), 255);
  EXPECT_EQ(grey(-6, 3), 51);  // 0.2 of white
  EXPECT_EQ(grey(4, 10), 255) << "above the scale";
  EXPECT_EQ(grey(0, 0), 0) << "left out";
  EXPECT_EQ(grey(0, 1), 128);
  const auto document = parsed(canvas);
  EXPECT_THAT(texts(document),
              AllOf(Contains("N = 1024, mean of 16 sets"), Contains("N = 1024, one set"), Contains("power 0"),
                    Contains(HasSubstr("2.5 and above")), Contains(HasSubstr("k = 0 is left out"))));
  // The mark 0 stands under the middle of the pixels of frequency 0.
  EXPECT_NEAR(place_of(document, "0", true), pictures[0]->top_left.x + pictures[0]->width / 2, 1e-3);
  const double pixel = pictures[0]->width / 21;
  EXPECT_NEAR(place_of(document, "10", true), pictures[0]->top_left.x + 20.5 * pixel, 2e-3);
}

}  // namespace
}  // namespace halfslope
