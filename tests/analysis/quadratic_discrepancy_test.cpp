#include "analysis/quadratic_discrepancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

using Real = long double;
using One = Real (*)(Real);
using Two = Real (*)(Real, Real);

constexpr Real kPi = std::numbers::pi_v<Real>;
Real b2(Real x) { return x * x - x + Real(1) / 6; }
Real middle(Real x) { return std::abs(x - Real(0.5)); }
Real apart(Real x, Real y) { return std::abs(x - y); }
Real none(Real) { return 0; }

/// D² as its paper writes it: a^d − (b/N) Σ Π f + (1/N²) ΣΣ Π k, per dimension; `f` is `none` where there is no such
/// sum.
struct Definition {
  const char* name;
  double (*measure)(const PointSet&);
  const QuadraticKernel& kernel;
  Real constant_sign, constant;
  Real single_factor, single_power;  ///< b = single_factor · single_power^d
  One single;
  Real pair_power;  ///< of the double sum: 2^d in symmetric
  Two pair;
};

const std::vector<Definition>& definitions() {
  static const std::vector<Definition> all = {
      {"l2-star", l2_star_discrepancy, kL2Star, 1, Real(1) / 3, 2, 0.5, [](Real x) { return 1 - x * x; }, 1,
       [](Real x, Real y) { return 1 - std::max(x, y); }},
      {"centered-l2", centered_l2_discrepancy, kCenteredL2, 1, Real(13) / 12, 2, 1,
       [](Real x) { return 1 + middle(x) / 2 - middle(x) * middle(x) / 2; }, 1,
       [](Real x, Real y) { return 1 + middle(x) / 2 + middle(y) / 2 - apart(x, y) / 2; }},
      {"wraparound-l2", wraparound_l2_discrepancy, kWraparoundL2, -1, Real(4) / 3, 0, 1, none, 1,
       [](Real x, Real y) { return Real(1.5) - apart(x, y) * (1 - apart(x, y)); }},
      {"mixture-l2", mixture_l2_discrepancy, kMixtureL2, 1, Real(19) / 12, 2, 1,
       [](Real x) { return Real(5) / 3 - middle(x) / 4 - middle(x) * middle(x) / 4; }, 1,
       [](Real x, Real y) {
         return Real(15) / 8 - middle(x) / 4 - middle(y) / 4 - 3 * apart(x, y) / 4 + apart(x, y) * apart(x, y) / 2;
       }},
      {"symmetric-l2", symmetric_l2_discrepancy, kSymmetricL2, 1, Real(4) / 3, 2, 1,
       [](Real x) { return 1 + 2 * x - 2 * x * x; }, 2, [](Real x, Real y) { return 1 - apart(x, y); }},
      {"extreme-l2", extreme_l2_discrepancy, kExtremeL2, 1, Real(1) / 12, 2, 0.5, [](Real x) { return x * (1 - x); }, 1,
       [](Real x, Real y) { return (1 - std::max(x, y)) * std::min(x, y); }},
      {"periodic-l2", periodic_l2_discrepancy, kPeriodicL2, -1, Real(1) / 3, 0, 1, none, 1,
       [](Real x, Real y) { return Real(0.5) - apart(x, y) + apart(x, y) * apart(x, y); }},
      {"diaphony", diaphony, kDiaphony, -1, 1, 0, 1, none, 1,
       [](Real x, Real y) { return 1 + 2 * kPi * kPi * b2(apart(x, y)); }},
  };
  return all;
}

Real squared(const Definition& definition, const Columns& points) {
  const std::size_t dims = points.size(), count = points[0].size();
  const auto power = [dims](Real x) { return std::pow(x, static_cast<Real>(dims)); };
  const auto n = static_cast<Real>(count);
  Real singles = 0, pairs = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Real single = 1;
    for (const auto& x : points) single *= definition.single(x[i]);
    singles += single;
    for (std::size_t j = 0; j < count; ++j) {
      Real pair = 1;
      for (const auto& x : points) pair *= definition.pair(x[i], x[j]);
      pairs += pair;
    }
  }
  const Real sum = definition.constant_sign * power(definition.constant) -
                   definition.single_factor * power(definition.single_power) * singles / n +
                   power(definition.pair_power) * pairs / (n * n);
  return definition.kernel.normalised ? sum / (power(1 + kPi * kPi / 3) - 1) : sum;
}

// The parts of D² are below 20 in five dimensions (mixture's 15/8 to the 5th is the largest of its mean squares), and
// 64 bits of each are right, so D² is to 4e-18 or so, and D to that over 2 D.
TEST(QuadraticDiscrepancy, IsItsDefinition) {
  std::mt19937_64 random(1);
  for (const Definition& definition : definitions()) {
    for (std::size_t dims = 1; dims <= 5; ++dims) {
      for (const std::size_t count : {1, 2, 3, 7, 16, 40}) {
        for (const std::uint64_t grid : {0, 1, 2, 5, 9}) {
          const Columns points = random_points(count, dims, random, grid);
          const Real exact = std::sqrt(squared(definition, points));
          const double tolerance = 1e-15 * static_cast<double>(exact) + 5e-18 / static_cast<double>(exact);
          EXPECT_NEAR(definition.measure(view(points)), static_cast<double>(exact), tolerance)
              << definition.name << " d=" << dims << " N=" << count << " grid " << grid;
          EXPECT_NEAR(quadratic_discrepancy_by_pairs(view(points), definition.kernel), static_cast<double>(exact),
                      tolerance)
              << "by pairs: " << definition.name << " d=" << dims << " N=" << count << " grid " << grid;
        }
      }
    }
  }
}

Columns in_thirds(std::size_t count, std::size_t dims) {  // no coordinate but 0 is a multiple of 2⁻⁵³
  Columns columns = halton(0, count, dims);
  for (auto& column : columns)
    for (double& x : column) x /= 3;
  return columns;
}

// The integers of the plane and the squares of the line against pairs of binary64, where the parts of D² cancel to 10⁻⁸
// of themselves.
TEST(QuadraticDiscrepancy, ShortWaysAgreeWithPairs) {
  for (const Columns& points : {sobol(0, 4096), sobol(1, 3000), halton(0, 3000), in_thirds(1500, 2), hammersley(12),
                                halton(7, 2000, 1), in_thirds(1000, 1)}) {
    for (const Definition& definition : definitions()) {
      const double pairs = quadratic_discrepancy_by_pairs(view(points), definition.kernel);
      EXPECT_NEAR(definition.measure(view(points)) / pairs, 1, 1e-15)
          << definition.name << ' ' << points.size() << ' ' << points[0].size();
    }
  }
}

// In more dimensions: N points, each twice, have the discrepancy of N, and so have they after a shift of the order. The
// order of all sums changes, and nothing else.
TEST(QuadraticDiscrepancy, TwiceEachPointIsTheSameInMoreDimensions) {
  for (Columns points : {halton(0, 700, 3), halton(0, 700, 6), in_thirds(500, 4)}) {
    Columns twice = points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      twice[k].insert(twice[k].end(), points[k].begin(), points[k].end());
      std::rotate(twice[k].begin(), twice[k].begin() + 123, twice[k].end());
    }
    for (const Definition& definition : definitions()) {
      EXPECT_NEAR(definition.measure(view(twice)) / definition.measure(view(points)), 1, 5e-16)
          << definition.name << ' ' << points.size();
    }
  }
}

}  // namespace
}  // namespace halfslope
