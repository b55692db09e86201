#include <gmock/gmock.h>

#include <cmath>

#include "experiments/tables.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

const std::map<std::string, std::string> kPicture = {
    {"scene", "veach-mis"}, {"resolution", "40,27"}, {"estimators", "light"}, {"samplers", "independent"},
    {"samples", "4"},       {"replicates", "16"},    {"precision", "f64"}};

TEST(TailsTable, HasARowForEachCellAndItsColumns) {
  const RunScope scope;
  const RunOutcome outcome = scope.run({{"scene", "mis-toy"},
                                        {"estimators", "balance"},
                                        {"samplers", "independent,regular"},
                                        {"samples", "16:64"},
                                        {"replicates", "8"}});
  EXPECT_THAT(tails_csv(outcome.results),
              testing::StartsWith("scene,estimator,sampler,precision,samples,kurtosis,kurtosis_corrected,"
                                  "kurtosis_limit,median_abs_error,worst_share,certified,relmse_lo,relmse_hi\n"));
  const CsvTable tails = scope.table("tails.csv"), cells = scope.table("convergence.csv");
  ASSERT_EQ(tails.size(), cells.size());
  for (std::size_t row = 0; row < tails.size(); ++row) {
    EXPECT_EQ(tails.text(row, "samples"), cells.text(row, "samples"));
    EXPECT_EQ(tails.text(row, "kurtosis"), cells.text(row, "kurtosis"));
    EXPECT_EQ(tails.number(row, "worst_share"), 1);  // of one integral
    const bool deterministic = cells.text(row, "sampler") == "regular";
    EXPECT_EQ(tails.text(row, "certified"), deterministic ? "" : "no");  // fewer than 16 replicates
    EXPECT_EQ(tails.text(row, "kurtosis_limit"), deterministic ? "" : "5");
  }
}

// 1080 pixels of three channels or one: the share by its definition, from the same estimates as images give it.
TEST(TailsTable, TheWorstShareIsThatOfTheLargestMeanSquaredErrors) {
  const RunScope scope;
  auto keys = kPicture;
  const RunOutcome one = scope.run(keys);
  ASSERT_EQ(one.results.cells.size(), 1u);
  const double share = one.results.cells[0].statistics.worst_share.value();
  EXPECT_GT(share, 0.001);  // no less than if all were equal
  EXPECT_LT(share, 1);
  // With an image the integrals are kept as they are: the same tables.
  keys["images"] = "4";
  const RunOutcome kept = scope.run(keys, "kept");
  EXPECT_EQ(kept.results.cells[0].statistics.worst_share, share);
}

// One integral has all of the error, to the last bit, however many batches its replicates came in.
TEST(TailsTable, OfOneIntegralTheWorstShareIsOne) {
  const RunScope scope;
  for (const char* replicates : {"20", "600"}) {
    scope.run({{"scene", "mis-toy"},
               {"estimators", "light,balance,power"},
               {"samplers", "independent,sobol-owen"},
               {"samples", "4:1024"},
               {"precision", "f32,f64"},
               {"replicates", replicates}},
              replicates);
    const CsvTable tails = scope.table("tails.csv", replicates);
    ASSERT_EQ(tails.size(), 3u * 2 * 9 * 2);
    for (std::size_t row = 0; row < tails.size(); ++row) EXPECT_EQ(tails.number(row, "worst_share"), 1);
  }
}

TEST(TailsTable, IntervalsFollowTheMethodAndEstimatesDoNot) {
  const RunScope scope;
  std::map<std::string, std::string> keys = {{"scene", "mis-toy"},
                                             {"estimators", "balance"},
                                             {"samplers", "independent"},
                                             {"samples", "16"},
                                             {"replicates", "64"}};
  const RunOutcome first = scope.run(keys);
  keys["interval"] = "chi2";
  const RunOutcome second = scope.run(keys);  // the same folder: the journal serves
  const CellStatistics &a = first.results.cells[0].statistics, &b = second.results.cells[0].statistics;
  EXPECT_EQ(a.rmse, b.rmse);
  ASSERT_TRUE(a.rmse_lo && b.rmse_lo && a.rmse_hi && b.rmse_hi);
  EXPECT_NE(a.rmse_lo, b.rmse_lo);
  const auto chi2 = log_mean_interval(IntervalMethod::kChi2, second.results.cells[0].replicate_mse, 0);
  EXPECT_DOUBLE_EQ(std::pow(*b.rmse_lo, 2), std::exp(chi2->lo));
  EXPECT_DOUBLE_EQ(std::pow(*b.rmse_hi, 2), std::exp(chi2->hi));
  EXPECT_TRUE(b.certified);
}

TEST(IntervalKey, IsReadAndRefusedAndNoPartOfWhatWasMeasured) {
  Spec spec;
  EXPECT_EQ(spec.interval, IntervalMethod::kBootstrapT);
  const std::string before = canonical_json(spec);
  apply_flag(spec, "interval", "reciprocal-t");
  EXPECT_EQ(spec.interval, IntervalMethod::kReciprocalT);
  EXPECT_EQ(canonical_json(spec), before);
  try {
    apply_flag(spec, "interval", "student");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("--interval"), testing::HasSubstr("'student'"),
                                             testing::HasSubstr("bootstrap-t, chi2, delta, bca, reciprocal-t")));
  }
}

TEST(Summary, MarksIntervalsThatAreNotCertified) {
  const RunScope scope;
  std::map<std::string, std::string> keys = {{"scene", "mis-toy"},
                                             {"estimators", "balance"},
                                             {"samplers", "independent"},
                                             {"samples", "256"},
                                             {"replicates", "8"}};
  const std::string few = summary(scope.run(keys).results);
  EXPECT_THAT(few, testing::AllOf(testing::HasSubstr("~["), testing::HasSubstr("few-replicates"),
                                  testing::HasSubstr("not certified")));
  keys["replicates"] = "64";
  const RunOutcome enough = scope.run(keys, "enough");
  ASSERT_EQ(enough.results.cells[0].statistics.status, "ok");
  EXPECT_THAT(summary(enough.results), testing::Not(testing::HasSubstr("~")));
}

}  // namespace
}  // namespace halfslope
