// Runs that stop themselves: each pass takes as many replicates as its cells need, and its numbers are those of a run
// that was asked for so many.
#include "experiments/stages.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/status.h"
#include "analysis/stopping.h"
#include "core/error.h"
#include "tests/experiments/run_files.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Keys = std::map<std::string, std::string>;

Keys with(Keys keys, const Keys& others) {
  for (const auto& [key, value] : others) keys[key] = value;
  return keys;
}

/// Passes that stop at different stages: easy, less easy, heavy-tailed, deterministic, exact, without variance.
const Keys kTarget = {{"scene", "quarterdisk,mis-toy,invsqrtprod2,invr"},
                      {"samplers", "independent,halton-owen,n-rooks,halton"},
                      {"samples", "4,16"},
                      {"precision", "f64"},
                      {"replicates", "1024"},
                      {"target", "rmse ±15%"}};

TEST(Stages, UnitsAreThoseOfTheStagesInOrder) {
  for (const char* stopping : {"target", "budget"}) {
    for (const auto& [samples, replicates] : {std::pair("4:16", "200"), {"16384", "300"}, {"2", "9000"}}) {
      const Plan plan = make_plan(spec_of({{"scene", "veach-mis,mis-toy"},
                                           {"resolution", "30,20"},
                                           {"samplers", "independent,n-rooks,halton"},
                                           {"samples", samples},
                                           {"replicates", replicates},
                                           {stopping, stopping == std::string("target") ? "rmse 5%" : "1 s"}}),
                                  Catalogue::built_in());
      for (std::size_t p = 0; p < plan.passes.size(); ++p) {
        const Pass& pass = plan.passes[p];
        const std::int64_t most = pass.randomised ? std::stoll(replicates) : 1;
        EXPECT_EQ(pass.stages, replicate_schedule(most, stopping == std::string("target") ? 1 : 4));
        std::int64_t begin = 0;
        std::uint64_t next = pass.first_unit;
        for (const std::int64_t end : pass.stages) {
          double replicate_pixels = 0;
          for (const std::uint64_t u : units_between(pass, begin, end)) {
            EXPECT_EQ(u, next++);
            EXPECT_EQ(plan.units[u].pass, p);
            EXPECT_GE(plan.units[u].first_replicate, begin);
            EXPECT_LE(plan.units[u].first_replicate + plan.units[u].replicate_count, end);
            replicate_pixels +=
                static_cast<double>(plan.units[u].replicate_count) * static_cast<double>(plan.units[u].pixel_count);
          }
          EXPECT_EQ(replicate_pixels * static_cast<double>(pass.evaluations()), plan.evaluations(pass, end - begin));
          begin = end;
        }
      }
    }
  }
}

// At the stage where a pass stopped no cell of it is open; one stage before, some cell was.
TEST(Stages, APassStopsAtTheFirstStageWhereNoCellIsOpen) {
  const RunScope scope;
  const RunOutcome outcome = scope.run(kTarget, "target");
  std::map<std::int64_t, RunOutcome> plain;  // runs of as many replicates, without a target
  const auto cells_of = [&](std::size_t p, std::int64_t replicates) {
    if (!plain.contains(replicates)) {
      const std::string folder = "plain" + std::to_string(replicates);
      plain[replicates] =
          scope.run(with(kTarget, {{"target", "none"}, {"replicates", std::to_string(replicates)}}), folder.c_str());
    }
    std::vector<CellResult> cells;
    for (std::size_t c = 0; c < outcome.plan.cells.size(); ++c) {
      if (outcome.plan.cells[c].pass == p) cells.push_back(plain[replicates].results.cells[c]);
    }
    return cells;
  };
  const auto open = [](const CellResult& cell) { return target_state(cell.statistics, 0.15) == TargetState::kOpen; };
  std::set<std::int64_t> taken;
  for (std::size_t p = 0; p < outcome.plan.passes.size(); ++p) {
    const Pass& pass = outcome.plan.passes[p];
    taken.insert(pass.replicates);
    const auto stage = std::ranges::find(pass.stages, pass.replicates);
    ASSERT_NE(stage, pass.stages.end());
    if (pass.replicates < 1024) {
      EXPECT_TRUE(std::ranges::none_of(cells_of(p, pass.replicates), open));
    }
    if (stage != pass.stages.begin()) {
      EXPECT_TRUE(std::ranges::any_of(cells_of(p, *(stage - 1)), open));
    }
  }
  EXPECT_TRUE(taken.contains(1));   // deterministic
  EXPECT_TRUE(taken.contains(64));  // nothing to narrow
  EXPECT_GE(taken.size(), 4u);      // and the others where they are needed
  for (std::size_t c = 0; c < outcome.plan.cells.size(); ++c) {
    // Every replicate's error and so the rmse with its interval are the plain run's, bit by bit.
    const CellResult& cell = outcome.results.cells[c];
    const std::int64_t replicates = outcome.plan.passes[outcome.plan.cells[c].pass].replicates;
    if (replicates == 1) continue;
    const CellResult& same = plain.contains(replicates) ? plain[replicates].results.cells[c] : cell;
    EXPECT_EQ(cell.replicates, replicates);
    EXPECT_EQ(cell.replicate_mse, same.replicate_mse);
    EXPECT_EQ(cell.statistics.rmse, same.statistics.rmse);
    EXPECT_EQ(cell.statistics.rmse_lo, same.statistics.rmse_lo);
    EXPECT_EQ(cell.statistics.rmse_hi, same.statistics.rmse_hi);
  }
}

// The interval of invsqrtprod2, whose squared errors have a kurtosis near 10, is within ±60 % long before 40 K = 400
// replicates; a Gaussian cell with it stops at once.
TEST(Stages, AHeavyTailedCellDoesNotStopEarly) {
  const RunScope scope;
  const Keys keys = {{"scene", "invsqrtprod2,quarterdisk"}, {"samplers", "independent"}, {"samples", "4"}};
  const RunOutcome outcome = scope.run(with(keys, {{"target", "rmse 60%"}}));
  EXPECT_EQ(outcome.plan.passes[1].replicates, 64);
  const std::int64_t stopped = outcome.plan.passes[0].replicates;
  ASSERT_GT(stopped, 64);
  const auto fixed = scope.run(with(keys, {{"replicates", std::to_string(stopped / 2)}}), "fixed");
  const CellStatistics& before = fixed.results.cells[0].statistics;
  EXPECT_TRUE(has_mark(before.status, "heavy-tailed"));
  EXPECT_LT(*log_half_width(before), std::log(1.6));
  EXPECT_FALSE(has_mark(outcome.results.cells[0].statistics.status, "heavy-tailed"));
}

TEST(Stages, CellsThatDoNotGetThereAreMarked) {
  const RunScope scope;
  scope.run({{"scene", "quarterdisk,mis-toy"},
             {"estimators", "mean,bsdf"},
             {"samplers", "independent,halton"},
             {"samples", "4"},
             {"replicates", "128"},
             {"target", "rmse ±2%"}});
  const CsvTable cells = scope.table("convergence.csv");
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells.text(0, "status"), "target-missed");
  EXPECT_EQ(cells.number(0, "replicates"), 128);
  EXPECT_EQ(cells.text(1, "status"), "deterministic");
  EXPECT_EQ(cells.number(1, "replicates"), 1);
  EXPECT_EQ(cells.text(2, "status"), "exact");  // the technique of the toy's integrand itself
  EXPECT_EQ(cells.number(2, "replicates"), 64);
  const RunOutcome few = scope.run({{"scene", "quarterdisk"},
                                    {"samplers", "independent"},
                                    {"samples", "4"},
                                    {"replicates", "8"},
                                    {"target", "rmse ±50%"}},
                                   "few");
  EXPECT_EQ(few.results.cells[0].statistics.status, "few-replicates;target-missed");
}

// "Every cell knows its rmse" where every cell does, and else who does, who has nothing to know and why, and who
// missed.
TEST(Stages, TheReportCountsWhatBecameOfTheCells) {
  const RunScope scope;
  int runs = 0;
  const auto report = [&](const Keys& keys) {
    const std::string folder = "run" + std::to_string(++runs);
    const RunOutcome outcome = scope.run(keys, folder.c_str());
    return report_stopping(spec_of(keys), outcome.plan, outcome.results);
  };
  const Keys disk = {{"scene", "quarterdisk"}, {"samplers", "independent"}, {"samples", "4"}, {"target", "rmse ±40%"}};
  EXPECT_THAT(report(disk), HasSubstr("run: 64 replicates a pass, 256 samples; every cell knows its rmse ±40%\n"));
  // halton begins at 0, where 1/r is infinite.
  EXPECT_THAT(report(with(disk, {{"scene", "quarterdisk,invr,mis-toy"},
                                 {"estimators", "mean,bsdf"},
                                 {"samplers", "independent,halton"}})),
              HasSubstr("; 1 of 6 cells knows its rmse ±40%; 5 have no interval to narrow (1 invalid, 1 "
                        "infinite-variance, 2 exact, 1 deterministic)\n"));
  EXPECT_THAT(report(with(disk, {{"target", "rmse 1%"}, {"replicates", "64"}})),
              HasSubstr("; 0 of 1 cells know their rmse ±1%; 1 missed it\n"));
  EXPECT_THAT(report(with(disk, {{"scene", "invr"}})),
              HasSubstr("; 0 of 1 cells know their rmse ±40%; 1 has no interval to narrow (1 infinite-variance)\n"));
}

// One replicate has no interval, so it does not tell the target, unless the sampler has no more of them.
TEST(Stages, OneReplicateOfARandomisedSamplerMissesTheTarget) {
  const RunScope scope;
  const Keys keys = {{"scene", "quarterdisk"},
                     {"samplers", "independent,halton"},
                     {"samples", "4"},
                     {"target", "rmse ±40%"},
                     {"replicates", "1"}};
  const RunOutcome outcome = scope.run(keys);
  EXPECT_EQ(outcome.results.cells[0].statistics.status, "deterministic;target-missed");
  EXPECT_EQ(outcome.results.cells[1].statistics.status, "deterministic");
  EXPECT_THAT(report_stopping(spec_of(keys), outcome.plan, outcome.results),
              HasSubstr(": 1 replicate a pass, 8 samples; 0 of 2 cells know their rmse ±40%; 1 has no interval to "
                        "narrow (1 deterministic); 1 missed it\n"));
}

std::string journal_of(const RunScope& scope, const char* out) { return read_file(scope.path(out) / "journal"); }

// Bytes are a function of the experiment: whatever the threads, wherever it was cut off, whatever target was there
// before.
TEST(Stages, BytesDependOnTheExperimentAlone) {
  const RunScope scope;
  const Keys keys = with(kTarget, {{"scene", "mis-toy,veach-mis"},
                                   {"resolution", "12,8"},
                                   {"samplers", "independent,n-rooks"},
                                   {"estimators", "balance,bsdf"},
                                   {"images", "16"},
                                   {"replicates", "256"}});
  const auto run = [&](const char* out, int threads, const Keys& more = {}) {
    run_experiment(spec_of(with(keys, more)), Catalogue::built_in(),
                   {.out = scope.path(out), .threads = threads, .quiet = true});
    return run_files(scope.path(out));
  };
  const auto whole = run("whole", 1);
  EXPECT_EQ(whole.size(), 7u + 1 + 8);  // tables, the reference, a picture of each cell at N = 16
  expect_same_files(whole, run("threads", 3), "3 threads");
  const std::string journal = journal_of(scope, "whole");
  for (const double share : {0.2, 0.5, 0.9}) {
    std::filesystem::create_directories(scope.path("cut"));
    std::ofstream(scope.path("cut") / "journal", std::ios::binary)
        << journal.substr(0, static_cast<std::size_t>(static_cast<double>(journal.size()) * share));
    expect_same_files(whole, run("cut", 2), "cut off at " + std::to_string(share));
  }
  expect_same_files(whole, run("whole", 2), "run again");
  EXPECT_EQ(journal_of(scope, "whole"), journal);

  // A blunter target first, then this one, then the blunter again.
  const auto blunt = run("other", 2, {{"target", "rmse ±40%"}});
  EXPECT_NE(blunt.at("convergence.csv"), whole.at("convergence.csv"));
  const std::string begun = journal_of(scope, "other");
  expect_same_files(whole, run("other", 2), "after a blunter target");
  EXPECT_TRUE(journal_of(scope, "other").starts_with(begun));
  expect_same_files(blunt, run("other", 2, {{"target", "rmse ±40%"}}), "the blunter target again");
  EXPECT_THROW(run("other", 2, {{"replicates", "512"}}), Error);
  EXPECT_THROW(run("other", 2, {{"target", "none"}, {"budget", "1 h"}}), Error);
}

TEST(Stages, ThePlanShowsTheEstimate) {
  const Keys keys = {{"scene", "quarterdisk"}, {"samplers", "independent,halton"}, {"samples", "4"}};
  const auto described = [&](const Keys& more) {
    const Spec spec = spec_of(with(keys, more));
    const Catalogue catalogue = Catalogue::built_in();
    return describe_plan(spec, make_plan(spec, catalogue), catalogue);
  };
  const std::string five = described({{"target", "rmse ±5%"}});
  EXPECT_THAT(five, HasSubstr("in at most 8 units of work, 260 to 1.64e+04 integrand evaluations\n"));
  EXPECT_THAT(five, HasSubstr("replicates: 64, 128, 256, …, 4096, until every cell of a pass knows its rmse ±5%; one "
                              "integral with Gaussian errors needs 807, so 1024, "));
  EXPECT_THAT(five, HasSubstr("1 pixel x 64 to 4096 replicates"));
  EXPECT_THAT(five, HasSubstr("1 pixel x 1 replicate,"));
  EXPECT_THAT(described({{"target", "rmse ±1%"}}), HasSubstr("more with --replicates 32768"));
  EXPECT_THAT(described({{"budget", "1 min"}}), HasSubstr("replicates: 64, 128, 192, …, 4096, as far as 60 s of work"));
  EXPECT_THAT(described({}), ::testing::Not(HasSubstr("replicates: ")));
}

TEST(Stages, TheManifestSaysHowManyReplicatesThereAre) {
  const RunScope scope;
  const RunOutcome outcome = scope.run(kTarget);
  const auto manifest = nlohmann::json::parse(read_file(scope.path("out") / "manifest.json"));
  EXPECT_EQ(manifest["spec"]["target"], "rmse ±15%");
  ASSERT_EQ(manifest["passes"].size(), outcome.plan.passes.size());
  double evaluations = 0;
  for (std::size_t p = 0; p < outcome.plan.passes.size(); ++p) {
    EXPECT_EQ(manifest["passes"][p]["replicates"], outcome.plan.passes[p].replicates);
    evaluations += manifest["passes"][p]["evaluations"].get<double>();
  }
  EXPECT_EQ(manifest["evaluations"], evaluations);
  EXPECT_LT(evaluations, make_plan(spec_of(kTarget), Catalogue::built_in()).evaluations());
}

}  // namespace
}  // namespace halfslope
