#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

/// ∫∫ (c(x, y)/N − x y)² over the cells of the grid that the points span, in each of which c is constant.
double integrated(const Columns& columns) {
  auto right = columns[0], top = columns[1];
  for (auto* edges : {&right, &top}) {
    edges->push_back(0), edges->push_back(1);
    std::sort(edges->begin(), edges->end());
  }
  long double sum = 0;
  for (std::size_t i = 0; i + 1 < right.size(); ++i) {
    for (std::size_t j = 0; j + 1 < top.size(); ++j) {
      long double share = 0;
      for (std::size_t k = 0; k < columns[0].size(); ++k)
        share += columns[0][k] <= right[i] && columns[1][k] <= top[j] ? 1 : 0;
      share /= static_cast<long double>(columns[0].size());
      const auto moment = [](long double a, long double b, int k) { return (std::pow(b, k) - std::pow(a, k)) / k; };
      const auto cell = [&](int k) { return moment(right[i], right[i + 1], k) * moment(top[j], top[j + 1], k); };
      sum += share * share * cell(1) - 2 * share * cell(2) + cell(3);
    }
  }
  return static_cast<double>(std::sqrt(sum));
}

TEST(L2StarDiscrepancy, IsTheIntegralOverBoxes) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {1, 2, 3, 7, 16, 30}) {
    for (const std::uint64_t grid : {0, 1, 2, 5, 9}) {
      for (int trial = 0; trial < 4; ++trial) {
        const Columns points = random_points(count, 2, random, grid);
        EXPECT_NEAR(l2_star_discrepancy(view(points)), integrated(points), 1e-15) << count << ' ' << grid;
      }
    }
  }
}

// Halton and Zaremba 1969; Warnock's formula in binary64 loses twelve digits at m = 20.
TEST(L2StarDiscrepancy, OfHammersleyPoints) {
  for (int m = 1; m <= 20; ++m) {
    const double n = std::ldexp(1.0, m);
    const double exact = m * m / 64.0 + 29 * m / 192.0 + 3 / 8.0 - m / (16 * n) + 1 / (4 * n) - 1 / (72 * n * n);
    EXPECT_NEAR(std::pow(n * l2_star_discrepancy(view(hammersley(m))), 2) / exact, 1, 1e-14) << m;
  }
}

// Warnock's formula in binary64, twice: right to 1e-12, not to 1e-12 of themselves.
TEST(L2StarDiscrepancy, OfHaltonAndSobolPoints) {
  struct Case {
    Columns points;
    double l2_star;
  };
  const std::vector<Case> cases = {
      {halton(0, 16), 0.06824779161021115},     {halton(0, 100), 0.015271739964098575},
      {halton(0, 256), 0.0053063698910020855},  {halton(0, 1024), 0.0016454954701502552},
      {halton(1, 1024), 0.0012575311327616},    {halton(1, 4096), 0.000334632760594902},
      {sobol(0, 8), 0.10465380884067768},       {sobol(0, 16), 0.047766230959700805},
      {sobol(0, 32), 0.02400426469988205},      {sobol(0, 128), 0.00702978960812672},
      {sobol(0, 256), 0.0033074703678268075},   {sobol(0, 1024), 0.0008679282638502286},
      {sobol(1, 2048), 0.000431559398318967},   {sobol(1, 4096), 0.00022387580399340533},
      {sobol(0, 16384), 6.164538349174788e-05}, {sobol(0, 65536), 1.5577269807484223e-05},
  };
  for (const Case& c : cases) {
    EXPECT_NEAR(l2_star_discrepancy(view(c.points)), c.l2_star, 1e-12) << c.points[0].size() << ' ' << c.l2_star;
  }
}

// Computed with many digits.
TEST(L2StarDiscrepancy, KeepsItsDigitsForLargeSets) {
  EXPECT_NEAR(l2_star_discrepancy(view(sobol(0, 16384))) / 6.164538349174788e-05, 1, 4e-15);
  EXPECT_NEAR(l2_star_discrepancy(view(sobol(0, 65536))) / 1.5577269807484223e-05, 1, 4e-15);
}

TEST(L2StarDiscrepancy, InMoreDimensions) {
  struct Case {
    Columns points;
    double l2_star;
  };
  const std::vector<Case> cases = {
      {halton(0, 10, 3), 0.10678157491385713},      {halton(0, 16, 3), 0.07936440744589907},
      {halton(0, 64, 3), 0.022114615512120468},     {halton(0, 64, 4), 0.023588354415097337},
      {halton(1, 1024, 3), 0.0016259171117493185},  {halton(1, 1024, 15), 0.0005745852897245563},
      {halton(1, 1024, 30), 0.0004453449306585631},
  };
  for (const Case& c : cases) {
    EXPECT_NEAR(l2_star_discrepancy(view(c.points)), c.l2_star, 1e-12) << c.points.size() << ' ' << c.l2_star;
  }
  for (const int dims : {2, 4, 8, 16, 32, 64}) {  // one point at (1, …, 1): the mean of volume², 3⁻ᵈ
    const Columns corner(static_cast<std::size_t>(dims), {1.0});
    EXPECT_NEAR(l2_star_discrepancy(view(corner)) * std::pow(3.0, dims / 2.0), 1, 1e-14) << dims;
  }
  // One point at the origin: 1 − 2¹⁻ᵈ + 3⁻ᵈ.
  const Columns origin(32, {0.0});
  EXPECT_NEAR(std::pow(l2_star_discrepancy(view(origin)), 2), 0.999999999534339252351788477617, 4e-16);
}

TEST(L2StarDiscrepancy, SmallSetsInRationals) {
  struct Case {
    std::vector<std::vector<double>> points;
    double squared;
  };
  const std::vector<Case> cases = {
      {{{0.5, 0.5}}, 23.0 / 288},
      {{{0.0, 0.0}}, 11.0 / 18},
      {{{1.0, 1.0}}, 1.0 / 9},
      {{{0, 0}, {0.5, 0.5}, {0.75, 0.25}, {0.25, 0.75}, {0.375, 0.375}, {0.875, 0.875}, {0.625, 0.125}, {0.125, 0.625}},
       0.0109524197048611111111111111111},
      {{{0.5}}, 1.0 / 12},
      {{{0.0}}, 1.0 / 3},
      {{{0.0}, {1.0}}, 1.0 / 12},
      {{{0.5}, {0.5}, {0.5}, {0.5}}, 1.0 / 12},
  };
  for (const Case& c : cases) {
    EXPECT_NEAR(std::pow(l2_star_discrepancy(view(columns_of(c.points))), 2) / c.squared, 1, 1e-15) << c.squared;
  }
}

TEST(L2StarDiscrepancy, InOneDimensionNothingCancels) {
  for (const int m : {0, 3, 10, 16, 20}) {
    const double n = std::ldexp(1.0, m);
    Columns points(1);
    for (double i = 0; i < n; ++i) points[0].push_back((i + 0.5) / n);
    std::shuffle(points[0].begin(), points[0].end(), std::mt19937_64(1));
    EXPECT_NEAR(l2_star_discrepancy(view(points)) * n * std::sqrt(12.0), 1, 9e-16) << m;
  }
  EXPECT_NEAR(l2_star_discrepancy(view({{6.5 / 7, 0.5 / 7, 1.5 / 7, 2.5 / 7, 3.5 / 7, 4.5 / 7, 5.5 / 7}})),
              0.041239304942116126, 1e-16);
}

// E (L2*)² = (2⁻² − 3⁻²)/N for N independent points. The mean of 4000 sets' N (L2*)² has a standard error under 0.0025
// (their variance is under 0.025: at most E[N² L⁴] ≤ 6 (5/36)² + …, sampled 0.02); 6 of them are passed with
// probability 2e-9.
TEST(L2StarDiscrepancy, OfIndependentPointsOnAverage) {
  std::mt19937_64 random(6);
  constexpr int kSets = 4000;
  double sum = 0, squares = 0;
  for (int s = 0; s < kSets; ++s) {
    const double squared = 25 * std::pow(l2_star_discrepancy(view(random_points(25, 2, random))), 2);
    sum += squared, squares += squared * squared;
  }
  const double mean = sum / kSets, standard_error = std::sqrt((squares / kSets - mean * mean) / kSets);
  EXPECT_NEAR(mean, 5.0 / 36, 6 * standard_error);
  EXPECT_LT(standard_error, 0.0025);
}

}  // namespace
}  // namespace halfslope
