// Errors that theory knows exactly, of samplers through whole runs.
#include <gmock/gmock.h>

#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(SamplerErrors, AntitheticPointsIntegrateOddFunctionsExactly) {
  // `light` of mis-toy is f(x) = x, odd about the middle: each pair's mean is ½ to the last bit.
  const RunScope scope;
  scope.run({{"scene", "mis-toy"},
             {"estimators", "light"},
             {"samplers", "antithetic,independent"},
             {"samples", "2:4096"},
             {"precision", "f64"}});
  const CsvTable cells = scope.table("convergence.csv"), rates = scope.table("rates.csv");
  ASSERT_EQ(cells.size(), 24u);
  for (std::size_t r = 0; r < cells.size(); ++r) {
    if (cells.text(r, "sampler") == "independent") {
      EXPECT_GT(cells.number(r, "rmse"), 0);
      continue;
    }
    EXPECT_THAT(cells.text(r, "status"), StartsWith("exact"));
    EXPECT_EQ(cells.text(r, "rmse"), "0");
    EXPECT_EQ(cells.text(r, "mean"), "0.5");
  }
  ASSERT_EQ(rates.text(0, "sampler"), "antithetic");
  EXPECT_EQ(rates.text(0, "rate"), "");
}

// Odd about the middle, with mean 0: in binary64 exactly 0; in binary32, whose points are those of binary64 cut off,
// rounding is left, and no rate is made of it.
TEST(SamplerErrors, AntitheticPointsOnOddIntegrands) {
  const RunScope scope;
  scope.run({{"scene", "sin2pix,sinxy,oddprod:d=3"},
             {"samplers", "antithetic"},
             {"samples", "16:4096"},
             {"precision", "f32,f64"}});
  const CsvTable cells = scope.table("convergence.csv"), rates = scope.table("rates.csv");
  ASSERT_EQ(cells.size(), 54u);
  for (std::size_t r = 0; r < cells.size(); ++r) {
    if (cells.text(r, "precision") == "f64") {
      EXPECT_EQ(cells.text(r, "rmse"), "0");
      EXPECT_THAT(cells.text(r, "status"), StartsWith("exact"));
    } else {
      EXPECT_LT(cells.number(r, "rmse"), 2e-7);
    }
  }
  ASSERT_EQ(rates.size(), 6u);
  for (std::size_t r = 0; r < rates.size(); ++r) {
    EXPECT_EQ(rates.text(r, "rate"), "");
    EXPECT_THAT(rates.text(r, "status"),
                StartsWith(rates.text(r, "precision") == "f64" ? "exact" : "rounding-limited"));
  }
}

TEST(SamplerErrors, AntitheticPointsOfAnOddNumberAreRefusedByTheirNeighbours) {
  const RunScope scope;
  try {
    scope.run({{"scene", "mis-toy"}, {"estimators", "light"}, {"samplers", "antithetic"}, {"samples", "7"}});
    FAIL() << "was run";
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("the nearest legal: 6 and 8"));
  }
}

}  // namespace
}  // namespace halfslope
