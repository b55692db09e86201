// Numbers of 106 bits as the unevaluated sum of two binary64: for sums that cancel.
#pragma once

#include <cmath>

namespace halfslope {

/// high + low with |low| ≤ ulp(high)/2. Sums, products and quotients are right to about 2⁻¹⁰⁴ of the result. T. J.
/// Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18, 1971; the forms are
/// those of M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building blocks of
/// double-word arithmetic", ACM TOMS 44(2), 2017. Needs arithmetic without contraction and rounding to nearest.
struct DoubleDouble {
  double high = 0, low = 0;

  double value() const { return high + low; }

  /// a + b, exactly.
  static DoubleDouble sum(double a, double b) {
    const double s = a + b, rounded = s - a;
    return {s, (a - (s - rounded)) + (b - rounded)};
  }
  /// a · b, exactly, short of underflow.
  static DoubleDouble product(double a, double b) {
    const double p = a * b;
    return {p, std::fma(a, b, -p)};
  }

  friend DoubleDouble operator-(DoubleDouble a) { return {-a.high, -a.low}; }
  friend DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble high = sum(a.high, b.high), low = sum(a.low, b.low);
    const DoubleDouble first = normal(high.high, high.low + low.high);
    return normal(first.high, first.low + low.low);
  }
  friend DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
  friend DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble p = product(a.high, b.high);
    return normal(p.high, p.low + (a.high * b.low + a.low * b.high));
  }
  friend DoubleDouble operator*(DoubleDouble a, double b) { return a * DoubleDouble{b, 0}; }
  friend DoubleDouble operator/(DoubleDouble a, double b) {
    const double quotient = a.high / b;
    return normal(quotient, (a - product(quotient, b)).value() / b);
  }

 private:
  // A sum whose first term is not the smaller one.
  static DoubleDouble normal(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
};

}  // namespace halfslope
