// Cells that have no spread, no error or no neighbour: columns without meaning are empty, and the status says why.
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/engine.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::IsEmpty;

TEST(EngineEdgeCases, OneReplicateHasNoSpread) {
  const RunScope scope;
  scope.run({{"scene", "mis-toy"},
             {"estimators", "light"},
             {"samplers", "independent"},
             {"samples", "4,8"},
             {"replicates", "1"}});
  const CsvTable cells = scope.table("convergence.csv"), rates = scope.table("rates.csv");
  for (std::size_t r = 0; r < 2; ++r) {
    for (const char* column : {"bias_se", "variance", "kurtosis", "rmse_lo", "rmse_hi"})
      EXPECT_THAT(cells.text(r, column), IsEmpty()) << column;
    EXPECT_EQ(cells.text(r, "status"), "deterministic");
    EXPECT_DOUBLE_EQ(cells.number(r, "rmse"), std::fabs(cells.number(r, "bias")));
  }
  EXPECT_EQ(rates.text(0, "status"), "deterministic");
  EXPECT_THAT(rates.text(0, "rate_lo"), IsEmpty());
}

// f(x) = x, sampled with density 2x: every sample is worth 1/2.
TEST(EngineEdgeCases, AnEstimatorWithoutErrorIsExact) {
  const RunScope scope;
  scope.run({{"scene", "mis-toy"},
             {"estimators", "bsdf"},
             {"samplers", "independent"},
             {"samples", "4,8"},
             {"replicates", "20"}});
  const CsvTable cells = scope.table("convergence.csv"), rates = scope.table("rates.csv");
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(cells.text(r, "rmse"), "0");
    EXPECT_EQ(cells.text(r, "variance"), "0");
    EXPECT_THAT(cells.text(r, "kurtosis"), IsEmpty());
    EXPECT_EQ(cells.text(r, "status"), "exact");
  }
  EXPECT_EQ(rates.text(0, "status"), "exact");
  EXPECT_THAT(rates.text(0, "rate"), IsEmpty());
}

TEST(EngineEdgeCases, ASingleNHasNoRate) {
  const RunScope scope;
  scope.run({{"scene", "quarterdisk"}, {"samplers", "independent"}, {"samples", "64"}, {"replicates", "20"}});
  const CsvTable rates = scope.table("rates.csv");
  ASSERT_EQ(rates.size(), 1u);
  for (const char* column : {"rate", "rate_lo", "rate_hi", "samples_lo", "samples_hi"})
    EXPECT_THAT(rates.text(0, column), IsEmpty()) << column;
  EXPECT_EQ(rates.text(0, "status"), "too-few-points");
}

}  // namespace
}  // namespace halfslope
