// Products and sums over any number of dimensions.
#include <cmath>

#include "scenes/integrand_table.h"
#include "scenes/kernels.h"

namespace halfslope {
namespace {

using enum Regularity;

// (1 + v)^d − 1: the variance of a product of d factors of mean 1 and variance v.
double product_variance(double v, int dims) { return std::expm1(dims * std::log1p(v)); }

// A. Saltelli's a = 0, 1, 9/2, 9, 99, 99, …, and in six dimensions the set that is published for them. A factor's
// variance is 1/(3 (1 + a)²).
Integrand sobol_g(int dims) {
  std::vector<double> a = {0, 1, 4.5, 9};
  if (dims == 6) a = {0, 0.5, 3, 9};
  a.resize(static_cast<std::size_t>(dims), 99);
  Integrand integrand = {"", dims, {}, 1, 0};
  double logarithm = 0;
  for (const double x : a) {
    integrand.parameters.push_back(x / (1 + x));
    logarithm += std::log1p(1 / (3 * (1 + x) * (1 + x)));
  }
  for (const double x : a) integrand.parameters.push_back(1 / (1 + x));
  integrand.variance = std::expm1(logarithm);
  return of_class(kMixedDerivative, integrand);
}

// S = Σ x_i has the mean d/2 and the cumulants κ₂ = d/12, κ₃ = 0, κ₄ = −d/120: E S² = d²/4 + κ₂, and Var S² =
// 4 (d/2)² κ₂ + 2κ₂² + κ₄.
Integrand sum_squared(int dims) {
  const double d = dims;
  return of_class(kSmooth, {"", dims, {}, d / 12 + d * d / 4, d * d * d / 12 + d * d / 72 - d / 120});
}

// ∫ x^(1/d) = d/(d + 1) and ∫ x^(2/d) = d/(d + 2), so a factor's variance is 1/(d (d + 2)).
Integrand morokoff(int dims) {
  const double d = dims;
  return {"", dims, {1 / d, std::pow(1 + 1 / d, d)}, 1, product_variance(1 / (d * (d + 2)), dims)};
}

Integrand subcube(int dims) {
  const double scale = 1 / (dims - 0.5);
  return of_class(kSmooth,
                  {"", dims, {static_cast<double>(dims), scale}, 1, product_variance(scale * scale / 12, dims)});
}

// With P_i = x₁ … x_i, E P_i P_j = 3^−i 2^−(j − i) for i ≤ j.
Integrand bratley(int dims) {
  double mean_square = 0;
  for (int i = 1; i <= dims; ++i) {
    for (int j = i; j <= dims; ++j) {
      const double moment = std::pow(3.0, -i) * std::ldexp(i == j ? 1.0 : 2.0, i - j);
      mean_square += (j - i) % 2 == 0 ? moment : -moment;
    }
  }
  const double mean = -(1 - std::ldexp(dims % 2 == 0 ? 1.0 : -1.0, -dims)) / 3;
  return of_class(kSmooth, {"", dims, {}, mean, mean_square - mean * mean});
}

}  // namespace

IntegrandRows product_integrands() {
  const auto family = [](const char* name, const char* description, const char* reference,
                         std::function<Integrand(int)> make) {
    return row_of_dims(name, 1, kMostIntegrandDims, description, reference, std::move(make));
  };
  return {
      family("sobol-g", "product of (|4 x_i - 2| + a_i)/(1 + a_i): dimensions of falling importance; integral 1",
             "Saltelli & Sobol', About the use of rank transformation in sensitivity analysis (1995)", sobol_g),
      family("sumsq", "(x_1 + ... + x_d)^2; integral d/3 + d (d - 1)/4", "the convergence example of scipy.stats.qmc",
             sum_squared),
      family("oddprod", "product of sqrt(12) (x_i - 1/2), an interaction of all dimensions at once; integral 0",
             "Owen, Monte Carlo theory, methods and examples: the analysis of variance",
             [](int d) {
               return of_class(kSmooth, {"", d, {}, 0, 1});
             }),
      family("morokoff", "(1 + 1/d)^d product of x_i^(1/d): infinite slopes at the axes; integral 1", papers::kMorokoff,
             morokoff),
      family("subcube", "product of (d - x_i)/(d - 1/2), nearly a sum; integral 1", papers::kMorokoff, subcube),
      family("bratley", "sum over i of (-1)^i x_1 ... x_i; integral -(1 - (-1/2)^d)/3",
             "Bratley, Fox & Niederreiter, Implementation and tests of low-discrepancy sequences (1992)", bratley),
      family("bernoulli2", "product of 1 + B_2(x_i), B_2 = x^2 - x + 1/6: periodic, a kink; integral 1",
             "Sloan & Joe, Lattice methods for multiple integration (1994)",
             [](int d) {
               return of_class(kSmooth, {"", d, {}, 1, product_variance(1.0 / 180, d)});
             }),
  };
}

}  // namespace halfslope
