// The variance of scrambled nets, by theory and over replicates.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/samplers/points.h"

namespace halfslope {

/// Of the mean of f = Π_j (x_j − ½) over N points under nested scrambling in base b, as A. B. Owen derives it ("Monte
/// Carlo variance of scrambled net quadrature", 1997): Var = (1/N) Σ_k Γ_k σ²_k over levels k_j ≥ 0, where σ²_k is the
/// variance of f at level k_j of each x_j, and
///   Γ_k = (1/N) Σ_(i, i') Π_j (b · [same interval of level k_j + 1] − [same interval of level k_j]) / (b − 1)
/// over all pairs of the unscrambled points. Level k of x − ½, its digit k less the mean, has the variance
/// b^(−2(k+1)) (b² − 1)/12. Where some k_j has no two points in one interval, from `levels` on, Γ = 1.
inline double product_variance(const Points& plain, int dims, std::uint64_t base, int levels) {
  const std::uint64_t count = plain.count();
  const double n = static_cast<double>(count), b = static_cast<double>(base);
  std::vector<int> k(static_cast<std::size_t>(dims));
  double excess = 0;
  for (bool more = true; more;) {
    std::vector<std::uint64_t> width(k.size());
    double variance = 1, gamma = 0;
    for (std::size_t d = 0; d < k.size(); ++d) {
      width[d] = 1;
      for (int level = 0; level < k[d]; ++level) width[d] *= base;
      variance *= (b * b - 1) / (12 * std::pow(b, 2 * (k[d] + 1)));
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      for (std::uint64_t j = 0; j < count; ++j) {
        double product = 1;
        for (std::size_t d = 0; d < k.size() && product != 0; ++d) {
          const auto at = [&](std::uint64_t point, std::uint64_t intervals) {
            return plain.interval(static_cast<int>(d), point, 0, intervals);
          };
          if (at(i, width[d]) != at(j, width[d])) {
            product = 0;
          } else {
            product *= at(i, width[d] * base) == at(j, width[d] * base) ? 1 : -1 / (b - 1);
          }
        }
        gamma += product / n;
      }
    }
    excess += (gamma - 1) * variance;
    more = false;
    for (std::size_t d = 0; d < k.size() && !more; ++d) {
      more = ++k[d] < levels;
      if (!more) k[d] = 0;
    }
  }
  return (std::pow(1.0 / 12, dims) + excess) / n;
}

/// The squared errors of kEstimates replicates against `exact`, their own spread the measure; false alarm 1e-7.
inline void expect_product_variance(const std::string& name, int dims, std::uint64_t count, double exact) {
  constexpr std::uint32_t kGroups = 2048;
  constexpr double kEstimates = kGroups * kLanes;
  const auto sampler = sampler_named(name);
  double sum = 0, squares = 0, fourths = 0;
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const Points points = points_of(*sampler, count, singles(dims), group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      double error = 0;
      for (std::uint64_t i = 0; i < count; ++i) {
        double product = 1;
        for (int d = 0; d < dims; ++d) product *= points(d, i, lane) - 0.5;
        error += product / static_cast<double>(count);
      }
      sum += error;
      squares += error * error;
      fourths += std::pow(error, 4);
    }
  }
  const double variance = squares / kEstimates;
  const double se = std::sqrt((fourths / kEstimates - variance * variance) / kEstimates);
  EXPECT_LT(std::abs(variance - exact) / se, 5.5) << name << ' ' << dims << "-D: " << variance << " for " << exact;
  EXPECT_LT(std::abs(sum) / std::sqrt(kEstimates * exact), 5.5) << "bias, " << name << ' ' << dims << "-D";
}

}  // namespace halfslope
