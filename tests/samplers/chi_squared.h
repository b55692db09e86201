// Pearson's χ² and the bounds that its tests stand on.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace halfslope {

/// Σ (count − e)²/e with e = total / counts.size(): χ² with counts.size() − 1 degrees of freedom if all are equally
/// likely and e is not small.
template <class Count>
double chi_squared(std::span<const Count> counts) {
  double total = 0, sum = 0;
  for (const Count count : counts) total += static_cast<double>(count);
  const double expected = total / static_cast<double>(counts.size());
  for (const Count count : counts) sum += std::pow(static_cast<double>(count) - expected, 2) / expected;
  return sum;
}

/// What χ² with `degrees` of freedom exceeds with probability at most `alpha`, and what it falls below with probability
/// at most `alpha`: exact inequalities (B. Laurent & P. Massart, "Adaptive estimation of a quadratic functional by
/// model selection", 2000, lemma 1).
inline double chi_squared_upper(double degrees, double alpha) {
  const double t = -std::log(alpha);
  return degrees + 2 * std::sqrt(degrees * t) + 2 * t;
}
inline double chi_squared_lower(double degrees, double alpha) {
  return degrees - 2 * std::sqrt(degrees * -std::log(alpha));
}

}  // namespace halfslope
