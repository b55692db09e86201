// Linear least squares by QR: more digits than the normal equations leave.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace halfslope {

/// y ≈ Σ_k β_k x_k.
struct LinearFit {
  std::vector<double> coefficients;     ///< β; of the constant first, where there is one
  std::vector<double> standard_errors;  ///< s √(XᵀX)⁻¹_kk; empty where there are as many coefficients as values
  double residual_sd = 0;               ///< s = √(Σ residual² / (n − p)); 0 likewise
  double r_squared = 0;  ///< 1 − Σ residual² / Σ (y − ȳ)²; without a constant about 0 instead of ȳ
};

/// Householder QR with column pivoting of the matrix whose columns are scaled to one norm (G. Golub, C. Van Loan,
/// "Matrix Computations", section 5.4), in long double: its error grows with the condition number, that of the normal
/// equations with its square. `regressors` are columns as long as y; `constant` adds one of ones. The standard errors
/// suppose residuals that are independent and alike. Empty where the columns are linearly dependent to working
/// precision, there are fewer values than coefficients, or a number is not finite. Lengths that differ are a
/// programmer's error.
std::optional<LinearFit> fit_linear(std::span<const std::vector<double>> regressors, std::span<const double> y,
                                    bool constant = true);

/// A polynomial, its coefficients by ascending power. Powers are taken in long double.
std::optional<LinearFit> fit_polynomial(std::span<const double> x, std::span<const double> y, int degree,
                                        bool constant = true);

/// Lag-`lag` autocorrelation: Σ_i (x_i − x̄)(x_{i+lag} − x̄) / Σ_i (x_i − x̄)². 1 at lag 0; NaN where all values are equal
/// or there are at most `lag` of them.
double autocorrelation(std::span<const double> values, std::size_t lag = 1);

}  // namespace halfslope
