#include "analysis/measures.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;

TEST(Measures, AreExactAndNamed) {
  EXPECT_THAT(measure_names(), ElementsAre("star", "l2-star", "centered-l2", "wraparound-l2", "mixture-l2",
                                           "symmetric-l2", "extreme-l2", "periodic-l2", "diaphony", "t-value"));
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

}  // namespace
}  // namespace halfslope
