#include "analysis/coverage_timing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfslope {
namespace {

// What order statistics cover is known exactly, and the same for every continuous law: 1 − 2 P(B < k), with k = 1 of 6,
// 4 of 15, 19 of 51. Efficiency joins two 95 % intervals, of which that of the time covers 96.5 %; the bootstrap-t of
// 64 squared Gaussian errors is good to a percent. Six standard deviations of 1500 runs: eleven rows have a false alarm
// in 2e-8 of seeds.
TEST(TimingCoverage, IsWhatTheoryGives) {
  const std::vector<CoverageRow> rows = timing_coverage({.runs = 1500, .seed = 1});
  ASSERT_EQ(rows.size(), 3u * 3 + 2);
  double below_19 = 0, term = std::exp2(-51);  // P(B < 19), n = 51
  for (int j = 0; j < 19; ++j) {
    below_19 += term;
    term *= (51.0 - j) / (j + 1);
  }
  for (const CoverageRow& row : rows) {
    const bool time = row.number == "time";
    const double share = !time                  ? 0.955
                         : row.replicates == 6  ? 1 - 2.0 / 64
                         : row.replicates == 15 ? 1 - 2 * 576.0 / 32768
                                                : 1 - 2 * below_19;
    const double noise = 6 * std::sqrt(share * (1 - share) / static_cast<double>(row.runs));
    EXPECT_NEAR(row.coverage(), share, noise + (time ? 0 : 0.015)) << row.number << ", " << row.law << row.replicates;
    EXPECT_GT(row.width, 0);
  }
}

TEST(TimingCoverage, StopsWhenTold) {
  int told = 0;
  CoverageRequest request{.runs = 1000};
  request.progress = [&](double) { return ++told < 1500; };
  EXPECT_EQ(timing_coverage(request).size(), 1u);
}

}  // namespace
}  // namespace halfslope
