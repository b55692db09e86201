#include "experiments/budget.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/experiments/run_files.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Keys = std::map<std::string, std::string>;

TEST(ChooseStages, TakesWhatNarrowsMostForItsTime) {
  const std::vector<StageOffer> offers = {{.pass = 3, .units = 2, .seconds = 4, .narrowing = 0.4},
                                          {.pass = 5, .units = 2, .seconds = 1, .narrowing = 0.2},
                                          {.pass = 7, .units = 2, .seconds = 2, .narrowing = 0.1}};
  EXPECT_THAT(choose_stages(offers, 10, 1), ElementsAre(5));
  EXPECT_THAT(choose_stages(offers, 10, 2), ElementsAre(5));
  EXPECT_THAT(choose_stages(offers, 10, 3), ElementsAre(3, 5));
  EXPECT_THAT(choose_stages(offers, 10, 100), ElementsAre(3, 5, 7));
  EXPECT_THAT(choose_stages({}, 10, 100), IsEmpty());
}

TEST(ChooseStages, TakesNothingThatDoesNotEndInTime) {
  const std::vector<StageOffer> offers = {{.pass = 0, .units = 1, .seconds = 4, .narrowing = 4},
                                          {.pass = 1, .units = 1, .seconds = 2, .narrowing = 0.2},
                                          {.pass = 2, .units = 1, .seconds = 1, .narrowing = 0.01}};
  EXPECT_THAT(choose_stages(offers, 4, 3), ElementsAre(0));
  EXPECT_THAT(choose_stages(offers, 3.5, 3), ElementsAre(1, 2));
  EXPECT_THAT(choose_stages(offers, 6.9, 3), ElementsAre(0, 1));
  EXPECT_THAT(choose_stages(offers, 0.9, 3), IsEmpty());
  EXPECT_THAT(choose_stages(offers, -1, 3), IsEmpty());
}

class Budget : public ::testing::Test {
 protected:
  Keys keys(const char* budget) const {
    return {{"scene", "quarterdisk,ishigami,mis-toy"},
            {"estimators", "mean,balance,bsdf"},
            {"samplers", "independent,halton"},
            {"samples", "16,256"},
            {"precision", "f64"},
            {"replicates", "100000"},
            {"budget", budget}};
  }
  std::vector<std::int64_t> replicates(const char* out) const {
    std::vector<std::int64_t> list;
    const auto manifest = nlohmann::json::parse(read_file(scope_.path(out) / "manifest.json"));
    for (const auto& pass : manifest["passes"]) list.push_back(pass["replicates"]);
    return list;
  }
  std::string journal(const char* out) const { return read_file(scope_.path(out) / "journal"); }

  const RunScope scope_;
};

// Whatever the machine's speed: what is there is whole stages, the first of them everywhere.
TEST_F(Budget, GoesFurtherWithMoreTimeAndStopsForGoodWhenItIsSpent) {
  const RunOutcome some = scope_.run(keys("0.1 s"));
  for (const Pass& pass : some.plan.passes) {
    EXPECT_THAT(pass.stages, ::testing::Contains(pass.replicates));
    EXPECT_GE(pass.replicates, pass.randomised ? 64 : 1);
  }
  const auto few = replicates("out");
  const auto files = run_files(scope_.path("out"));
  const std::string begun = journal("out");
  scope_.run(keys("0.1 s"));
  expect_same_files(files, run_files(scope_.path("out")), "run again");
  EXPECT_EQ(journal("out"), begun);

  scope_.run(keys("1.5 s"));
  const auto more = replicates("out");
  EXPECT_TRUE(journal("out").starts_with(begun));
  bool grown = false;
  for (std::size_t p = 0; p < few.size(); ++p) {
    EXPECT_GE(more[p], few[p]);
    grown |= more[p] > few[p];
  }
  EXPECT_TRUE(grown);
}

// The tables are a function of the experiment and of the replicates that manifest.json names.
TEST_F(Budget, RowsAreThoseOfARunOfAsManyReplicates) {
  Keys one = keys("0.2 s");
  one["scene"] = "quarterdisk";
  one["estimators"] = "mean";
  one["samplers"] = "independent";
  one["replicates"] = "4096";
  const RunOutcome shared = scope_.run(one);
  one["budget"] = "none";
  one["replicates"] = std::to_string(replicates("out")[0]);
  const RunOutcome plain = scope_.run(one, "plain");
  for (std::size_t c = 0; c < plain.results.cells.size(); ++c) {
    EXPECT_EQ(shared.results.cells[c].replicate_mse, plain.results.cells[c].replicate_mse);
    EXPECT_EQ(shared.results.cells[c].statistics.rmse_hi, plain.results.cells[c].statistics.rmse_hi);
  }
}

// A journal that was cut off, amid its rounds or before the first of them was noted, is gone on with: as far as both
// runs went, they have the same errors.
TEST_F(Budget, GoesOnAfterAnInterruption) {
  Keys kept = keys("0.2 s");
  kept["replicates"] = "4096";  // as many as are kept
  const RunOutcome whole = scope_.run(kept, "whole");
  const std::string bytes = journal("whole");
  for (const double share : {0.3, 0.8}) {
    std::filesystem::create_directories(scope_.path("cut"));
    std::ofstream(scope_.path("cut") / "journal", std::ios::binary)
        << bytes.substr(0, static_cast<std::size_t>(static_cast<double>(bytes.size()) * share));
    const RunOutcome outcome = scope_.run(kept, "cut");
    for (std::size_t c = 0; c < outcome.results.cells.size(); ++c) {
      const std::vector<double>&a = whole.results.cells[c].replicate_mse, &b = outcome.results.cells[c].replicate_mse;
      const std::size_t common = std::min(a.size(), b.size());
      EXPECT_GE(common, whole.results.cells[c].facts.deterministic ? 1u : 64u);
      EXPECT_TRUE(std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(common), b.begin()))
          << to_string(whole.results.cells[c].name) << ", " << a.size() << " and " << b.size() << " replicates";
    }
  }
}

}  // namespace
}  // namespace halfslope
