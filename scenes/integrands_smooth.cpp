// Integrands without jumps or kinks, from constant in a dimension to wild.
#include <cmath>
#include <numbers>

#include "scenes/integrand_table.h"

namespace halfslope {
namespace {

using std::numbers::pi;
using Real = long double;

Integrand of_moments(Real integral, Real mean_square, int dims = 2) {
  return of_class(
      Regularity::kSmooth,
      {"", dims, {}, static_cast<double>(integral), static_cast<double>(mean_square - integral * integral)});
}

// J(s) = ∫∫ (x² + y² + s)⁻² = g(q)/s with q = 1 + s and g = atan(1/√q)/√q; then ∫∫ (x² + y² + s)⁻⁴ = J″/6. f is
// s/π (x² + y² + s)⁻², s = 1/4.
Integrand form_factor() {
  const Real s = 0.25L, q = 1 + s, root = std::sqrt(q), angle = std::atan(1 / root), sum = q * q + q;
  const Real g = angle / root, g1 = -angle / (2 * q * root) - 1 / (2 * sum);
  const Real g2 = 3 * angle / (4 * q * q * root) + 1 / (4 * q * q * (q + 1)) + (2 * q + 1) / (2 * sum * sum);
  const Real second = g2 / s - 2 * g1 / (s * s) + 2 * g / (s * s * s), scale = s / std::numbers::pi_v<Real>;
  return of_moments(scale * g / s, scale * scale * second / 6);
}

// E cos(c |y|) for y normal with variance 1/2 in each of d dimensions, whose E |y|^2k = d/2 (d/2 + 1) … (d/2 + k − 1).
Real mean_cosine(Real c, int dims) {
  Real sum = 0, term = 1;
  for (int k = 0; k < 100; ++k) {
    sum += term;
    term *=
        -c * c * (dims / 2.0L + static_cast<Real>(k)) / (static_cast<Real>(2 * k + 1) * static_cast<Real>(2 * k + 2));
  }
  return sum;
}

Integrand of_x(Real integral, Real mean_square) {
  return of_class(Regularity::kOneCoordinateSmooth, of_moments(integral, mean_square));
}

Integrand keister(int dims) {
  const Real scale = std::pow(std::numbers::pi_v<Real>, dims / 2.0L);
  Integrand integrand = of_moments(scale * mean_cosine(1, dims), scale * scale * (1 + mean_cosine(2, dims)) / 2, dims);
  integrand.parameters = {static_cast<double>(scale)};
  return of_class(Regularity::kSquareIntegrable, integrand);  // slopes at the faces are infinite
}

// With A = 7 and B = 1/10: A²/8 + B π⁴/5 + B² π⁸/18 + 1/2.
Integrand ishigami() {
  const double pi4 = pi * pi * pi * pi;
  return of_class(Regularity::kSmooth, {"", 3, {}, 3.5, 49.0 / 8 + 0.1 * pi4 / 5 + 0.01 * pi4 * pi4 / 18 + 0.5});
}

}  // namespace

IntegrandRows smooth_integrands() {
  const Real euler = std::numbers::e_v<Real>, two_over_pi = 2 / std::numbers::pi_v<Real>;
  // ∫ exp(−t²) and ∫ exp(−2t²), over [0, 1] and over [−1/2, 1/2].
  const Real root_pi = 1 / std::numbers::inv_sqrtpi_v<Real>, root_half = std::sqrt(0.5L);
  const Real quarter_mean = root_pi / 2 * std::erf(1.0L);
  const Real quarter_square = root_pi / 2 * root_half * std::erf(std::numbers::sqrt2_v<Real>);
  const Real full_mean = root_pi * std::erf(0.5L), full_square = root_pi * root_half * std::erf(root_half);
  // (1 + C² − S²)/2 with Fresnel's C = ∫ cos 100x², S = ∫ sin 100x²; the mean square likewise with 200x² too.
  const Integrand zone_plate =
      of_class(Regularity::kSmooth, {"", 2, {}, 0.500103398841961706190, 0.124989615867884439076});
  // In polar coordinates π/2 ∫ sin(πu)/u³ from u = 1 on, and ∫ r sin(π/r) (π/2 − 2 acos(1/r)) from 1 to √2; the mean
  // square is 1/2 less half of the same of cos(2π/r).
  const Integrand sin_inverse = {"", 2, {}, -0.220241343328175568202, 0.332071740519815227782};
  return {
      row("linearx", "x, on the unit square; integral 1/2", papers::kChristensen, of_x(0.5L, 1 / 3.0L)),
      row("gaussx", "exp(-x^2), on the unit square; integral sqrt(pi)/2 erf(1)", papers::kChristensen,
          of_x(quarter_mean, quarter_square)),
      row("sinpix", "sin(pi x), on the unit square; integral 2/pi", papers::kChristensen, of_x(two_over_pi, 0.5L)),
      row("sin2pix", "sin(2 pi x), on the unit square: odd, periodic; integral 0", papers::kChristensen, of_x(0, 0.5L)),
      row("quartergaussian", "exp(-x^2 - y^2) on the unit square; integral pi/4 erf(1)^2", papers::kChristensen,
          of_moments(quarter_mean * quarter_mean, quarter_square * quarter_square)),
      row("fullgaussian", "exp(-(x - 1/2)^2 - (y - 1/2)^2) on the unit square; integral pi erf(1/2)^2",
          papers::kChristensen, of_moments(full_mean * full_mean, full_square * full_square)),
      row("bilinear", "x y on the unit square; integral 1/4", papers::kChristensen, of_moments(0.25L, 1 / 9.0L)),
      row("biquadratic", "x^2 y^2 on the unit square; integral 1/9", papers::kChristensen,
          of_moments(1 / 9.0L, 1 / 25.0L)),
      row("sinxy", "sin(pi (x + y)) on the unit square: odd about the middle; integral 0", papers::kChristensen,
          of_moments(0, 0.5L)),
      row("expprod", "x exp(x y) on the unit square; integral e - 2",
          "Owen, Local antithetic sampling with scrambled nets (2008)",
          of_moments(euler - 2, (euler * euler + 1) / 8 - 0.25L)),
      row("formfactor-rect",
          "irradiance below the corner of a unit square light at height 1/2, c^2/(pi (x^2 + y^2 + c^2)^2)",
          "Howell, A catalog of radiation heat transfer configuration factors, B-3", form_factor()),
      row("ishigami", "sin t1 + 7 sin^2 t2 + t3^4/10 sin t1, t = pi (2 x - 1), in three dimensions; integral 7/2",
          "Ishigami & Homma, An importance quantification technique in uncertainty analysis (1990)", ishigami()),
      row_of_dims("keister", 1, 12, "pi^(d/2) cos(|z|/sqrt 2), z normal by the inverse of its distribution",
                  "Keister, Multidimensional quadrature algorithms (1996)", keister),
      row("zoneplate100", "1/2 + cos(100 (x^2 + y^2))/2: smooth, but finer than N points below some thousands",
          "a zone plate, as papers on sampling show it", zone_plate),
      row("sininvr", "sin(pi/r), r from the corner: of unbounded variation at the origin, where it counts as 0",
          papers::kChristensen, sin_inverse),
  };
}

}  // namespace halfslope
