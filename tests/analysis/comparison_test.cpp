#include "analysis/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/bootstrap.h"
#include "analysis/moments.h"

namespace halfslope {
namespace {

using Table = std::vector<std::vector<double>>;

/// Squares of normal errors, [cell][replicate], those of one replicate correlated by `shared`².
Table squared_normals(std::size_t cells, std::size_t replicates, std::uint64_t seed, double shared = 0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Table table(cells, std::vector<double>(replicates));
  for (std::size_t r = 0; r < replicates; ++r) {
    const double common = shared * normal(random);
    for (auto& cell : table) cell[r] = std::pow(common + std::sqrt(1 - shared * shared) * normal(random), 2);
  }
  return table;
}

std::vector<ComparedErrors> errors_of(const Table& table, double reference_mse = 0) {
  std::vector<ComparedErrors> cells;
  for (const auto& errors : table) cells.push_back({errors, reference_mse});
  return cells;
}

Comparison compare_two(const std::vector<double>& a, const std::vector<double>& b, double reference_mse = 0) {
  const Table table = {a, b};
  return compare(errors_of(table, reference_mse), all_pairs(2), 1).front();
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(ComparisonBootstrap, IsTheStudentisedChangeOfEachResample) {
  // Worked out resample by resample from the rows that it draws, as the definition says.
  constexpr std::size_t kRows = 21;
  const Table table = squared_normals(3, kRows, 4, 0.7);
  Table deviations = table;
  for (std::size_t k = 0; k < 3; ++k) {
    for (double& x : deviations[k]) x = (x - mean_of(table[k])) / mean_of(table[k]);
  }
  const std::vector<ColumnPair> pairs = {{0, 2}, {2, 1}};
  const auto found = ComparisonBootstrap(deviations, pairs).studentised(9, 50);
  std::vector<std::uint32_t> rows(kRows);
  for (std::uint32_t b = 0; b < 50; ++b) {
    draw_resample(9, b, kRows, rows);
    Table drawn(3);
    for (std::size_t k = 0; k < 3; ++k) {
      for (const std::uint32_t row : rows) drawn[k].push_back(table[k][row]);
    }
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto [i, j] = pairs[p];
      const double change =
          std::log(mean_of(drawn[i]) / mean_of(drawn[j])) - std::log(mean_of(table[i]) / mean_of(table[j]));
      std::vector<double> influences;
      for (std::size_t r = 0; r < kRows; ++r)
        influences.push_back(drawn[i][r] / mean_of(drawn[i]) - drawn[j][r] / mean_of(drawn[j]));
      Moments moments;
      moments.add(influences);
      EXPECT_NEAR(found[p][b], std::abs(change) / moments.standard_error(), 1e-5 * (1 + found[p][b]));
    }
  }
}

TEST(ComparisonBootstrap, AResampleOfOneRowHasNoSpread) {
  // Of two rows every second resample takes one alone.
  const auto found = ComparisonBootstrap({{-0.5, 0.5}, {0.25, -0.25}}, all_pairs(2)).studentised(1, 1000);
  const auto infinite = std::ranges::count_if(found[0], [](float t) { return std::isinf(t); });
  EXPECT_NEAR(static_cast<double>(infinite), 500, 5 * std::sqrt(250.0));  // five standard deviations: 6e-7
}

TEST(Compare, TheRatioIsThatOfTheMeans) {
  const Table table = squared_normals(2, 100, 1);
  const Comparison comparison = compare_two(table[0], table[1]);
  EXPECT_EQ(comparison.status, "ok");
  EXPECT_EQ(comparison.replicates, 100);
  EXPECT_NEAR(*comparison.log_ratio, std::log(mean_of(table[0]) / mean_of(table[1])), 1e-13);
  const Comparison corrected = compare_two(table[0], table[1], 0.05);
  EXPECT_NEAR(*corrected.log_ratio, std::log((mean_of(table[0]) - 0.05) / (mean_of(table[1]) - 0.05)), 1e-13);
  EXPECT_LT(comparison.interval->lo, *comparison.log_ratio);
  EXPECT_NEAR(comparison.interval->lo + comparison.interval->hi, 2 * *comparison.log_ratio, 1e-13);  // symmetric
}

TEST(Compare, ScaleAndExchangeChangeSignsOnly) {
  const Table table = squared_normals(2, 64, 2);
  std::vector<double> scaled = table[0];
  for (double& x : scaled) x *= 0x1p-300;
  const Comparison plain = compare_two(table[0], table[1]), small = compare_two(scaled, table[1]),
                   exchanged = compare_two(table[1], table[0]);
  EXPECT_NEAR(*small.log_ratio, *plain.log_ratio - 300 * std::log(2), 1e-10);
  EXPECT_NEAR(small.interval->hi - small.interval->lo, plain.interval->hi - plain.interval->lo, 1e-5);
  EXPECT_EQ(small.verdict, Verdict::kABetter);
  EXPECT_NEAR(*exchanged.log_ratio, -*plain.log_ratio, 1e-14);
  EXPECT_NEAR(exchanged.interval->lo, -plain.interval->hi, 1e-5);
  EXPECT_EQ(exchanged.p, plain.p);
}

TEST(Compare, CommonSamplesNarrowTheInterval) {
  const Table apart = squared_normals(2, 256, 3), common = squared_normals(2, 256, 3, 0.95);
  const auto width = [](const Comparison& c) { return c.interval->hi - c.interval->lo; };
  // Influences of correlation ρ = 0.95² squared have √(1 − ρ²) of the spread of independent ones: 0.43.
  EXPECT_NEAR(width(compare_two(common[0], common[1])) / width(compare_two(apart[0], apart[1])), 0.43, 0.12);
}

TEST(Compare, OneOfAFamilyIsAdjustedForTheOthers) {
  Table table = squared_normals(11, 256, 6);
  for (double& x : table[10]) x *= 4;
  const auto family = compare(errors_of(table), pairs_with(0, 11), 1);
  ASSERT_EQ(family.size(), 10u);
  double largest = 0;
  for (const Comparison& comparison : family) {
    EXPECT_GE(*comparison.p_adjusted, *comparison.p);
    EXPECT_GE(*comparison.p, 1.0 / (kComparisonResamples + 1));
    EXPECT_EQ(comparison.verdict == Verdict::kUndecided, *comparison.p_adjusted > kFamilyLevel);
    largest = std::max(largest, *comparison.p - *comparison.p_adjusted);
  }
  EXPECT_EQ(family.back().verdict, Verdict::kABetter);  // 12 standard errors
  // The least significant is adjusted by the adjusted p of those before alone.
  const auto alone = compare(errors_of({table[0], table[10]}), all_pairs(2), 1).front();
  EXPECT_EQ(*alone.p, *alone.p_adjusted);
  EXPECT_LT(alone.critical, family.back().critical);
  EXPECT_NEAR(alone.critical, 1.96, 0.01);
}

TEST(Compare, CopiesOfAComparisonCostNothing) {
  // The family of a comparison and nine copies of it is as hard as the one alone.
  const Table two = squared_normals(2, 128, 7);
  Table table(11, two[1]);
  table[0] = two[0];
  const auto family = compare(errors_of(table), pairs_with(0, 11), 5);
  for (const Comparison& comparison : family) EXPECT_EQ(*comparison.p_adjusted, *family[0].p);
}

TEST(Compare, NothingIsRankedWhereNothingIsKnown) {
  const std::vector<double> errors = squared_normals(1, 64, 8)[0];
  std::vector<double> zeros(64), constant(64, 2.0), other(64, 3.0), broken = errors;
  broken[5] = NAN;
  const auto status = [](const Comparison& comparison) {
    EXPECT_EQ(comparison.verdict, Verdict::kNone) << comparison.status;
    EXPECT_FALSE(comparison.interval || comparison.p || comparison.p_adjusted || comparison.replicates_needed);
    return comparison.status;
  };
  EXPECT_EQ(status(compare_two({1.0}, {2.0})), "deterministic");
  EXPECT_EQ(status(compare_two({1.0}, errors)), "deterministic");
  EXPECT_EQ(status(compare_two({}, errors)), "many-replicates");
  EXPECT_EQ(status(compare_two(errors, broken)), "invalid");
  EXPECT_EQ(status(compare_two(errors, zeros)), "exact");
  EXPECT_EQ(status(compare_two(errors, errors)), "equal");
  EXPECT_EQ(status(compare_two(constant, other)), "no-spread");
  EXPECT_EQ(status(compare_two(constant, errors)), "no-spread");  // one side's error may be anything
  const ComparedErrors at_rounding[] = {{errors, 0, 1e-6}, {constant, 0, 1}};
  EXPECT_EQ(status(compare(at_rounding, all_pairs(2), 1).front()), "floor");
  EXPECT_EQ(status(compare_two(errors, constant, 2.5)), "reference-limited");
  std::vector<double> twice = errors;
  for (double& x : twice) x *= 3;
  const Comparison proportional = compare_two(errors, twice);
  EXPECT_EQ(status(proportional), "no-spread");
  EXPECT_NEAR(*proportional.log_ratio, -std::log(3), 1e-13);
}

// Estimates of about 1 whose last bits differ, as those of one estimator that is worked out in two ways.
TEST(Compare, DifferencesOfRoundingAloneAreNone) {
  for (const double unit : {0x1p-24, 0x1p-53}) {
    std::mt19937_64 random(12);
    std::normal_distribution<double> normal(0, 0.1);
    std::uniform_int_distribution<int> ulps(-4, 4);
    std::vector<double> a, near, far;
    for (int r = 0; r < 64; ++r) {
      const double error = normal(random);
      a.push_back(error * error);
      near.push_back(std::pow(error + ulps(random) * unit, 2));
      far.push_back(std::pow(error + 100 * ulps(random) * unit, 2));
    }
    const auto compared = [&](const std::vector<double>& b, double rounding) {
      const ComparedErrors cells[] = {{a, 0, rounding * rounding}, {b, 0, rounding * rounding}};
      return compare(cells, all_pairs(2), 1).front();
    };
    EXPECT_EQ(compared(near, unit).status, "equal") << unit;
    EXPECT_FALSE(compared(near, unit).log_ratio);
    EXPECT_NE(compared(far, unit).status, "equal") << unit;
    EXPECT_NE(compared(near, 0).status, "equal") << unit;  // whose precision is not known
    near[40] *= 1.001;
    EXPECT_NE(compared(near, unit).status, "equal") << unit;
  }
}

// Four replicates of heavy tails bound little: an interval beyond a million either way is none, and p stands.
TEST(Compare, AnIntervalThatSaysNothingIsNone) {
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  int none = 0, some = 0;
  for (int k = 0; k < 50; ++k) {
    Table table(2, std::vector<double>(4));
    for (auto& cell : table) {
      for (double& x : cell) x = std::exp(6 * normal(random));
    }
    const Comparison comparison = compare_two(table[0], table[1]);
    EXPECT_TRUE(comparison.p && comparison.log_ratio);
    (comparison.interval ? some : none) += 1;
    if (comparison.interval) {
      EXPECT_LE(comparison.interval->hi - *comparison.log_ratio, std::log(1e6));
      EXPECT_LE(*comparison.log_ratio - comparison.interval->lo, std::log(1e6));
    }
  }
  EXPECT_GT(none, 0);
  EXPECT_GT(some, 0);
}

TEST(Compare, WhatIsDoubtfulIsMarkedAndStands) {
  const Table few = squared_normals(2, 15, 3), many = squared_normals(2, 64, 3);
  EXPECT_EQ(compare_two(few[0], few[1]).status, "few-replicates");
  EXPECT_TRUE(compare_two(few[0], few[1]).interval);
  const Comparison limited = compare_two(many[0], many[1], 0.15);
  EXPECT_EQ(limited.status, "reference-limited");
  EXPECT_TRUE(limited.interval && limited.p_adjusted);
}

TEST(Compare, CellsOfUnequalReplicatesAreComparedOverThoseOfBoth) {
  Table table = squared_normals(3, 100, 9, 0.8);
  table[1].resize(40);
  const auto family = compare(errors_of(table), all_pairs(3), 1);
  const auto first_40 = [&](std::size_t k) { return std::vector(table[k].begin(), table[k].begin() + 40); };
  EXPECT_EQ(family[0].replicates, 40);
  EXPECT_EQ(family[1].replicates, 100);
  EXPECT_EQ(*family[0].log_ratio, *compare_two(first_40(0), table[1]).log_ratio);
  EXPECT_EQ(*family[1].log_ratio, *compare_two(table[0], table[2]).log_ratio);
}

TEST(Compare, IsAFunctionOfErrorsAndSeed) {
  const Table table = squared_normals(4, 64, 10);
  const auto a = compare(errors_of(table), all_pairs(4), 1), b = compare(errors_of(table), all_pairs(4), 1),
             c = compare(errors_of(table), all_pairs(4), 2);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].interval->lo, b[i].interval->lo);
    EXPECT_EQ(a[i].p_adjusted, b[i].p_adjusted);
    EXPECT_NE(a[i].interval->lo, c[i].interval->lo);
  }
}

TEST(Pairs, AreEveryTwoOrEveryOtherOne) {
  EXPECT_EQ(all_pairs(3), (std::vector<ColumnPair>{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(pairs_with(1, 3), (std::vector<ColumnPair>{{1, 0}, {1, 2}}));
  EXPECT_TRUE(all_pairs(1).empty());
}

}  // namespace
}  // namespace halfslope
