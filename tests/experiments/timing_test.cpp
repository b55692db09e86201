// Timings of a run. No test here depends on how long anything takes: what is asserted is what was timed, and how the
// tables hang together.
#include "experiments/timing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "experiments/interrupt.h"
#include "experiments/tables.h"
#include "experiments/timing_tables.h"
#include "tests/experiments/run_files.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::map<std::string, std::string> kToy = {{"scene", "mis-toy"},
                                                 {"estimators", "light,balance"},
                                                 {"samplers", "independent,n-rooks"},
                                                 {"samples", "4,16"},
                                                 {"replicates", "20"},
                                                 {"timing", "3"}};

std::map<std::string, std::string> toy_with(const std::string& key, const std::string& value) {
  auto keys = kToy;
  keys[key] = value;
  return keys;
}

std::string header(const std::string& text) { return text.substr(0, text.find('\n')); }

TEST(Timing, TablesHaveTheColumnsThatAreDocumented) {
  EXPECT_EQ(header(timing_csv({})),
            "scene,estimator,sampler,precision,samples,ns_per_sample,ns_lo,ns_hi,efficiency,efficiency_lo,"
            "efficiency_hi");
  EXPECT_EQ(header(timing_parts_csv({})),
            "scene,estimator,sampler,precision,samples,points_ns,points_ns_lo,points_ns_hi,evaluation_ns,"
            "evaluation_ns_lo,evaluation_ns_hi,coverage,repetitions,pixels,estimates,status");
  EXPECT_EQ(header(equal_time_csv({})),
            "scene,estimator,sampler,precision,seconds,samples,rmse,rmse_lo,rmse_hi,status");
  EXPECT_EQ(header(equal_error_csv({})),
            "scene,estimator,sampler,precision,rmse,samples,seconds,seconds_lo,seconds_hi,status");
}

TEST(Timing, EveryCellHasARowWhoseNumbersHangTogether) {
  const RunScope scope;
  scope.run(kToy);
  const CsvTable cells = scope.table("convergence.csv"), times = scope.table("timing.csv"),
                 parts = scope.table("timing_parts.csv");
  ASSERT_EQ(times.size(), cells.size());
  ASSERT_EQ(parts.size(), cells.size());
  for (std::size_t r = 0; r < cells.size(); ++r) {
    for (const char* column : {"scene", "estimator", "sampler", "precision", "samples"}) {
      EXPECT_EQ(times.text(r, column), cells.text(r, column));
      EXPECT_EQ(parts.text(r, column), cells.text(r, column));
    }
    const double ns = times.number(r, "ns_per_sample"), n = times.number(r, "samples"), rmse = cells.number(r, "rmse");
    EXPECT_GT(ns, 0);
    EXPECT_LE(times.number(r, "ns_lo"), ns);
    EXPECT_GE(times.number(r, "ns_hi"), ns);
    const double efficiency = times.number(r, "efficiency");
    EXPECT_NEAR(efficiency * rmse * rmse * n * ns * 1e-9, 1, 1e-12);
    EXPECT_LE(times.number(r, "efficiency_lo"), efficiency);
    EXPECT_GE(times.number(r, "efficiency_hi"), efficiency);
    EXPECT_GT(parts.number(r, "points_ns"), 0);
    EXPECT_EQ(parts.number(r, "repetitions"), 3);
    EXPECT_EQ(parts.number(r, "coverage"), 0.75);  // of the range of three
    EXPECT_EQ(parts.number(r, "pixels"), 1);
    EXPECT_EQ(std::fmod(parts.number(r, "estimates"), 16), 0);
    EXPECT_THAT(parts.text(r, "status"), HasSubstr("few-repetitions"));
  }
}

TEST(Timing, GoogleBenchmarksToolsFindTheirFields) {
  const RunScope scope;
  scope.run(kToy);
  const auto json = nlohmann::json::parse(read_file(scope.path("out/timing.json")));
  // RFC 3339, as Google Benchmark writes it.
  EXPECT_THAT(json.at("context").at("date").get<std::string>(),
              ::testing::MatchesRegex("....-..-..T..:..:..[+-]..:.."));
  const auto& entries = json.at("benchmarks");
  ASSERT_EQ(entries.size(), 8u * 3);
  std::map<std::string, std::set<int>> repetitions;
  for (const auto& entry : entries) {
    EXPECT_EQ(entry.at("name"), entry.at("run_name"));
    EXPECT_EQ(entry.at("run_type"), "iteration");
    EXPECT_EQ(entry.at("time_unit"), "ns");
    EXPECT_EQ(entry.at("threads"), 1);
    EXPECT_EQ(entry.at("repetitions"), 3);
    EXPECT_GT(entry.at("iterations"), 0);
    EXPECT_GT(entry.at("real_time"), 0.0);
    // An iteration is an estimate, so its time is N times that of a sample.
    const double n =
        std::stod(entry.at("name").get<std::string>().substr(entry.at("name").get<std::string>().rfind('/') + 1));
    const double cpu = entry.at("cpu_time"), rmse = entry.at("rmse");
    EXPECT_NEAR(cpu, n * entry.at("ns_per_sample").get<double>(), 1e-9 * cpu);
    EXPECT_NEAR(entry.at("efficiency").get<double>() * rmse * rmse * cpu * 1e-9, 1, 1e-9);
    EXPECT_TRUE(repetitions[entry.at("name")].insert(entry.at("repetition_index").get<int>()).second);
  }
  EXPECT_EQ(repetitions.size(), 8u);
  EXPECT_THAT(repetitions.at("mis-toy/balance/n-rooks/f32/16"), ElementsAre(0, 1, 2));
}

// What is measured does not depend on whether it is timed as well, and what an earlier run timed does not pass for this
// one's.
TEST(Timing, LeavesTheOtherTablesAsTheyAre) {
  const RunScope scope;
  scope.run(kToy);
  const auto with = run_files(scope.path("out"));
  scope.run(toy_with("timing", "none"));
  auto without = run_files(scope.path("out"));
  for (const char* name : kTimingFiles) {
    EXPECT_FALSE(std::filesystem::exists(scope.path("out") / name)) << name;
    if (const auto found = with.find(name); found != with.end()) without.insert(*found);
  }
  expect_same_files(with, without, "timed and not");
}

TEST(Timing, OfPixelsThatAreKnownThereIsNone) {
  const Spec spec = spec_of({{"scene", "veach-mis"},
                             {"resolution", "12,8"},
                             {"estimators", "light"},
                             {"samplers", "independent"},
                             {"samples", "4"}});
  Plan plan = make_plan(spec, Catalogue::built_in());
  std::vector<int> known, sampled;
  for (const int pixel : plan.scenes[0].pixels)
    (plan.scenes[0].source->pixel(pixel).integral ? sampled : known).push_back(pixel);
  ASSERT_FALSE(sampled.empty() || known.empty());
  const auto times = [&](const std::vector<int>& pixels) {
    plan.scenes[0].pixels = pixels;
    return time_cells(plan, Catalogue::built_in().samplers, 3, "", true).at(0);
  };
  EXPECT_EQ(times(sampled).pixels, 32);  // the most that there are
  EXPECT_EQ(times(sampled).runs.size(), 3u);
  EXPECT_THAT(times(known).runs, IsEmpty());
  known.insert(known.begin(), sampled.begin(), sampled.begin() + 3);
  EXPECT_EQ(times(known).pixels, 3);
}

TEST(Timing, StopsWhereASignalComes) {
  const InterruptGuard guard;
  ::raise(SIGINT);
  const Plan plan = make_plan(spec_of(kToy), Catalogue::built_in());
  try {
    time_cells(plan, Catalogue::built_in().samplers, 3, "", true);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kInterrupted);
  }
}

TEST(Timing, ThePlanTellsHowManyAndAboutHowLong) {
  const Plan plan = make_plan(spec_of(kToy), Catalogue::built_in());
  EXPECT_THAT(describe_timing(plan, 15), HasSubstr("timed: 8 cells x 15 repetitions in turns on one thread, about "));
  EXPECT_THAT(describe_timing(plan, 0), IsEmpty());
}

}  // namespace
}  // namespace halfslope
