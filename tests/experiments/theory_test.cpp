// Theory checks through the engine: what holds, what is found, and what is left out. Seeds are fixed; over seeds a
// run's verdicts would be wrong with probability 1 %, as they say of themselves.
#include "experiments/theory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "experiments/engine.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// All to the technique with the smallest density.
double worst(const double* ratios, int techniques, int i) {
  const double* least = std::min_element(ratios, ratios + techniques);
  return least == ratios + i ? 1 : 0;
}

Spec toy_spec() {
  Spec spec;
  spec.scenes = {"mis-toy", "quarterdisk"};
  spec.estimators = {
      "light",           "bsdf", "average", "balance", "power", "maximum", "optimal", "mean", "one-sample-balance",
      "one-sample-power"};
  spec.samplers = {"independent", "halton-owen"};
  spec.samples = {{2048}, false};
  spec.replicates = 256;
  spec.precision = {Precision::kF64};
  spec.checks = {"balance-bound", "one-sample-balance", "average-bound", "exact-variance"};
  return spec;
}

RunOutcome run(const Spec& spec, const Catalogue& catalogue, const TemporaryFolder& folder) {
  return run_experiment(spec, catalogue, {folder.path(), 2, true, false});
}

const TheoryRow& row(const TheoryReport& report, const std::string& check, const std::string& estimator) {
  static const TheoryRow kNone;
  for (const TheoryRow& r : report.rows) {
    if (r.check == check && r.cell.estimator == estimator) return r;
  }
  ADD_FAILURE() << "no row " << check << ' ' << estimator;
  return kNone;
}

TEST(Theory, HoldsOnTheToyProblem) {
  const TemporaryFolder folder;
  const RunOutcome outcome = run(toy_spec(), Catalogue::built_in(), folder);
  const TheoryReport& theory = outcome.theory;
  EXPECT_EQ(theory.violated(), 0u);
  // 1024 of each: (1/1024 − 1/2048) μ².
  EXPECT_NEAR(*row(theory, "balance-bound", "power").expected, 0.25 / 2048, 1e-12);
  EXPECT_LT(*row(theory, "balance-bound", "power").measured, 0);  // power is worse than balance here
  EXPECT_EQ(*row(theory, "one-sample-balance", "one-sample-power").expected, 0);
  EXPECT_LT(*row(theory, "one-sample-balance", "one-sample-power").hi, 0);
  // V[average] = (V_light + V_bsdf)/4 with V_bsdf = 0, the bound V_light/2: a difference of −V_light/4, 1024 samples.
  const TheoryRow& average = row(theory, "average-bound", "average");
  EXPECT_LE(*average.lo, -1.0 / 48 / 1024);
  EXPECT_GE(*average.hi, -1.0 / 48 / 1024);
  EXPECT_NEAR(*row(theory, "exact-variance", "balance").expected, 0.011110988148968387 / 1024, 1e-9);
  EXPECT_EQ(row(theory, "exact-variance", "bsdf").verdict, "holds");
  for (const TheoryRow& r : theory.rows) {
    EXPECT_EQ(r.cell.sampler, "independent");
    EXPECT_EQ(r.cell.scene, "mis-toy");
    EXPECT_FALSE(r.check == "balance-bound" && r.cell.estimator == "optimal") << "its weights may be negative";
  }
  EXPECT_THAT(outcome.plan.left_out, Contains(HasSubstr("checks: left out halton-owen")));
  EXPECT_THAT(outcome.plan.left_out, Contains(HasSubstr("checks: left out quarterdisk")));
  EXPECT_THAT(theory_csv(theory), HasSubstr("scene,check,estimator,sampler,precision,samples,measured,measured_lo,"
                                            "measured_hi,bound_or_predicted,verdict\n"));
}

/// Half of balance, with a quarter of its variance: biased, so no theorem is about it.
double half(const double* ratios, int techniques, int i) {
  double sum = 0;
  for (int k = 0; k < techniques; ++k) sum += ratios[k];
  return 0.5 * ratios[i] / sum;
}

TEST(Theory, WhatIsWrongIsFound) {
  const TemporaryFolder folder;
  Catalogue catalogue = Catalogue::built_in();
  catalogue.estimators.add({"worst", "all to the smallest density", "a test"}, worst);
  catalogue.estimators.add({"half", "half of balance", "a test"}, half);
  Spec spec = toy_spec();
  spec.scenes = {"mis-toy"};
  spec.estimators = {"balance", "worst", "half"};
  spec.samplers = {"independent"};
  RunOutcome outcome = run(spec, catalogue, folder);
  EXPECT_EQ(outcome.theory.violated(), 0u);
  EXPECT_NEAR(*row(outcome.theory, "exact-variance", "half").expected,
              *row(outcome.theory, "exact-variance", "balance").expected / 4, 1e-12);
  // Were the measured variance another than it is, by 60 %, 256 replicates tell: their variances err by 9 %.
  for (CellResult& cell : outcome.results.cells) cell.statistics.variance = *cell.statistics.variance * 2.5;
  Reference reference;
  reference.value = {0.5};
  reference.variance = {0};
  reference.mean = 0.5;
  const std::vector<Reference> references = {reference};
  const std::vector<std::string> exact = {"exact-variance"}, bound = {"balance-bound"};
  const TheoryReport off = check_theory(exact, outcome.plan, outcome.results, references);
  EXPECT_EQ(off.violated(), off.rows.size());
  EXPECT_THAT(theory_summary(off, exact), HasSubstr("violated: exact-variance, mis-toy,balance,independent,f64,2048"));
  // And were balance's errors larger than the bound allows.
  for (CellResult& cell : outcome.results.cells) {
    if (cell.name.estimator != "balance") continue;
    for (double& e : cell.replicate_mse) e = e * 50;
  }
  EXPECT_GT(check_theory(bound, outcome.plan, outcome.results, references).violated(), 0u);
}

// A sample variance of 65536 replicates has a standard error of 0.55 %, and six comparisons allow 4 of them, so that 5
// % are missed with probability 1e-6.
TEST(Theory, AVarianceThatIsOffByFivePercentIsFound) {
  const TemporaryFolder folder;
  Spec spec = toy_spec();
  spec.scenes = {"mis-toy"};
  spec.estimators = {"light", "average", "balance", "power", "one-sample-balance", "one-sample-power"};
  spec.samplers = {"independent"};
  spec.samples = {{64}, false};
  spec.replicates = 65536;
  spec.checks = {"exact-variance"};
  RunOutcome outcome = run(spec, Catalogue::built_in(), folder);
  EXPECT_EQ(outcome.theory.rows.size(), 6u);
  EXPECT_EQ(outcome.theory.violated(), 0u);
  for (const double planted : {1.05, 0.95, 0.0}) {
    Results results = outcome.results;
    for (CellResult& cell : results.cells) cell.statistics.variance = *cell.statistics.variance * planted;
    EXPECT_EQ(check_theory(spec.checks, outcome.plan, results, {}).violated(), 6u) << planted;
  }
}

TEST(Theory, AnExactKurtosisSaysWhatIsHeavyTailed) {
  const TemporaryFolder folder;
  Spec spec = toy_spec();
  spec.scenes = {"aligned-phong-cap:n=100,alpha=0.8", "aligned-phong-cap:n=10000,alpha=0.2", "mis-toy"};
  spec.estimators = {"bsdf", "light"};
  spec.samplers = {"independent"};
  spec.samples = {{64}, false};
  spec.replicates = 16;
  spec.checks = {"exact-variance"};
  const RunOutcome outcome = run(spec, Catalogue::built_in(), folder);
  std::vector<std::string> verdicts;
  for (const TheoryRow& r : outcome.theory.rows)
    verdicts.push_back(r.cell.scene + ' ' + r.cell.estimator + ' ' + r.verdict);
  // The bsdf's samples miss the first light one time in 10¹⁶; the lobe is a 200th of the second: K = 3 + 200/64 about.
  EXPECT_THAT(verdicts, ::testing::UnorderedElementsAre("aligned-phong-cap:n=100,alpha=0.8 bsdf heavy-tailed",
                                                        "aligned-phong-cap:n=100,alpha=0.8 light heavy-tailed",
                                                        "aligned-phong-cap:n=10000,alpha=0.2 bsdf holds",
                                                        "aligned-phong-cap:n=10000,alpha=0.2 light heavy-tailed",
                                                        "mis-toy bsdf holds", "mis-toy light holds"));
}

TEST(Theory, WhatCannotBeJudgedSaysWhy) {
  const TemporaryFolder folder;
  Spec spec = toy_spec();
  spec.scenes = {"mis-toy"};
  spec.estimators = {"balance", "power", "optimal"};
  spec.samplers = {"independent"};
  spec.samples = {{64}, false};
  spec.replicates = 15;
  const RunOutcome few = run(spec, Catalogue::built_in(), folder);
  EXPECT_EQ(row(few.theory, "balance-bound", "power").verdict, "few-replicates");
  EXPECT_EQ(few.theory.violated(), 0u);
  const TemporaryFolder other;
  spec.replicates = 5000;
  const RunOutcome many = run(spec, Catalogue::built_in(), other);
  EXPECT_EQ(row(many.theory, "balance-bound", "power").verdict, "many-replicates");
  EXPECT_EQ(row(many.theory, "exact-variance", "power").verdict, "holds");
  EXPECT_EQ(row(many.theory, "exact-variance", "optimal").verdict, "asymptotic");
}

// A finished run is checked without being measured again.
TEST(Theory, ChecksAreNoPartOfWhatIsMeasured) {
  Spec spec = toy_spec();
  const std::string with = canonical_json(spec);
  spec.checks.clear();
  EXPECT_EQ(canonical_json(spec), with);
}

TEST(Theory, NothingToCheckIsNotNothingViolated) {
  const TemporaryFolder folder;
  Spec spec = toy_spec();
  spec.scenes = {"quarterdisk"};
  spec.estimators = {"mean"};
  spec.samplers = {"independent"};
  spec.samples = {{16}, false};
  const RunOutcome outcome = run(spec, Catalogue::built_in(), folder);
  ASSERT_TRUE(outcome.theory.rows.empty());
  const std::string text = theory_summary(outcome.theory, spec.checks);
  EXPECT_THAT(text, HasSubstr("theory: nothing could be checked\n"));
  EXPECT_THAT(text, HasSubstr("exact-variance found nothing to check: it needs a scene whose densities are known"));
  EXPECT_THAT(text, Not(HasSubstr("violated")));
}

TEST(Theory, ProgressiveWeightsAreLeftOutOfSets) {
  Spec spec = toy_spec();
  spec.scenes = {"mis-toy"};
  spec.estimators = {"balance", "optimal-progressive"};
  spec.samplers = {"independent", "stratified"};
  const Plan plan = make_plan(spec, Catalogue::built_in());
  EXPECT_EQ(plan.cells.size(), 3u);
  EXPECT_THAT(plan.left_out, Contains(HasSubstr("it needs a sequence; left out with stratified")));
}

}  // namespace
}  // namespace halfslope
