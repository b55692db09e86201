// Integrands through the whole engine: independent points must have the RMSE that the variance says, and where that is
// infinite nothing is reported that does not exist.
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "experiments/engine.h"
#include "tests/experiments/program.h"
#include "tests/experiments/run_spec.h"
#include "tests/scenes/integrand_data.h"

namespace halfslope {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string joined_ids(bool finite) {
  std::string names;
  for (const KnownIntegrand& known : known_integrands()) {
    if (known.variance.has_value() == finite) names += (names.empty() ? "" : ",") + known.id;
  }
  return names;
}

// The mean of R squared errors has a relative standard error of √((κ − 1)/R), κ being an estimate's kurtosis; half of
// it is the RMSE's. Six of them are passed by chance with 2e-9, in any of the 134 cells with 3e-7. `invsqrtprod2` has
// no fourth moment, so no such error: its one largest value may double an RMSE with a chance of some percent, and its
// variance is checked by quadrature alone (tests/scenes/integrand_moments_test.cpp).
TEST(IntegrandRuns, IndependentPointsHaveTheErrorThatTheVarianceSays) {
  const RunScope scope;
  scope.run({{"scene", joined_ids(true)},
             {"samplers", "independent"},
             {"samples", "64,256"},
             {"replicates", "1024"},
             {"precision", "f64"}});
  const CsvTable cells = scope.table("convergence.csv");
  ASSERT_EQ(cells.size(), 2 * 68u);
  std::size_t r = 0;
  for (const KnownIntegrand& known : known_integrands()) {
    if (!known.variance) continue;
    for (int k = 0; k < 2; ++k, ++r) {
      ASSERT_EQ(cells.text(r, "scene"), known.id);
      const double exact = std::sqrt(static_cast<double>(*known.variance) / cells.number(r, "samples"));
      if (known.id == "invsqrtprod2") continue;
      const double kurtosis = cells.number(r, "kurtosis"), error = std::sqrt((kurtosis - 1) / 1024) / 2;
      EXPECT_NEAR(cells.number(r, "rmse") / exact, 1, 6 * error) << known.id;
      EXPECT_EQ(cells.number(r, "reference"), (*Catalogue::built_in().make_scene(known.id, {})->closed_form(0))[0]);
    }
  }
}

// Latin hypercube points of x y: 1/(24N³) + [N²(1 − 1/N²)²/(144(N − 1)) + (1 − 1/N²)/(72N) + 1/(144N³)]/N². Six
// standard errors as above, 2e-9 each.
TEST(IntegrandRuns, NRooksHasItsExactErrorOnAProduct) {
  const RunScope scope;
  scope.run({{"scene", "bilinear"},
             {"samplers", "n-rooks"},
             {"samples", "4,16,64,256"},
             {"replicates", "4096"},
             {"precision", "f64"}});
  const CsvTable cells = scope.table("convergence.csv");
  ASSERT_EQ(cells.size(), 4u);
  for (std::size_t r = 0; r < 4; ++r) {
    const double n = cells.number(r, "samples"), left = 1 - 1 / (n * n), cube = n * n * n;
    const double mse =
        1 / (24 * cube) + (n * n * left * left / (144 * (n - 1)) + left / (72 * n) + 1 / (144 * cube)) / (n * n);
    EXPECT_NEAR(cells.number(r, "rmse") / std::sqrt(mse), 1,
                6 * std::sqrt((cells.number(r, "kurtosis") - 1) / 4096) / 2)
        << n;
  }
}

TEST(IntegrandRuns, InfiniteVarianceRefusesWhatDoesNotExist) {
  const RunScope scope;
  const RunOutcome outcome = scope.run({{"scene", joined_ids(false)},
                                        {"samplers", "independent,halton-owen"},
                                        {"samples", "4:64"},
                                        {"replicates", "32"},
                                        {"precision", "f64"}});
  const CsvTable cells = scope.table("convergence.csv"), rates = scope.table("rates.csv");
  ASSERT_EQ(cells.size(), 2u * 2 * 5);
  for (std::size_t r = 0; r < cells.size(); ++r) {
    EXPECT_EQ(cells.text(r, "status"), "infinite-variance");
    for (const char* column : {"bias_se", "variance", "rmse", "rmse_lo", "rmse_hi", "relmse", "kurtosis"})
      EXPECT_THAT(cells.text(r, column), IsEmpty()) << column;
    for (const char* column : {"mean", "reference", "bias", "mae", "median_abs_error"})
      EXPECT_TRUE(std::isfinite(cells.number(r, column))) << column;
    EXPECT_GT(cells.number(r, "mae"), 0);
  }
  ASSERT_EQ(rates.size(), 4u);
  for (std::size_t r = 0; r < rates.size(); ++r) {
    EXPECT_EQ(rates.text(r, "status"), "infinite-variance");
    for (const char* column : {"rate", "rate_lo", "rate_hi", "theory"}) EXPECT_THAT(rates.text(r, column), IsEmpty());
  }
  for (const auto& lines : {outcome.plan.skips, outcome.plan.left_out}) {
    EXPECT_THAT(lines, Contains(HasSubstr("invr: its variance is infinite")));
    EXPECT_THAT(lines, Contains(HasSubstr("invsqrt_heavy: its variance is infinite")));
  }
  EXPECT_EQ(outcome.invalid_cells, 0u);
}

// The first point of Halton's sequence is the origin, where these are infinite: counted, never dropped.
TEST(IntegrandRuns, AnInfiniteValueAtTheOriginIsInvalid) {
  const RunScope scope;
  const RunOutcome outcome = scope.run({{"scene", "invr,invsqrt-heavy,invsqrtprod2"},
                                        {"samplers", "halton"},
                                        {"samples", "16,64"},
                                        {"precision", "f64"}});
  const CsvTable cells = scope.table("convergence.csv"), rates = scope.table("rates.csv");
  ASSERT_EQ(cells.size(), 6u);
  for (std::size_t r = 0; r < 6; ++r) {
    EXPECT_THAT(cells.text(r, "status"), ::testing::StartsWith("invalid;"));
    EXPECT_EQ(cells.text(r, "nonfinite"), "1");
    EXPECT_EQ(cells.text(r, "status").find("infinite-variance") != std::string::npos, r < 4);
    EXPECT_THAT(cells.text(r, "rmse"), IsEmpty());
  }
  EXPECT_EQ(outcome.invalid_cells, 6u);
  EXPECT_EQ(rates.text(0, "status"), "invalid;infinite-variance");
}

// Bounded, but without a limit on faces that the origin lies on: they count as 0 there.
TEST(IntegrandRuns, BoundedIntegrandsAreFiniteAtTheOrigin) {
  const RunScope scope;
  const RunOutcome outcome = scope.run(
      {{"scene", "sininvr,keister_d3"}, {"samplers", "halton"}, {"samples", "1,1024"}, {"precision", "f32,f64"}});
  EXPECT_EQ(outcome.invalid_cells, 0u);
  const CsvTable cells = scope.table("convergence.csv");
  for (std::size_t r = 0; r < cells.size(); ++r) {
    if (cells.text(r, "samples") == "1") {
      EXPECT_EQ(cells.number(r, "mean"), 0);
    }
  }
}

TEST(IntegrandRuns, ListsSayWhatIsKnown) {
  const Ended scenes = run_program({"list", "scenes", "--json"});
  ASSERT_EQ(scenes.code, 0);
  bool infinite = false, finite = false;
  const nlohmann::json listed = nlohmann::json::parse(scenes.out);
  for (const auto& scene : listed.at("scenes")) {
    if (scene.at("name") == "invr") infinite = scene.at("variance") == "infinite";
    if (scene.at("name") == "bilinear") {
      finite = true;
      EXPECT_EQ(scene.at("integral"), 0.25);
      EXPECT_NEAR(scene.at("variance").get<double>(), 7.0 / 144, 1e-16);
    }
    EXPECT_THAT(scene.at("name").get<std::string>(), Not(HasSubstr("_")));
  }
  EXPECT_TRUE(infinite);
  EXPECT_TRUE(finite);
  EXPECT_THAT(run_program({"list", "statuses"}).out, HasSubstr("infinite-variance"));
}

TEST(IntegrandRuns, AFigureSaysWhyALineIsNotThere) {
  const RunScope scope;
  scope.run({{"scene", "invr"}, {"samplers", "independent"}, {"samples", "16:64"}, {"replicates", "16"}});
  const std::string picture = scope.path("x.svg").string();
  const Ended drawn = run_program({"figure", "convergence", "--run", scope.path("out").string(), "--out", picture});
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_THAT(read_file(picture), HasSubstr("infinite-variance"));
}

}  // namespace
}  // namespace halfslope
