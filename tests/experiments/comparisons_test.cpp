#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <sstream>

#include "experiments/results.h"
#include "experiments/tables.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t kReplicates = 200;

/// A cell whose replicates' squared errors are those of normal numbers times `mse`.
CellResult cell_of(const std::string& estimator, const std::string& sampler, double mse, std::uint64_t seed,
                   std::uint64_t samples = 64) {
  CellResult cell;
  cell.name = {"scene", estimator, sampler, "f64", samples};
  cell.replicates = kReplicates;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (std::size_t r = 0; r < kReplicates; ++r) {
    cell.replicate_mse.push_back(mse * std::pow(normal(random), 2));
    cell.mse += cell.replicate_mse.back() / kReplicates;
  }
  cell.statistics.status = "ok";
  return cell;
}

CellResult deterministic(const std::string& estimator, const std::string& sampler) {
  CellResult cell = cell_of(estimator, sampler, 1, 1);
  cell.replicates = 1;
  cell.replicate_mse.resize(1);
  cell.statistics.status = "deterministic";
  return cell;
}

Results results_of(std::vector<CellResult> cells) {
  Results results;
  results.cells = std::move(cells);
  results.comparisons = compare_cells(results.cells, 1);
  return results;
}

TEST(CompareCells, ComparesWhatSharesAnEstimatorOrASampler) {
  std::vector<CellResult> cells;
  for (const std::uint64_t samples : {16u, 64u}) {
    std::uint64_t seed = 1;
    for (const char* estimator : {"light", "bsdf"}) {
      for (const char* sampler : {"a", "b", "c"}) cells.push_back(cell_of(estimator, sampler, 1, ++seed, samples));
    }
  }
  const auto families = compare_cells(cells, 2);
  ASSERT_EQ(families.size(), 2u);
  for (const ComparisonFamily& family : families) {
    EXPECT_EQ(family.rows.size(), 2u * 3 + 3 * 1);
    for (const ComparedCells& row : family.rows) {
      const CellName &a = cells[row.a].name, &b = cells[row.b].name;
      EXPECT_LT(row.a, row.b);
      EXPECT_EQ(a.samples, b.samples);
      EXPECT_NE(a.estimator == b.estimator, a.sampler == b.sampler);
    }
  }
  // Families have random numbers of their own, each by its name: not by threads, nor by what else was run.
  const std::vector<CellResult> second(cells.begin() + 6, cells.end());
  const auto alone = compare_cells(second, 1);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(alone[0].rows[i].comparison.interval->lo, families[1].rows[i].comparison.interval->lo);
    EXPECT_EQ(alone[0].rows[i].comparison.p_adjusted, families[1].rows[i].comparison.p_adjusted);
  }
}

TEST(CompareCells, TooManyAreComparedWithTheFirstOfTheirLine) {
  std::vector<CellResult> cells;
  for (int sampler = 0; sampler < 65; ++sampler) {  // 65 · 64/2 = 2080 pairs
    cells.push_back(cell_of("mean", std::to_string(sampler), sampler == 7 ? 9 : 1, 50));
    cells.back().replicate_mse.resize(16);
  }
  const Results results = results_of(cells);
  ASSERT_EQ(results.comparisons.size(), 1u);
  EXPECT_TRUE(results.comparisons[0].with_first_only);
  EXPECT_EQ(results.comparisons[0].rows.size(), 64u);
  for (const ComparedCells& row : results.comparisons[0].rows) EXPECT_EQ(row.a, 0u);
}

TEST(CompareCells, MarksOfTheCellsAreThoseOfTheirComparisons) {
  std::vector<CellResult> cells = {cell_of("mean", "a", 1, 1), cell_of("mean", "b", 1, 2), cell_of("mean", "c", 1, 3)};
  cells[0].statistics.status = "heavy-tailed";
  cells[1].facts.infinite_variance = true;
  cells[1].statistics.status = "infinite-variance";
  const auto rows = compare_cells(cells, 1)[0].rows;
  EXPECT_EQ(rows[0].comparison.status, "infinite-variance");
  EXPECT_EQ(rows[0].comparison.verdict, Verdict::kNone);
  EXPECT_EQ(rows[1].comparison.status, "heavy-tailed");
  EXPECT_TRUE(rows[1].comparison.interval);
}

// The best estimator of all must not be missing from a ranking without a word.
TEST(ComparisonsText, NamesWhatIsNotInARanking) {
  std::vector<CellResult> cells = {cell_of("bsdf", "a", 1, 1),    cell_of("bsdf", "b", 1, 2),
                                   cell_of("light", "a", 100, 3), cell_of("light", "b", 100, 4),
                                   cell_of("power", "a", 1, 5),   cell_of("power", "b", 2, 6)};
  for (const std::size_t exact : {0u, 1u, 4u}) {
    std::ranges::fill(cells[exact].replicate_mse, 0.0);
    cells[exact].mse = 0;
    cells[exact].statistics.status = "exact";
  }
  const Results results = results_of(cells);
  const std::string text = comparisons_text(results, results.comparisons[0]);
  EXPECT_THAT(text, HasSubstr("  b: power < light\n"));
  EXPECT_THAT(text, HasSubstr("\n  not compared: bsdf (exact), power on a (exact)\n"));
}

TEST(ComparisonsText, SaysWhoBeatsWhomAndWhoCannotBeToldApart) {
  const Results results = results_of({cell_of("mean", "worst", 100, 1), cell_of("mean", "good", 1, 2),
                                      cell_of("mean", "fine", 1.02, 3), deterministic("mean", "grid")});
  const std::string text = comparisons_text(results, results.comparisons[0]);
  EXPECT_THAT(text, HasSubstr("in 3 comparisons"));
  EXPECT_THAT(text, HasSubstr("mean: good, fine < worst\n"));
  EXPECT_THAT(text, HasSubstr("good and fine cannot be told apart at this budget; about "));
  std::istringstream words(text);  // lines are broken between them
  std::string unwrapped, word;
  while (words >> word) unwrapped += word + " ";
  EXPECT_THAT(unwrapped, HasSubstr("replicates would tell a 10 % difference"));
  EXPECT_THAT(text, HasSubstr(" beats worst by "));
  EXPECT_THAT(text, HasSubstr("not compared: grid (deterministic)"));
}

TEST(ComparisonsText, NoOrderIsPrintedWithinTheNoise) {
  // The errors grow by steps that nobody can tell, so that the first and the last can be told alone.
  std::vector<CellResult> cells;
  for (int k = 0; k < 4; ++k) cells.push_back(cell_of("mean", std::string(1, static_cast<char>('d' - k)), 1, 7));
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < 4; ++k) {
    for (double& mse : cells[k].replicate_mse) mse = std::pow(1.22, k) * std::pow(normal(random), 2);
    cells[k].mse = 0;
    for (const double mse : cells[k].replicate_mse) cells[k].mse += mse / kReplicates;
  }
  const Results results = results_of(cells);
  std::size_t told = 0;
  for (const ComparedCells& row : results.comparisons[0].rows) told += row.comparison.verdict != Verdict::kUndecided;
  ASSERT_GT(told, 0u);
  ASSERT_LT(told, 4u);  // not all between any two sides of a cut
  const std::string text = comparisons_text(results, results.comparisons[0]);
  EXPECT_THAT(text, HasSubstr("mean: d, c, b, a\n"));  // the order in which they were given
  EXPECT_THAT(text, HasSubstr(" beats "));
}

TEST(ComparisonsText, EqualErrorsAreSaidToBe) {
  const CellResult one = cell_of("average", "a", 1, 4), same = cell_of("balance", "a", 1, 4);
  const Results results = results_of({one, same});
  EXPECT_THAT(comparisons_text(results, results.comparisons[0]), HasSubstr("average and balance err alike"));
  EXPECT_THAT(comparisons_csv(results), HasSubstr(",equal\n"));
  const Results none = results_of({deterministic("mean", "a"), deterministic("mean", "b")});
  EXPECT_EQ(comparisons_text(none, none.comparisons[0]), "");
}

TEST(ComparisonsCsv, IsWrittenWithTheRun) {
  const RunScope scope;
  const RunOutcome outcome = scope.run({{"scene", "quarterdisk"},
                                        {"estimators", "mean"},
                                        {"samplers", "independent,halton,sobol-owen"},
                                        {"samples", "64"},
                                        {"replicates", "64"}});
  const CsvTable rows = scope.table("comparisons.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows.text(0, "sampler_b"), "halton");
  EXPECT_EQ(rows.text(0, "status"), "deterministic");
  EXPECT_EQ(rows.text(0, "verdict"), "");
  EXPECT_EQ(rows.text(1, "sampler_a"), "independent");
  EXPECT_EQ(rows.text(1, "sampler_b"), "sobol-owen");
  EXPECT_EQ(rows.text(1, "verdict"), "b-better");  // rates −½ and −¾: at N = 64 the MSE are some ten times apart
  EXPECT_EQ(rows.text(1, "replicates"), "64");
  EXPECT_NEAR(rows.number(1, "mse_ratio"), outcome.results.cells[0].mse / outcome.results.cells[2].mse, 1e-9);
  EXPECT_LT(rows.number(1, "mse_ratio_lo"), rows.number(1, "mse_ratio"));
  EXPECT_GT(rows.number(1, "mse_ratio_lo"), 2);
  EXPECT_THAT(summary(outcome.results), HasSubstr("mean: sobol-owen < independent"));
}

}  // namespace
}  // namespace halfslope
