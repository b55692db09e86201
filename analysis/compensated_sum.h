// A running sum that carries its own rounding error.
#pragma once

namespace halfslope {

/// Sum by Knuth's exact two-sum: each addition's rounding error is found exactly and added up apart. The result's
/// relative error is about ε + n ε² Σ|x| / |Σx| (T. Ogita, S. M. Rump, S. Oishi, "Accurate sum and dot product", SIAM
/// J. Sci. Comput. 26(6), 2005, algorithm 4.1). A non-finite term makes the result non-finite.
class CompensatedSum {
 public:
  void add(double term) {
    const double sum = sum_ + term;
    const double rounded = sum - sum_;
    error_ += (sum_ - (sum - rounded)) + (term - rounded);
    sum_ = sum;
  }
  double value() const { return sum_ + error_; }

 private:
  double sum_ = 0, error_ = 0;
};

}  // namespace halfslope
