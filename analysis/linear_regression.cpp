#include "analysis/linear_regression.h"

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "analysis/compensated_sum.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

std::optional<LinearFit> solve(Matrix columns, std::span<const double> values, bool constant) {
  const Eigen::Index n = columns.rows(), p = columns.cols();
  Vector y(n);
  for (Eigen::Index i = 0; i < n; ++i) y(i) = values[static_cast<std::size_t>(i)];
  if (n < p || p == 0 || !columns.allFinite() || !y.allFinite()) return std::nullopt;
  const Vector norms = columns.colwise().norm();
  if (!(norms.array() > 0).all()) return std::nullopt;
  columns.array().rowwise() /= norms.transpose().array();
  const Eigen::ColPivHouseholderQR<Matrix> qr(columns);
  if (qr.rank() < p) return std::nullopt;
  Vector beta = qr.solve(y);
  const Vector residual = y - columns * beta;
  beta += qr.solve(residual);  // a step of refinement takes off most of what rounding left
  LinearFit fit;
  const long double squares = (y - columns * beta).squaredNorm();
  for (Eigen::Index k = 0; k < p; ++k) fit.coefficients.push_back(static_cast<double>(beta(k) / norms(k)));
  const long double centre = constant ? y.mean() : 0.0L;
  fit.r_squared = static_cast<double>(1 - squares / (y.array() - centre).matrix().squaredNorm());
  if (n == p) return fit;
  const long double s = std::sqrt(squares / static_cast<long double>(n - p));
  fit.residual_sd = static_cast<double>(s);
  // (XᵀX)⁻¹ = P R⁻¹ R⁻ᵀ Pᵀ: its diagonal has the squared norms of the rows of P R⁻¹.
  const Matrix r = qr.matrixR().topLeftCorner(p, p);
  const Matrix inverse = qr.colsPermutation() * Matrix(r.triangularView<Eigen::Upper>().solve(Matrix::Identity(p, p)));
  for (Eigen::Index k = 0; k < p; ++k)
    fit.standard_errors.push_back(static_cast<double>(s * inverse.row(k).norm() / norms(k)));
  return fit;
}

}  // namespace

std::optional<LinearFit> fit_linear(std::span<const std::vector<double>> regressors, std::span<const double> y,
                                    bool constant) {
  const Eigen::Index first = constant ? 1 : 0;
  Matrix columns(static_cast<Eigen::Index>(y.size()), static_cast<Eigen::Index>(regressors.size()) + first);
  if (constant) columns.col(0).setOnes();
  for (std::size_t k = 0; k < regressors.size(); ++k) {
    assert_equal(regressors[k].size(), y.size(), "values of a regressor");
    for (std::size_t i = 0; i < y.size(); ++i)
      columns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k) + first) = regressors[k][i];
  }
  return solve(std::move(columns), y, constant);
}

std::optional<LinearFit> fit_polynomial(std::span<const double> x, std::span<const double> y, int degree,
                                        bool constant) {
  assert_equal(x.size(), y.size(), "values of x");
  const int first = constant ? 0 : 1;
  Matrix columns(static_cast<Eigen::Index>(y.size()), degree + 1 - first);
  for (std::size_t i = 0; i < y.size(); ++i) {
    long double power = constant ? 1.0L : static_cast<long double>(x[i]);
    for (int k = first; k <= degree; ++k, power *= x[i]) columns(static_cast<Eigen::Index>(i), k - first) = power;
  }
  return solve(std::move(columns), y, constant);
}

double autocorrelation(std::span<const double> values, std::size_t lag) {
  const std::size_t n = values.size();
  if (n <= lag) return std::numeric_limits<double>::quiet_NaN();
  CompensatedSum sum, rest;
  for (const double x : values) sum.add(x);
  const double centre = sum.value() / static_cast<double>(n);
  for (const double x : values) rest.add(x - centre);  // what the mean's rounding leaves
  const double left = rest.value() / static_cast<double>(n);
  const auto deviation = [&](std::size_t i) { return (values[i] - centre) - left; };
  CompensatedSum products, squares;
  for (std::size_t i = 0; i < n; ++i) {
    squares.add(deviation(i) * deviation(i));
    if (i + lag < n) products.add(deviation(i) * deviation(i + lag));
  }
  return products.value() / squares.value();
}

}  // namespace halfslope
