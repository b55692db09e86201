// measure: its tables, and what it refuses.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/discrepancy.h"
#include "experiments/measures.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/csv_table.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class MeasureCommand : public CommandLine {
 protected:
  Ended measure(const std::vector<std::string>& more) const {
    return command(std::vector<std::string>{"measure", "--quiet"} + more);
  }
  CsvTable table(const std::vector<std::string>& more) const {
    const Ended ended = measure(more);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return CsvTable(ended.out);
  }
  std::string usage(const std::vector<std::string>& more) const {
    const Ended ended = measure(more);
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_THAT(ended.out, IsEmpty());
    return ended.err;
  }
};

TEST_F(MeasureCommand, MeasuresThePointsThatPointsPrints) {
  const CsvTable measured = table({"--sampler", "n-rooks", "--sampler", "halton", "--count", "10,33", "--dims", "3",
                                   "--measures", "l2-star", "--replicates", "2", "--seed", "7"});
  EXPECT_THAT(measured.columns(),
              ElementsAre("sampler", "dims", "count", "replicate", "measure", "value", "lower", "upper", "method"));
  ASSERT_EQ(measured.size(), 6u);  // halton has one replicate
  std::size_t row = 0;
  for (const std::string sampler : {"n-rooks", "halton"}) {
    for (const std::string count : {"10", "33"}) {
      for (const std::string replicate : {"0", "1"}) {
        if (sampler == "halton" && replicate == "1") continue;
        EXPECT_EQ(measured.text(row, "sampler"), sampler);
        EXPECT_EQ(measured.text(row, "dims"), "3");
        EXPECT_EQ(measured.text(row, "count"), count);
        EXPECT_EQ(measured.text(row, "replicate"), replicate);
        EXPECT_EQ(measured.text(row, "measure"), "l2-star");
        const CsvTable points(command({"points", "--sampler", sampler, "--count", count, "--dims", "3", "--replicate",
                                       replicate, "--seed", "7"})
                                  .out);
        std::vector<std::vector<double>> columns(3);
        for (std::size_t i = 0; i < points.size(); ++i) {
          for (std::size_t d = 0; d < 3; ++d) columns[d].push_back(points.number(i, "x" + std::to_string(d)));
        }
        EXPECT_EQ(measured.number(row, "value"), l2_star_discrepancy(PointSet({columns[0], columns[1], columns[2]})));
        ++row;
      }
    }
  }
}

// The summary's mean is that of the rows, and JSON has the table's keys and values.
TEST_F(MeasureCommand, SummaryAndJsonSayWhatTheRowsSay) {
  const std::vector<std::string> what = {"--sampler",  "independent", "--count",      "16",
                                         "--measures", "star",        "--replicates", "20"};
  const CsvTable rows = table(what), summary = table(what + std::vector<std::string>{"--summary"});
  double mean = 0, squares = 0;
  for (std::size_t r = 0; r < 20; ++r) mean += rows.number(r, "value") / 20;
  for (std::size_t r = 0; r < 20; ++r) squares += std::pow(rows.number(r, "value") - mean, 2);
  ASSERT_EQ(summary.size(), 1u);
  EXPECT_EQ(summary.text(0, "replicates"), "20");
  EXPECT_NEAR(summary.number(0, "value"), mean, 1e-14);
  const double half = 2.0930240544082634 * std::sqrt(squares / 19 / 20);  // t with 19 degrees at 97.5 %
  EXPECT_NEAR(summary.number(0, "lower"), mean - half, 1e-12);
  EXPECT_NEAR(summary.number(0, "upper"), mean + half, 1e-12);
  const Ended ended = measure(what + std::vector<std::string>{"--json"});
  const auto json = nlohmann::ordered_json::parse(ended.out);
  ASSERT_EQ(json.size(), 20u);
  for (std::size_t r = 0; r < 20; ++r) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : json[r].items()) keys.push_back(key);
    EXPECT_EQ(keys, rows.columns());
    EXPECT_EQ(json[r]["value"].get<double>(), rows.number(r, "value"));
    EXPECT_EQ(json[r]["replicate"].get<std::size_t>(), r);
  }
}

TEST_F(MeasureCommand, LeavesOutOfARangeWhatItRefusesInAList) {
  const Ended range = command({"measure", "--sampler", "jittered", "--count", "8:64", "--measures", "star"});
  EXPECT_EQ(range.code, 0);
  EXPECT_EQ(CsvTable(range.out).size(), 2u);
  EXPECT_THAT(range.err, HasSubstr("'jittered' cannot make N = 8, 32 points in 2 dimensions: left out"));
  EXPECT_THAT(
      usage({"--sampler", "jittered", "--count", "10"}),
      HasSubstr("--count: sampler 'jittered' cannot make 10 points in 2 dimensions; the nearest legal: 9 and 16"));
  EXPECT_THAT(usage({"--sampler", "independent", "--count", "4194304"}), HasSubstr("at most 1048576 points"));
  EXPECT_THAT(usage({"--sampler", "independent", "--count", "1048576", "--dims", "1000", "--measures", "l2-star"}),
              HasSubstr("would take 8.39 GB in 1000 dimensions"));
}

// Pairs of a file, padded: the pairs are the file's in every replicate, the shuffles are not.
TEST_F(MeasureCommand, PaddedFilesHaveAsManyReplicatesAsAsked) {
  const std::string file = "padded:file:" + write("points.txt", "0.1 0.2\n0.5 0.5\n0.3 0.7\n0.9 0.6\n");
  const CsvTable measured =
      table({"--sampler", file, "--count", "4", "--dims", "4", "--replicates", "8", "--measures", "l2-star"});
  ASSERT_EQ(measured.size(), 8u);
  std::set<std::string> values;
  for (std::size_t r = 0; r < 8; ++r) values.insert(measured.text(r, "value"));
  EXPECT_GT(values.size(), 1u);
  EXPECT_THAT(usage({"--sampler", file}), HasSubstr("--count is missing"));
  EXPECT_EQ(measure({"--sampler", "padded:file:/nonexistent", "--count", "4"}).code, 3);
}

// Of mixed replicates, some of which are bounds, the method says both.
TEST(MeasuredMeans, NameEveryMethod) {
  MeasuresPlan plan;
  plan.points.push_back({"s", {{2}}, false, {{4, {0}, {"star"}}}, 3, {}});
  const Measurements measured = {{1, 1, 1, "exact"}, {2, 2, 6, "bounds"}, {3, 3, 3, "exact"}};
  const auto means = measured_means(plan, measured);
  ASSERT_EQ(means.size(), 1u);
  EXPECT_EQ(means[0].value, 2);
  EXPECT_EQ(means[0].method, "mean, 95 % t interval; each exact or bounds");
  EXPECT_LT(means[0].lower, 2);
  EXPECT_GT(means[0].upper, 10.0 / 3);
}

TEST_F(MeasureCommand, TellsOfPointsThatCoincide) {
  const std::string file = write("points.txt", "0.1 0.2\n0.5 0.5\n0.1 0.2\n");
  const Ended ended = command({"measure", "--points", file, "--measures", "min-distance", "--count", "2,3"});
  EXPECT_EQ(ended.code, 0);
  const CsvTable measured(ended.out);
  EXPECT_NEAR(measured.number(0, "value"), 0.5, 1e-15);
  EXPECT_EQ(measured.text(1, "value"), "0");
  EXPECT_THAT(ended.err, HasSubstr(file + ", N = 3, replicate 0: points coincide"));
  EXPECT_THAT(ended.err, Not(HasSubstr("N = 2")));
}

TEST_F(MeasureCommand, SaysWhatIsWrong) {
  EXPECT_THAT(usage({}), HasSubstr("give --sampler NAME"));
  EXPECT_THAT(usage({"--sampler", "halton"}), HasSubstr("--count is missing"));
  EXPECT_THAT(usage({"--sampler", "haltno", "--count", "4"}), HasSubstr("did you mean 'halton'"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "0"}), HasSubstr("--count: found '0'"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--dims", "0"}), HasSubstr("--dims: at least 1"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--dims", "2000"}), HasSubstr("at most 1024 dimensions"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--measures", "stra"}), HasSubstr("did you mean 'star'"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--measures", "star:x=1"}),
              HasSubstr("it takes no parameters"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--measures", "spectrum:sise=8"}),
              AllOf(HasSubstr("did you mean 'size'"), Not(HasSubstr("star"))));
  for (const char* seed : {"-1", "1.5", "99999999999999999999"}) {
    EXPECT_THAT(usage({"--sampler", "n-rooks", "--count", "4", "--seed", seed}),
                HasSubstr(fmt::format("found '{}'; allowed: an integer from 0 to 2^64 - 1", seed)));
  }
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--measures", "none"}), HasSubstr("nothing to do"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--replicates", "0"}), HasSubstr("from 1 to 4096"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--wrap"}), HasSubstr("--points"));
  EXPECT_THAT(usage({"--sampler", "halton", "--count", "4", "--exr", (folder_ / "x.exr").string()}),
              HasSubstr("--exr: an image is of one spectrum"));
}

}  // namespace
}  // namespace halfslope
