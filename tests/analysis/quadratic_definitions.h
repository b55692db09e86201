// The quadratic discrepancies as their papers define them, in binary floating point of 64 bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/quadratic_discrepancy.h"
#include "tests/analysis/point_sets.h"

namespace halfslope {

using Real = long double;
using One = Real (*)(Real);
using Two = Real (*)(Real, Real);

inline constexpr Real kPi = std::numbers::pi_v<Real>;
inline Real b2(Real x) { return x * x - x + Real(1) / 6; }
inline Real middle(Real x) { return std::abs(x - Real(0.5)); }
inline Real apart(Real x, Real y) { return std::abs(x - y); }
inline Real none(Real) { return 0; }

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

inline const std::vector<Definition>& definitions() {
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

inline Real squared(const Definition& definition, const Columns& points) {
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

}  // namespace halfslope
