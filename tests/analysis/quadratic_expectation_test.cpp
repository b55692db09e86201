// What the quadratic discrepancies are on average.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/analysis/quadratic_definitions.h"

namespace halfslope {
namespace {

// Gauss's rule of four points on [0, 1], exact for polynomials up to the 7th degree.
constexpr std::array<Real, 4> kNodes = {0.069431844202973712388L, 0.330009478207571867599L, 0.669990521792428132401L,
                                        0.930568155797026287612L};
constexpr std::array<Real, 4> kWeights = {0.173927422568726928687L, 0.326072577431273071313L, 0.326072577431273071313L,
                                          0.173927422568726928687L};

template <class Function>
Real integral(Real begin, Real end, Function f) {
  Real sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += kWeights[k] * f(begin + (end - begin) * kNodes[k]);
  return sum * (end - begin);
}

/// The definition's kernel with its power of dimension in it.
Real kernel(const Definition& definition, Real x, Real y) { return definition.pair_power * definition.pair(x, y); }

/// ∫ k(x, x) dx: k is a polynomial of x on either side of ½.
Real diagonal(const Definition& definition) {
  const auto k = [&](Real x) { return kernel(definition, x, x); };
  return integral(0, 0.5, k) + integral(0.5, 1, k);
}

/// Σ ∬ k over the squares [i/n, (i + 1)/n]², n even: k is a polynomial of x and y on either side of their diagonals.
Real over_cells(const Definition& definition, int n) {
  Real sum = 0;
  for (int i = 0; i < n; ++i) {
    const Real begin = static_cast<Real>(i) / n, end = static_cast<Real>(i + 1) / n;
    sum += 2 * integral(begin, end,
                        [&](Real x) { return integral(begin, x, [&](Real y) { return kernel(definition, x, y); }); });
  }
  return sum;
}

Real mean_kernel(const Definition& definition) {
  const auto row = [&](Real x) {
    const auto k = [&](Real y) { return kernel(definition, x, y); };
    const Real middle = 0.5, low = std::min(x, middle), high = std::max(x, middle);
    return integral(0, low, k) + integral(low, high, k) + integral(high, 1, k);
  };
  return integral(0, 0.5, row) + integral(0.5, 1, row);
}

Real norm(const Definition& definition, std::size_t dims) {
  return definition.kernel.normalised ? std::pow(1 + kPi * kPi / 3, static_cast<Real>(dims)) - 1 : 1;
}

// E D² for independent uniform points: of Σ_i Σ_j Πk, N terms have the mean (∫ k(x, x))^d and the other N (N − 1) the
// mean C^d, C = ∬ k; E Π f = C^d. So E D² = ((∫ k(x, x))^d − C^d) / N.
TEST(QuadraticExpectation, OfIndependentPointsInClosedForm) {
  for (const Definition& definition : definitions()) {
    for (std::size_t dims = 1; dims <= 8; ++dims) {
      const auto d = static_cast<Real>(dims);
      const Real expected =
          (std::pow(diagonal(definition), d) - std::pow(mean_kernel(definition), d)) / norm(definition, dims);
      EXPECT_NEAR(quadratic_discrepancy_variance(dims, definition.kernel) / static_cast<double>(expected), 1, 1e-14)
          << definition.name << ' ' << dims;
    }
  }
  EXPECT_NEAR(quadratic_discrepancy_variance(2, kL2Star), 5.0 / 36, 1e-16);  // 2⁻² − 3⁻²
}

struct Mean {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) { sum += x, squares += x * x, ++count; }
  /// How many standard errors the mean is from `expected`.
  double deviation(double expected) const {
    const double mean = sum / count;
    return (mean - expected) / std::sqrt((squares / count - mean * mean) / count);
  }
};

// Means over 4000 sets; N D² has exponential tails at most, so the mean of so many is close to normal, and one of these
// tests' 16 or 8 deviations is beyond 6 with a probability of 4e-8.
TEST(QuadraticExpectation, OfIndependentPoints) {
  std::mt19937_64 random(4);
  for (const std::size_t dims : {2, 3}) {
    std::array<Mean, 8> means;
    for (int set = 0; set < 4000; ++set) {
      const Columns points = random_points(16, dims, random);
      for (std::size_t m = 0; m < means.size(); ++m) means[m].add(std::pow(definitions()[m].measure(view(points)), 2));
    }
    for (std::size_t m = 0; m < means.size(); ++m) {
      const double expected = quadratic_discrepancy_variance(dims, definitions()[m].kernel) / 16;
      EXPECT_LT(std::abs(means[m].deviation(expected)), 6) << definitions()[m].name << ' ' << dims;
    }
  }
}

// One uniform point in each of N = n × n square cells c. The points' densities, N on each cell, add up to N times the
// uniform one, so E Σ_i Πf = N C², and of Σ_i Σ_j Πk the terms with i = j have the sum N (∫ k(x, x))² on average, the
// others N² (C² − Σ_c ∬_{c×c} Πk). So E D² = (∫ k(x, x))²/N − Σ_c ∬_{c×c} Πk, and the sum over cells of a product is
// (Σ_i ∬ k over the i-th interval's square)².
TEST(QuadraticExpectation, OfJitteredPoints) {
  std::mt19937_64 random(5);
  constexpr int kSide = 4;
  std::array<Mean, 8> means;
  for (int set = 0; set < 4000; ++set) {
    Columns points = random_points(kSide * kSide, 2, random);
    for (int i = 0; i < kSide * kSide; ++i) {
      const auto at = static_cast<std::size_t>(i);
      points[0][at] = (points[0][at] + i % kSide) / kSide;
      points[1][at] = (points[1][at] + i / kSide) / kSide;
    }
    for (std::size_t m = 0; m < means.size(); ++m) means[m].add(std::pow(definitions()[m].measure(view(points)), 2));
  }
  for (std::size_t m = 0; m < means.size(); ++m) {
    const Definition& definition = definitions()[m];
    const Real side = std::pow(diagonal(definition), Real(2)) / (kSide * kSide);
    const Real expected = (side - std::pow(over_cells(definition, kSide), Real(2))) / norm(definition, 2);
    EXPECT_LT(std::abs(means[m].deviation(static_cast<double>(expected))), 6) << definition.name;
  }
}

}  // namespace
}  // namespace halfslope
