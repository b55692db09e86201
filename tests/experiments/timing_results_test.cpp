// What made-up times and errors lead to: efficiencies, equal time, equal error, and what the summary says of them.
#include "experiments/timing_results.h"

#include <gmock/gmock.h>

#include <cmath>

#include "experiments/timing_tables.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Cells of one line with made-up errors N^slope within a factor e^0.1 and times of `ns` a sample, the same each time.
void add_line(Results& results, std::vector<CellTimes>& times, const std::string& sampler, double slope, double ns,
              const std::vector<std::uint64_t>& samples) {
  for (const std::uint64_t n : samples) {
    CellResult cell;
    cell.name = {"toy", "mean", sampler, "f64", n};
    const double rmse = std::pow(static_cast<double>(n), slope);
    cell.statistics.rmse = rmse;
    cell.statistics.rmse_lo = rmse * std::exp(-0.1);
    cell.statistics.rmse_hi = rmse * std::exp(0.1);
    cell.statistics.status = "ok";
    results.cells.push_back(cell);
    times.push_back({std::vector<TimedRun>(15, {ns / 4, ns, ns}), 1, 16});
  }
}

struct MadeUp {
  Results results;
  std::vector<TimingResult> rows;
  // "slow" takes four times as long a sample as "plain" for the rate −1; "short" stops at N = 16.
  MadeUp() {
    std::vector<CellTimes> times;
    add_line(results, times, "plain", -0.5, 10, {4, 16, 64});
    add_line(results, times, "slow", -1, 40, {4, 16, 64});
    add_line(results, times, "short", -0.5, 10.001, {4, 16});
    rows = timing_results(results, times);
  }
};

TEST(TimingResults, TimesAndEfficienciesAreThoseOfTheCells) {
  const MadeUp made;
  ASSERT_EQ(made.rows.size(), 8u);
  const TimingResult& row = made.rows[5];  // slow, N = 64
  EXPECT_EQ(row.all.median, 40);
  EXPECT_EQ(row.points.median, 10);
  EXPECT_EQ(row.evaluation.median, 30);
  EXPECT_DOUBLE_EQ(row.seconds().value, 64 * 40e-9);
  EXPECT_NEAR(row.efficiency->value, 64 * 64 / (64 * 40e-9), 1e-3);
  EXPECT_EQ(row.status, "ok");
}

// The fastest line with N = 64 takes 640 ns. "slow" affords N = 16 in that time, and "short" has none so large.
TEST(TimingResults, EqualTimeIsThatOfTheFastestAtTheLargestN) {
  const MadeUp made;
  const std::vector<EqualWork> table = equal_times(made.rows);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_DOUBLE_EQ(table[0].at, 640e-9);
  ASSERT_EQ(table[0].lines.size(), 3u);
  EXPECT_NEAR(table[0].lines[0].answer.value.value, 1.0 / 8, 1e-12);
  EXPECT_NEAR(table[0].lines[1].answer.value.value, 1.0 / 16, 1e-12);
  EXPECT_NEAR(table[0].lines[1].answer.samples, 16, 1e-9);
  EXPECT_EQ(table[0].lines[2].answer.reach, Reach::kBeyond);
  EXPECT_DOUBLE_EQ(table[1].at, 160e-9);
  EXPECT_NEAR(table[1].lines[1].answer.value.value, 0.25, 1e-12);  // N = 4, its smallest
  EXPECT_EQ(table[2].lines[1].answer.reach, Reach::kBelow);
  EXPECT_THAT(equal_time_csv(made.rows), AllOf(HasSubstr("above-range"), HasSubstr("below-range"), HasSubstr(",ok\n")));
}

// Of the errors 1/8 and 1/16 after that time the median is the smaller; plain N^−½ does not get there.
TEST(TimingResults, EqualErrorIsTheMedianAfterThatTime) {
  const MadeUp made;
  const std::vector<EqualWork> table = equal_errors(made.rows);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_NEAR(table[0].at, 1.0 / 16, 1e-12);
  EXPECT_EQ(table[0].lines[0].answer.reach, Reach::kBeyond);
  EXPECT_NEAR(table[0].lines[1].answer.value.value, 640e-9, 1e-18);
  EXPECT_NEAR(table[1].lines[0].answer.value.value, 640e-9, 1e-15);
  EXPECT_NEAR(table[1].lines[1].answer.value.value, 320e-9, 1e-15);
}

TEST(TimingResults, MarksOfTheCellsAreKept) {
  MadeUp made;
  std::vector<CellTimes> times(made.results.cells.size(), {std::vector<TimedRun>(3, {1, 2, 2}), 1, 16});
  made.results.cells[0].statistics.status = "heavy-tailed";
  made.results.cells[1].statistics.rmse = 0;
  times[2].runs.clear();
  const auto rows = timing_results(made.results, times);
  ASSERT_EQ(rows.size(), 7u);  // without the one that was not timed
  EXPECT_EQ(rows[0].status, "heavy-tailed;few-repetitions");
  EXPECT_FALSE(rows[0].certified);
  EXPECT_FALSE(rows[1].efficiency);  // an error of 0 has none
}

// At an end of a line the numbers are its own: what the fastest has reached after t takes it t and its largest N, and
// rounding loses no row.
TEST(TimingResults, TheFirstErrorIsWhatItsLineHasReached) {
  for (int seed = 0; seed < 50; ++seed) {
    Results results;
    std::vector<CellTimes> times;
    add_line(results, times, "plain", -0.5 - 0.001 * seed, 1.93 + 0.0137 * seed, {16, 32, 64});
    const auto rows = timing_results(results, times);
    const std::vector<EqualWork> errors = equal_times(rows), reached = equal_errors(rows);
    ASSERT_FALSE(errors.empty() || reached.empty());
    EXPECT_EQ(reached[0].at, results.cells[2].statistics.rmse);
    for (const LineAnswer& line : {errors[0].lines[0], reached[0].lines[0]}) {
      EXPECT_EQ(line.status(), "ok");
      EXPECT_EQ(line.answer.samples, 64);
    }
    EXPECT_EQ(reached[0].lines[0].answer.value.value, rows[2].seconds().value);
    EXPECT_EQ(errors[0].lines[0].answer.value.value, results.cells[2].statistics.rmse);
  }
}

/// The error that the summary says times are to.
std::string labelled_error(const std::vector<TimingResult>& rows) {
  const std::string text = timing_summary(rows), before = "time to an rmse of ";
  const auto from = text.find(before) + before.size();
  return text.substr(from, text.find(',', from) - from);
}

// Of the lines that t cuts the median one may err more at its end than after t, and then it never gets there for good.
TEST(TimingSummary, NamesTheErrorAfterThatTimeEvenWhereNoneAnswers) {
  Results results;
  std::vector<CellTimes> times;
  add_line(results, times, "slow", -0.5, 40, {4, 16, 64});
  add_line(results, times, "plain", -0.5, 10, {4, 16, 64});
  for (std::size_t k = 0; k < 6; ++k) results.cells[k].statistics.rmse = k % 3 == 2 ? 0.5 : k < 3 ? 0.1 : 0.3;
  const auto rows = timing_results(results, times);  // after 640 ns they err 0.1 (slow, N = 16) and 0.5
  const std::vector<EqualWork> table = equal_errors(rows);
  ASSERT_EQ(table.front().at, 0.1);
  for (const LineAnswer& line : table.front().lines) EXPECT_EQ(line.answer.reach, Reach::kBeyond);
  EXPECT_EQ(labelled_error(rows), "0.1");
  EXPECT_EQ(labelled_error(MadeUp().rows), "0.0625");
}

// The perfect estimator is there at once; of one without any error that is known nothing is said.
TEST(TimingResults, NoErrorIsExactAndNotOutOfRange) {
  Results results;
  std::vector<CellTimes> times;
  add_line(results, times, "plain", -0.5, 10, {4, 16, 64});
  add_line(results, times, "perfect", -0.5, 20, {4, 16, 64});
  add_line(results, times, "unknown", -0.5, 5, {4, 16, 64});
  for (std::size_t k = 3; k < 9; ++k) {
    CellStatistics& s = results.cells[k].statistics;
    s.rmse = k < 6 ? std::optional(0.0) : std::nullopt;
    s.rmse_lo.reset(), s.rmse_hi.reset();
    s.status = k < 6 ? "exact" : "infinite-variance";
  }
  const auto rows = timing_results(results, times);
  for (const auto& table : {equal_times(rows), equal_errors(rows)}) {
    ASSERT_FALSE(table.empty());
    EXPECT_EQ(table[0].lines[0].status(), "ok");
    EXPECT_EQ(table[0].lines[1].status(), "exact");
    EXPECT_EQ(table[0].lines[2].status(), "no-rmse");
  }
  EXPECT_EQ(equal_times(rows)[0].at, rows[2].seconds().value);  // of those that err
  EXPECT_THAT(equal_error_csv(rows), AllOf(HasSubstr(",,,,,exact\n"), Not(HasSubstr("above-range"))));
  const std::string text = timing_summary(rows);
  EXPECT_THAT(text, Not(HasSubstr("above-range")));
  EXPECT_LT(text.find("perfect"), text.find("plain"));  // ranked first
}

// Of three timings the range covers three of four, whatever is made of it.
TEST(TimingResults, IntervalsOfFewRepetitionsAreMarkedWhereverTheyGo) {
  MadeUp made;
  for (const auto& [repetitions, few] : {std::pair(5, true), {6, false}}) {
    const std::vector<TimedRun> runs(static_cast<std::size_t>(repetitions), {1, 2, 2});
    std::vector<CellTimes> times(made.results.cells.size(), {runs, 1, 16});
    made.results.cells[0].statistics.status = "heavy-tailed";
    const auto rows = timing_results(made.results, times);
    for (const auto& table : {equal_times(rows), equal_errors(rows)}) {
      for (const EqualWork& work : table) {
        for (const LineAnswer& line : work.lines) {
          EXPECT_EQ(line.status().find("few-repetitions") != std::string::npos,
                    few && line.answer.reach == Reach::kInside);
        }
      }
    }
    EXPECT_EQ(equal_time_csv(rows).find("uncertified;few-repetitions") != std::string::npos, few);
    const std::string text = timing_summary(rows);
    EXPECT_EQ(text.find("~[") != std::string::npos, few);
    EXPECT_EQ(text.find("6 are enough") != std::string::npos, few);
  }
}

TEST(TimingSummary, RanksNothingInsideTheNoise) {
  Results results;
  std::vector<CellTimes> times;
  add_line(results, times, "alike", -0.5, 10, {64});
  add_line(results, times, "also", -0.5, 10.5, {64});
  add_line(results, times, "far", -0.5, 100, {64});
  const std::string text = timing_summary(timing_results(results, times));
  EXPECT_THAT(text, AllOf(HasSubstr("1-2"), HasSubstr("cannot be told apart"), Not(HasSubstr("2-3"))));
  EXPECT_THAT(timing_summary({}), IsEmpty());
}

}  // namespace
}  // namespace halfslope
