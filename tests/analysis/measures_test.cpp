#include "analysis/measures.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(Measures, AreExactAndNamed) {
  EXPECT_THAT(measure_names(),
              ElementsAre("star", "l2-star", "centered-l2", "wraparound-l2", "mixture-l2", "symmetric-l2", "extreme-l2",
                          "periodic-l2", "diaphony", "t-value", "min-distance", "min-distance-toroidal",
                          "mean-nn-distance", "mean-nn-distance-toroidal", "relative-radius", "dispersion",
                          "dispersion-toroidal", "pcf", "spectrum", "radial-spectrum", "anisotropy"));
  const Columns points = halton(0, 100);
  const double expected[] = {0.050239197530864144, 0.015271739964098575};
  for (std::size_t m = 0; m < 2; ++m) {
    const MeasureInfo& info = measure_catalogue()[m];
    EXPECT_FALSE(info.description.empty() || info.reference.empty());
    EXPECT_GE(info.max_dims, 2u);
    const MeasuredValue found = make_measure(info.name).values(view(points)).at(0);
    EXPECT_NEAR(found.value, expected[m], 1e-12) << info.name;  // the root of the second, not its square
    EXPECT_EQ(found.lower, found.value);
    EXPECT_EQ(found.upper, found.value);
    EXPECT_EQ(found.method, "exact");
  }
}

TEST(Measures, TValueHasABase) {
  const Columns faure = {{0, 1.0 / 3, 2.0 / 3}, {0, 2.0 / 3, 1.0 / 3}};
  const Measure measure = make_measure("t-value:base=3");
  EXPECT_EQ(measure.refusal(3, 2), "");
  EXPECT_THAT(measure.rows(3, 2), ElementsAre("t-value:base=3"));
  EXPECT_EQ(measure.values(view(faure)).at(0).value, 0);
  EXPECT_NE(make_measure("t-value").refusal(3, 2), "");
  EXPECT_THAT(make_measure("t-value").rows(4, 2), ElementsAre("t-value"));
  EXPECT_THROW(make_measure("t-value:base=1"), Error);
  EXPECT_THROW(make_measure("t-value:base=2.5"), Error);
}

TEST(Measures, RefuseTooManyDimensionsAndTooMuchWork) {
  EXPECT_EQ(make_measure("diaphony").refusal(100, 1024), "");
  EXPECT_NE(make_measure("diaphony").refusal(100, 1025), "");
  EXPECT_NE(make_measure("diaphony").refusal(1 << 24, 3), "");
}

TEST(Measures, StarIsBetweenBoundsWhereItIsOutOfReach) {
  const Measure star = make_measure("star");
  EXPECT_EQ(star.refusal(1000, 100), "");
  EXPECT_NE(star.refusal(std::size_t{1} << 25, 1), "");
  EXPECT_EQ(star.values(view(halton(0, 64, 4))).at(0).method, "exact");
  const MeasuredValue found = star.values(view(halton(0, 16, 33))).at(0);
  EXPECT_EQ(found.value, found.lower);
  EXPECT_LT(found.lower, found.upper);
  EXPECT_EQ(found.upper, 1);
  EXPECT_EQ(found.method, "bounds: threshold accepting");
}

// As many rows as values, whatever the measure; values in order of the rows.
TEST(Measures, NameEachValue) {
  const Columns points = halton(0, 64);
  for (const MeasureInfo& info : measure_catalogue()) {
    EXPECT_FALSE(info.description.empty() || info.reference.empty()) << info.name;
    const Measure measure = make_measure(info.name);
    EXPECT_EQ(measure.refusal(64, 2), "") << info.name;
    const auto rows = measure.rows(64, 2);
    EXPECT_THAT(measure.values(view(points)), SizeIs(rows.size())) << info.name;
    EXPECT_EQ(info.curve, rows.size() > 1) << info.name;
    if (info.curve) continue;
    EXPECT_THAT(rows, ElementsAre(info.name));
  }
}

TEST(Measures, CurvesNameTheirPlaces) {
  EXPECT_THAT(make_measure("pcf:bins=4,max=0.2").rows(100, 2),
              ElementsAre("pcf:r=0.025", "pcf:r=0.075", "pcf:r=0.125", "pcf:r=0.175"));
  EXPECT_THAT(make_measure("pcf:bins=2").rows(10'000, 2), ElementsAre("pcf:r=0.025", "pcf:r=0.075"));
  EXPECT_THAT(make_measure("spectrum:size=2").rows(5, 2),
              ElementsAre("spectrum:kx=-1,ky=-1", "spectrum:kx=0,ky=-1", "spectrum:kx=-1,ky=0", "spectrum:kx=0,ky=0"));
  EXPECT_THAT(make_measure("radial-spectrum:size=7").rows(5, 2),
              ElementsAre("radial-spectrum:f=1", "radial-spectrum:f=2", "radial-spectrum:f=3"));
  EXPECT_THAT(make_measure("anisotropy:size=2").rows(5, 2), ElementsAre("anisotropy:f=1"));
  const Columns points = halton(0, 100);
  const auto powers = make_measure("spectrum:size=3").values(view(points));
  ASSERT_THAT(powers, SizeIs(9));
  EXPECT_EQ(powers[4].value, 100);  // kx = ky = 0
  EXPECT_EQ(powers[0].value, powers[8].value);
  EXPECT_NE(powers[0].value, powers[2].value);
}

TEST(Measures, RefuseWhatTheyCannotMeasure) {
  const auto refusal = [](const char* name, std::size_t count, std::size_t dims) {
    return make_measure(name).refusal(count, dims);
  };
  for (const char* name : {"min-distance", "min-distance-toroidal", "mean-nn-distance", "mean-nn-distance-toroidal",
                           "relative-radius", "pcf", "anisotropy"}) {
    EXPECT_EQ(refusal(name, 1, 2), "it needs two points") << name;
    EXPECT_EQ(refusal(name, 2, 2), "") << name;
  }
  for (const char* name : {"dispersion", "dispersion-toroidal", "spectrum", "radial-spectrum"}) {
    EXPECT_EQ(refusal(name, 1, 2), "") << name;
    EXPECT_THAT(refusal(name, 10, 1), HasSubstr("2 dimensions")) << name;
    EXPECT_THAT(refusal(name, 10, 3), HasSubstr("2 dimensions")) << name;
  }
  EXPECT_EQ(refusal("min-distance", 100, 1000), "");
  EXPECT_EQ(refusal("relative-radius", 100, 3), "");
  EXPECT_THAT(refusal("relative-radius", 100, 4), HasSubstr("at most 3 dimensions"));
  // The figure is named: 1e9 points of 2 dimensions take 96 bytes each; (3e6)² · 7/2 differences.
  EXPECT_THAT(refusal("min-distance", 1'000'000'000, 2), HasSubstr("96 GB"));
  EXPECT_THAT(refusal("min-distance", 3'000'000, 7), HasSubstr("3.2e+13 steps"));
  EXPECT_THAT(refusal("pcf:max=0.5", 10'000'000, 2), HasSubstr("1e+14 steps"));
  EXPECT_EQ(refusal("pcf", 10'000'000, 2), "");
  EXPECT_THAT(refusal("spectrum:size=1024", 100'000'000, 2), HasSubstr("1.1e+14 steps"));
}

TEST(Measures, RefuseParametersOutOfRange) {
  for (const char* name : {"pcf:bins=0", "pcf:bins=1.5", "pcf:max=0.6", "pcf:max=-1", "spectrum:size=1025",
                           "spectrum:size=0", "radial-spectrum:size=1", "anisotropy:bins=3", "dispersion:x=1"}) {
    EXPECT_THROW(make_measure(name), Error) << name;
  }
}

}  // namespace
}  // namespace halfslope
