// Cumulants: the moments that add where independent numbers do.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace halfslope {

/// κ_1 … κ_8 of a law: κ_1 is its mean, κ_2 its variance, κ_3/κ_2^(3/2) its skewness and 3 + κ_4/κ_2² its kurtosis K.
struct Cumulants {
  static constexpr std::size_t kHighest = 8;
  std::array<double, kHighest + 1> orders = {};  ///< [j] is κ_j; [0] is not used

  double operator[](std::size_t j) const { return orders[j]; }
  double skewness() const;
  double kurtosis() const;

  /// Makes this the law of the sum with `times` independent numbers of the other law, each times `factor`:
  /// κ_j += times · factor^j · κ_j'.
  void add(const Cumulants& other, double times, double factor = 1);
  /// Of the mean of so many independent numbers: κ_j / count^(j−1).
  Cumulants of_mean(double count) const;
};

/// From the mean and the central moments μ_j = E (X − EX)^j, j = 2 … 8, of which moments[j] are read:
/// κ_n = μ_n − Σ_{j=2}^{n−2} C(n−1, j−1) κ_j μ_{n−j} (P. J. Smith, "A recursive formulation of the old problem of
/// obtaining moments from cumulants and vice versa", The American Statistician 49, 1995, about the mean).
Cumulants cumulants_from_central_moments(double mean, std::span<const double, Cumulants::kHighest + 1> moments);

}  // namespace halfslope
