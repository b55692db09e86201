#include "experiments/tables.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "experiments/manifest.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::map<std::string, std::string> kToy = {{"scene", "aligned-phong-cap:n=2,alpha=0.5"},
                                                 {"estimators", "light,power:3@light*3+bsdf"},
                                                 {"samplers", "independent,halton-owen"},
                                                 {"samples", "4,16"},
                                                 {"replicates", "20"}};

// What a user's script depends on.
TEST(Tables, HaveTheColumnsThatAreDocumented) {
  const RunScope scope;
  scope.run({{"scene", "veach-mis"},
             {"resolution", "6,4"},
             {"estimators", "light"},
             {"samplers", "independent"},
             {"samples", "4"}});
  const auto header = [&](const char* file) {
    const std::string text = read_file(scope.path("out") / file);
    return text.substr(0, text.find('\n'));
  };
  EXPECT_EQ(
      header("convergence.csv"),
      "scene,estimator,sampler,precision,samples,replicates,pixels,mean,reference,reference_se,reference_mse,bias,"
      "bias_se,variance,rmse,rmse_lo,rmse_hi,mae,relmse,kurtosis,median_abs_error,nonfinite,status");
  EXPECT_EQ(header("replicates.csv"), "scene,estimator,sampler,precision,samples,replicate,mean,mse,mae,max_abs_error");
  EXPECT_EQ(header("rates.csv"),
            "scene,estimator,sampler,precision,rate,rate_lo,rate_hi,samples_lo,samples_hi,theory,status");
  EXPECT_THAT(header("regions.csv"), StartsWith("scene,estimator,sampler,precision,samples,region,pixels,rmse,"));
}

TEST(Tables, QuoteNamesWithCommasAndEndLinesWithLf) {
  const RunScope scope;
  const RunOutcome outcome = scope.run(kToy);
  for (const char* file : {"convergence.csv", "replicates.csv", "rates.csv"}) {
    const std::string text = read_file(scope.path("out") / file);
    EXPECT_THAT(text,
                AllOf(HasSubstr("\n\"aligned-phong-cap:n=2,alpha=0.5\",light,independent,f32,"), Not(HasSubstr("\r"))));
    EXPECT_EQ(text.back(), '\n');
  }
  EXPECT_EQ(read_file(scope.path("out/convergence.csv")), convergence_csv(outcome.results));
  EXPECT_EQ(read_file(scope.path("out/rates.csv")), rates_csv(outcome.results));
  EXPECT_FALSE(std::filesystem::exists(scope.path("out/regions.csv")));  // one pixel has no parts
  EXPECT_EQ(scope.table("convergence.csv").text(3, "estimator"), "light");
  EXPECT_EQ(scope.table("convergence.csv").text(4, "estimator"), "power:3@light*3+bsdf");
}

// Shortest text that reads back as the same number.
TEST(Tables, NumbersReadBackAsTheyWere) {
  const RunScope scope;
  const RunOutcome outcome = scope.run(kToy);
  const CsvTable cells = scope.table("convergence.csv");
  for (std::size_t r = 0; r < cells.size(); ++r) {
    const CellStatistics& s = outcome.results.cells[r].statistics;
    EXPECT_EQ(cells.number(r, "mean"), s.mean);
    EXPECT_EQ(cells.number(r, "rmse"), s.rmse);
    EXPECT_EQ(cells.number(r, "rmse_hi"), s.rmse_hi);
    EXPECT_EQ(cells.number(r, "kurtosis"), s.kurtosis);
    EXPECT_EQ(cells.number(r, "samples"), static_cast<double>(outcome.plan.cells[r].samples));
    EXPECT_LE(cells.text(r, "mean").size(), 24u);
  }
}

TEST(Tables, TheSummaryShowsTheLargestNOfEverySampler) {
  const RunScope scope;
  const RunOutcome outcome = scope.run(kToy);
  const std::string text = summary(outcome.results);
  EXPECT_THAT(text, HasSubstr("N = 16"));
  EXPECT_THAT(text, Not(HasSubstr("N = 4,")));
  for (const char* name : {"independent", "halton-owen", "light", "power:3@light*3+bsdf"})
    EXPECT_THAT(text, HasSubstr(name));
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; ++at) EXPECT_NE(text[at - (at > 0)], ' ');
}

TEST(Tables, TheManifestSaysWhatRan) {
  const RunScope scope;
  auto keys = kToy;
  keys["name"] = "toy";
  keys["seed"] = "18446744073709551615";
  const RunOutcome outcome = scope.run(keys);
  const auto manifest = nlohmann::json::parse(read_file(scope.path("out/manifest.json")));
  EXPECT_EQ(manifest["name"], "toy");
  EXPECT_EQ(manifest["schema_version"], 1);
  EXPECT_EQ(manifest["spec"]["seed"], 18446744073709551615u);
  EXPECT_EQ(manifest["spec"]["estimators"][1], "power:3@light*3+bsdf");
  EXPECT_EQ(manifest["cells"], outcome.plan.cells.size());
  EXPECT_EQ(manifest["evaluations"], outcome.plan.evaluations());
  EXPECT_EQ(manifest["skipped"].size(), outcome.plan.skips.size());
  EXPECT_EQ(manifest["references"][0]["origin"], "closed form");
  EXPECT_TRUE(manifest["invalid"].empty());
  for (const char* key : {"version", "compiler", "isa", "isa_class", "host", "finished", "spec_hash"})
    EXPECT_TRUE(manifest.contains(key)) << key;
}

}  // namespace
}  // namespace halfslope
