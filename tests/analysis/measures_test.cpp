#include "analysis/measures.h"

#include <gmock/gmock.h>

#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;

TEST(Measures, AreExactAndNamed) {
  EXPECT_THAT(measure_names(), ElementsAre("star", "l2-star"));
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

}  // namespace
}  // namespace halfslope
