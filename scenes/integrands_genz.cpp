// A. Genz's six families. Their parameters are those of published tables: a_i = h (i − 1/2)/d² to four decimals, whose
// sum h/2 is the same in every dimension, and fixed centres u_i.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "scenes/integrand_table.h"

namespace halfslope {
namespace {

using Real = long double;
using std::numbers::pi;

constexpr int kMostDims = 6;
constexpr std::array<double, kMostDims> kCentres = {0.5, 0.2326, 0.6652, 0.3979, 0.8305, 0.5631};
constexpr Real kPi = std::numbers::pi_v<Real>;

std::vector<double> widths(double h, int dims) {
  std::vector<double> a;
  for (int i = 0; i < dims; ++i) a.push_back(std::stod(fmt::format("{:.4f}", h * (i + 0.5) / (dims * dims))));
  return a;
}

// `a`, then the first centres.
std::vector<double> with_centres(std::vector<double> a) {
  const auto dims = static_cast<std::ptrdiff_t>(a.size());
  a.insert(a.end(), kCentres.begin(), kCentres.begin() + dims);
  return a;
}

Integrand of_moments(const std::vector<double>& a, std::vector<double> parameters, Real integral, Real mean_square) {
  Integrand integrand = {"", static_cast<int>(a.size()), std::move(parameters), static_cast<double>(integral),
                         static_cast<double>(mean_square - integral * integral)};
  integrand.regularity = Regularity::kSmooth;
  return integrand;
}

// Where f = ∏ f_i: the products of the factors' moments; `factor(k, i, a, u)` is ∫ f_i^k.
template <class Factor>
Integrand product(const std::vector<double>& a, std::vector<double> parameters, Factor factor) {
  Real integral = 1, mean_square = 1;
  for (std::size_t i = 0; i < a.size(); ++i) {
    integral *= factor(1, i, static_cast<Real>(a[i]), static_cast<Real>(kCentres[i]));
    mean_square *= factor(2, i, static_cast<Real>(a[i]), static_cast<Real>(kCentres[i]));
  }
  return of_moments(a, std::move(parameters), integral, mean_square);
}

// E cos(k (2πu₁ + Σ a_i x_i)) = cos(k (2πu₁ + Σ a_i/2)) ∏ sin(k a_i/2)/(k a_i/2); f² = (1 + cos 2…)/2.
Integrand oscillatory(int dims) {
  const std::vector<double> a = widths(9, dims);
  const auto mean_cosine = [&](Real k) {
    Real angle = 2 * kPi * kCentres[0], damping = 1;
    for (const double width : a) {
      const Real half = k * width / 2;
      angle += static_cast<Real>(width) / 2;
      damping *= std::sin(half) / half;
    }
    return std::cos(k * angle) * damping;
  };
  std::vector<double> parameters;
  for (const double width : a) parameters.push_back(width / (2 * pi));
  parameters.push_back(kCentres[0]);
  return of_moments(a, parameters, mean_cosine(1), (1 + mean_cosine(2)) / 2);
}

// With b = 1/a, ∫ (b² + t²)⁻¹ = atan(t/b)/b and ∫ (b² + t²)⁻² = (t/(b² + t²) + atan(t/b)/b)/(2b²).
Integrand product_peak(int dims) {
  const std::vector<double> a = widths(7.25, dims);
  std::vector<double> parameters;
  for (const double width : a) parameters.push_back(1 / (width * width));
  parameters.insert(parameters.end(), kCentres.begin(), kCentres.begin() + dims);
  return product(a, parameters, [](int k, std::size_t, Real width, Real u) {
    const auto up_to = [&](Real t) {
      const Real b2 = 1 / (width * width), first = std::atan(t * width) * width;
      return k == 1 ? first : (t / (b2 + t * t) + first) / (2 * b2);
    };
    return up_to(1 - u) + up_to(u);
  });
}

// ∫ (1 + a·x)^−(p + d) = 1/(p (p + 1) … (p + d − 1) ∏ a) Σ over the corners v of (−1)^|v| (1 + a·v)^−p; p = 1 for f,
// d + 2 for f². In six dimensions the sum has lost four digits of 19.
Integrand corner_peak(int dims) {
  const std::vector<double> a = widths(1.85, dims);
  const auto moment = [&](int p) {
    Real sum = 0, scale = 1;
    for (unsigned corner = 0; corner < 1u << dims; ++corner) {
      Real base = 1, sign = 1;
      for (std::size_t i = 0; i < a.size(); ++i) {
        if (corner >> i & 1) base += a[i], sign = -sign;
      }
      for (int k = 0; k < p; ++k) sign /= base;
      sum += sign;
    }
    for (std::size_t i = 0; i < a.size(); ++i)
      scale *= static_cast<Real>(a[i]) * static_cast<Real>(p + static_cast<int>(i));
    return sum / scale;
  };
  return of_moments(a, a, moment(1), moment(dims + 2));
}

// ∫ exp(−k a² (x − u)²) = √(π/k)/(2a) (erf(√k a (1 − u)) + erf(√k a u)).
Integrand gaussian(int dims) {
  const std::vector<double> a = widths(7.03, dims);
  return product(a, with_centres(a), [](int k, std::size_t, Real width, Real u) {
    const Real scaled = std::sqrt(static_cast<Real>(k)) * width;
    return std::sqrt(kPi) / (2 * scaled) * (std::erf(scaled * (1 - u)) + std::erf(scaled * u));
  });
}

Integrand continuous(int dims) {
  const std::vector<double> a = widths(8, dims);
  return of_class(Regularity::kMixedDerivative, product(a, with_centres(a), [](int k, std::size_t, Real width, Real u) {
                    return -(std::expm1(-k * width * u) + std::expm1(-k * width * (1 - u))) / (k * width);
                  }));
}

// Cut off in the first two dimensions only.
Integrand discontinuous(int dims) {
  const std::vector<double> a = widths(4.3, dims);
  return of_class(Regularity::kAxisJump, product(a, with_centres(a), [](int k, std::size_t i, Real width, Real u) {
                    return std::expm1(k * width * (i < 2 ? u : 1)) / (k * width);
                  }));
}

}  // namespace

IntegrandRows genz_integrands() {
  const auto family = [](const char* name, const char* description, Integrand (*make)(int)) {
    return row_of_dims(name, 1, kMostDims, description, papers::kGenz, make);
  };
  return {
      family("genz-oscillatory", "cos(2 pi u_1 + sum a_i x_i) in the unit cube of 1 to 6 dimensions", oscillatory),
      family("genz-productpeak", "product of 1/(1/a_i^2 + (x_i - u_i)^2) in 1 to 6 dimensions", product_peak),
      family("genz-cornerpeak", "(1 + sum a_i x_i)^-(d + 1), a peak in the corner, in 1 to 6 dimensions", corner_peak),
      family("genz-gaussian", "a smooth peak in the unit cube of 1 to 6 dimensions; integral by erf", gaussian),
      family("genz-continuous", "exp(-sum a_i |x_i - u_i|), kinks along the axes, in 1 to 6 dimensions", continuous),
      family("genz-discontinuous", "exp(sum a_i x_i) where x_1 <= u_1 and x_2 <= u_2, else 0, in 1 to 6 dimensions",
             discontinuous),
  };
}

}  // namespace halfslope
