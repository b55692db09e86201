#include "analysis/tails.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/compensated_sum.h"

namespace halfslope {

// For R independent values of one law with central moments μ4 and σ² (H. Cramér, "Mathematical Methods of Statistics",
// 1946, section 27.4, carried through to every order):
//   E[m4]  = (R−1)/R³ · ( (R² − 3R + 3) μ4 + 3(2R − 3) σ⁴ )
//   E[m2²] = (R−1)/R³ · (         (R − 1) μ4 + (R² − 2R + 3) σ⁴ )
// Both are linear in μ4 and σ⁴ with coefficients that only know R, so they hold for sums over integrals too, whose laws
// may all differ. Solved for the two, the common factor and the determinant dropping out of their quotient:
//   K = ( (R² − 2R + 3) Σm4 − 3(2R − 3) Σm2² ) / ( (R² − 3R + 3) Σm2² − (R − 1) Σm4 )
// The determinant (R² − 3R + 3)(R² − 2R + 3) − 3(2R − 3)(R − 1) = R² (R − 2)(R − 3) is 0 for two and three replicates.
// The denominator is never negative: m4/m2² is at most (R² − 3R + 3)/(R − 1), where one value differs from all others.
std::optional<double> corrected_kurtosis(double sum_m2_squared, double sum_m4, std::int64_t replicates) {
  if (replicates < 4 || !(sum_m2_squared > 0) || !std::isfinite(sum_m2_squared) || !std::isfinite(sum_m4))
    return std::nullopt;
  const auto r = static_cast<double>(replicates);
  const double fourth = ((r - 2) * r + 3) * sum_m4 - 3 * (2 * r - 3) * sum_m2_squared;
  const double whole = ((r - 3) * r + 3) * sum_m2_squared, squared = whole - (r - 1) * sum_m4;
  // What is left of the difference below this is its rounding.
  if (!(squared > 1e-12 * whole)) return std::numeric_limits<double>::infinity();
  return fourth / squared;
}

double kurtosis_limit(std::int64_t replicates) { return std::max(5.0, static_cast<double>(replicates) / 40); }

std::int64_t worst_count(std::int64_t integrals) { return (integrals + 999) / 1000; }

double mean_squared_error(const Moments& moments, double truth) {
  const double bias = moments.mean - truth;
  return moments.m2() + bias * bias;
}

double keep_largest(std::vector<double>& values, std::int64_t count) {
  const auto larger = [](double a, double b) { return std::isnan(a) ? !std::isnan(b) : a > b; };
  const auto kept = std::min(values.size(), static_cast<std::size_t>(count));
  std::ranges::partial_sort(values, values.begin() + static_cast<std::ptrdiff_t>(kept), larger);
  CompensatedSum others;
  for (std::size_t k = kept; k < values.size(); ++k) others.add(values[k]);
  values.resize(kept);
  return others.value();
}

std::optional<double> share_of_largest(double largest, double others) {
  const double all = largest + others;
  return all > 0 && std::isfinite(all) ? std::optional(largest / all) : std::nullopt;
}

}  // namespace halfslope
