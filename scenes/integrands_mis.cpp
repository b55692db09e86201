// Problems of multiple importance sampling, small enough that the variance of every heuristic is known.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "scenes/integrand_table.h"

namespace halfslope {
namespace {

const std::vector<Technique>& light_and_bsdf() {
  static const std::vector<Technique> kTechniques = {{"light", {{1}}}, {"bsdf", {{1}}}};
  return kTechniques;
}

ExactDensities toy_densities() {
  return {{0, 1}, [](double x, std::span<double> pdfs) {
            pdfs[0] = 1;
            pdfs[1] = 2 * x;
            return x;
          }};
}

// In v = 1 − cos θ, 2π of azimuth in all three.
ExactDensities cap_densities(double n, double v_max) {
  std::vector<double> breaks = {0, v_max, 1};
  for (const double widths : {1, 4, 16, 64}) {  // of the lobe, which is e⁻ⁿᵛ about
    if (widths / (n + 1) < 1) breaks.push_back(widths / (n + 1));
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return {breaks, [n, v_max](double v, std::span<double> pdfs) {
            const bool inside = v <= v_max;
            pdfs[0] = inside ? 1 / v_max : 0;
            pdfs[1] = (n + 1) * std::exp(n * std::log1p(-v));
            return inside ? pdfs[1] : 0;
          }};
}

Integrand cap(const std::string& subject, const Parameters& values) {
  const double n = values.number("n"), alpha = values.number("alpha");
  if (n < 0) fail(ExitCode::kBadInput, "{}: n must be at least 0, found {}", subject, n);
  if (!(alpha > 0 && alpha <= std::numbers::pi / 2)) {
    fail(ExitCode::kBadInput, "{}: alpha is a half-angle in radians, in (0, pi/2]; found {}", subject, alpha);
  }
  const double half_sine = std::sin(alpha / 2), v_max = std::min(1.0, 2 * half_sine * half_sine);
  return {"",
          1,
          {n, v_max},
          -std::expm1((n + 1) * std::log1p(-v_max)),
          std::nullopt,
          light_and_bsdf(),
          cap_densities(n, v_max)};
}

}  // namespace

IntegrandRows mis_integrands() {
  return {
      row("mis-toy", "f(x) = x on [0,1]; 'light' has density 1, 'bsdf' has density 2x; integral 1/2",
          "the smallest problem on which every heuristic has an exact variance",
          {"", 1, {}, 0.5, std::nullopt, light_and_bsdf(), toy_densities()}),
      {{"aligned-phong-cap", "n=EXPONENT,alpha=RADIANS",
        "a Phong lobe and a light that fills a cone about its axis; integral 1 - cos(alpha)^(n+1)",
        "a multiple importance sampling problem whose variance is known for every heuristic"},
       {{"n"}, {"alpha"}},
       cap},
  };
}

}  // namespace halfslope
