#include "analysis/coverage_rates.h"

#include <gtest/gtest.h>

namespace halfslope {
namespace {

const CoverageRequest kShort{.runs = 1000, .seed = 3};

// Of 1000 runs at a coverage of 95 % fewer than 910 or more than 985 hold the truth with a chance below 1e-6 each, at
// the 94 % of the heavier tails fewer than 900 likewise.
constexpr double kLeast = 0.91, kMost = 0.985, kLeastHeavy = 0.9;

TEST(RateCoverage, IntervalsHoldTheRateOfWalksAndMixtures) {
  for (const CoverageRow& row : measure_rates(walks(), 64, ReferenceUse::kCarried, kShort)) {
    EXPECT_GE(row.coverage(), kLeast) << row.method;
    EXPECT_LE(row.coverage(), kMost) << row.method;
  }
  for (const CoverageRow& row : measure_rates(owen_like(1.65), 64, ReferenceUse::kCarried, kShort)) {
    EXPECT_GE(row.coverage(), kLeastHeavy) << row.method;
    EXPECT_LE(row.coverage(), kMost) << row.method;
  }
}

TEST(RateCoverage, SixteenReplicatesAreEnough) {
  for (const RateLaw& law : {walks(), owen_like(1.65), owen_like(2)}) {
    for (const CoverageRow& row : measure_rates(law, 16, ReferenceUse::kCarried, kShort)) {
      EXPECT_GE(row.coverage(), 0.89) << row.law << row.method;  // of 92 %: 3.5 standard errors; no upper bound
    }
  }
}

TEST(RateCoverage, TheVarianceNeedsNoReference) {
  const std::vector<CoverageRow> rows = measure_variance_rate(64, kShort);
  EXPECT_GE(rows[0].coverage(), kLeast);
  EXPECT_LE(rows[0].coverage(), kMost);
}

// 600 runs. Where V̄ is taken as exact 70 % hold the truth, so that more than 85 % do has a chance below 1e-12.
TEST(RateCoverage, AReferenceOfFourTimesTheLargestNIsCarried) {
  const CoverageRequest request{.runs = 600, .seed = 4};
  const auto share = [&](ReferenceUse use) { return measure_rates(walks(1, 4), 256, use, request)[0].coverage(); };
  EXPECT_GE(share(ReferenceUse::kCarried), 0.9);
  EXPECT_LE(share(ReferenceUse::kCarried), 0.985);
  EXPECT_LT(share(ReferenceUse::kSubtracted), 0.85);
  EXPECT_LT(share(ReferenceUse::kIgnored), 0.85);
}

TEST(RateCoverage, AReferenceOfTheLargestNIsRefused) {
  const CoverageRequest request{.runs = 200, .seed = 5};
  for (const std::int64_t pixels : {1, 16}) {
    const std::vector<CoverageRow> rows = measure_rates(walks(pixels, 1), 256, ReferenceUse::kCarried, request);
    EXPECT_EQ(rows[0].covered, 0);
    EXPECT_EQ(rows[0].marked, 1);
    EXPECT_GE(rows[1].coverage(), 0.85);  // the window ends before it
  }
}

TEST(RateCoverage, RowsDoNotDependOnThreads) {
  CoverageRequest request{.runs = 60, .seed = 6, .threads = 1};
  const auto one = measure_rates(walks(), 16, ReferenceUse::kCarried, request);
  request.threads = 2;
  const auto two = measure_rates(walks(), 16, ReferenceUse::kCarried, request);
  EXPECT_EQ(one[0].covered, two[0].covered);
  EXPECT_EQ(one[1].width, two[1].width);
  request.seed = 7;
  EXPECT_NE(one[0].width, measure_rates(walks(), 16, ReferenceUse::kCarried, request)[0].width);
}

TEST(LongRateCoverage, KeepsEveryPromise) {
  const std::vector<CoverageRow> rows = rate_coverage({});
  EXPECT_GT(rows.size(), 30u);
  for (const CoverageRow& row : rows) {
    EXPECT_TRUE(keeps_promise(row)) << row.method << ", " << row.law << ", R = " << row.replicates << ": "
                                    << row.coverage() << ", marked " << row.marked;
  }
}

}  // namespace
}  // namespace halfslope
