#include "analysis/coverage_comparisons.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfslope {
namespace {

ErrorLaw four_point() {
  return {"four-point",
          1,
          [](RunRandom& random) {
            const double size = std::sqrt(random.uniform() < 0.5 ? 0.5 : 1.5);
            return random.uniform() < 0.5 ? -size : size;
          },
          {}};
}

ComparedFamily unlike(double shared, int pixels) {
  ComparedFamily family{"", {gaussian_errors()}, shared, pixels};
  const ErrorLaw others[] = {uniform_errors(), laplace_errors(), four_point()};
  for (std::size_t k = 0; k < 10; ++k) family.laws.push_back(others[k % 3]);
  return family;
}

// At 5 % of false alarms 150 families give 24 or more with probability 5e-7. (86 in 1000 families are what this is the
// short form of.) The ratios' bounds are far outside what those of 150 tables come to.
void expect_few_alarms(const ComparedFamily& family, std::int64_t replicates) {
  const auto rows = measure_alarms(family, replicates, {150, 7});
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].runs, 1500);
  EXPECT_GE(rows[0].coverage(), 0.9);
  EXPECT_LE(rows[0].coverage(), 0.99);
  EXPECT_EQ(rows[1].runs, 150);
  EXPECT_LE(rows[1].runs - rows[1].covered, 23);
}

TEST(MeasureAlarms, ErrorsOfUnlikeShapesAreNotToldApart) { expect_few_alarms(unlike(0, 1), 64); }
TEST(MeasureAlarms, NorAreThoseOnCommonSamples) { expect_few_alarms(unlike(0.9, 1), 64); }
TEST(MeasureAlarms, NorImagesOfSixteenReplicates) { expect_few_alarms(unlike(0.5, 16), 16); }

TEST(MeasurePower, DifferencesAreFoundAsOftenAsPredicted) {
  // 400 experiments: a share of 60 % within 4 + 12.5 percentage points but for 4e-7.
  const auto rows = measure_power({"", {gaussian_errors(), gaussian_errors()}, 0.97}, 256, {400, 3});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_GE(rows[0].coverage(), rows[0].coverage_least - 0.125);
  EXPECT_LE(rows[0].coverage(), rows[0].coverage_most + 0.125);
  EXPECT_GT(rows[0].coverage_least, 0.5);  // so the prediction is not near either end, where any would hold
  EXPECT_LT(rows[0].coverage_most, 0.8);
}

TEST(MeasureAlarms, DoNotDependOnTheThreads) {
  const auto one = measure_alarms(unlike(0, 1), 16, {60, 2, 1}), two = measure_alarms(unlike(0, 1), 16, {60, 2, 2});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one[i].covered, two[i].covered);
    EXPECT_EQ(one[i].width, two[i].width);
  }
}

}  // namespace
}  // namespace halfslope
