// Count, mean and central sums of a sample, mergeable.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <type_traits>

namespace halfslope {

/// The first four moments of the values added so far. With x̄ their mean and d = x − x̄, it keeps n, x̄ and the central
/// sums M_k = Σ d^k, k = 2, 3, 4: unlike Σ x^k, these do not lose the spread of values that lie far from 0.
///
/// A plain value of five 8-byte fields without padding, so it may be stored as raw bytes. Values must be finite for the
/// results to be; a non-finite one makes every moment non-finite.
struct Moments {
  std::int64_t count = 0;
  double mean = 0;
  double central2 = 0, central3 = 0, central4 = 0;  ///< M_2, M_3, M_4

  void add(double value) { merge({1, value, 0, 0, 0}); }

  /// Adds all values at once, in two passes with compensated sums: more exact than one by one, and the way to go when
  /// the spread is tiny beside the mean.
  void add(std::span<const double> values);

  /// Makes this the moments of both samples. P. Pébay, "Formulas for robust, one-pass parallel computation of
  /// covariances and arbitrary-order statistical moments", SAND2008-6212, 2008, equations 3.1 to 3.4. Derivation in
  /// moments.cpp.
  void merge(const Moments& other);

  double variance() const { return central2 / static_cast<double>(count - 1); }  ///< over n − 1; NaN below two values
  double standard_error() const { return std::sqrt(variance() / static_cast<double>(count)); }  ///< of the mean
  double m2() const { return central2 / static_cast<double>(count); }                           ///< M_2 / n
  double m3() const { return central3 / static_cast<double>(count); }                           ///< M_3 / n
  double m4() const { return central4 / static_cast<double>(count); }                           ///< M_4 / n
};

static_assert(std::is_trivially_copyable_v<Moments> && sizeof(Moments) == 40);

}  // namespace halfslope
