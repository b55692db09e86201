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

Integrand cap(const std::string& subject, const Parameters& values) {
  const double n = values.number("n"), alpha = values.number("alpha");
  if (n < 0) fail(ExitCode::kBadInput, "{}: n must be at least 0, found {}", subject, n);
  if (!(alpha > 0 && alpha <= std::numbers::pi / 2)) {
    fail(ExitCode::kBadInput, "{}: alpha is a half-angle in radians, in (0, pi/2]; found {}", subject, alpha);
  }
  const double half_sine = std::sin(alpha / 2), v_max = std::min(1.0, 2 * half_sine * half_sine);
  return {"", 1, {n, v_max}, -std::expm1((n + 1) * std::log1p(-v_max)), std::nullopt, light_and_bsdf()};
}

}  // namespace

IntegrandRows mis_integrands() {
  return {
      row("mis-toy", "f(x) = x on [0,1]; 'light' has density 1, 'bsdf' has density 2x; integral 1/2",
          "the smallest problem on which every heuristic has an exact variance",
          {"", 1, {}, 0.5, std::nullopt, light_and_bsdf()}),
      {{"aligned-phong-cap", "n=EXPONENT,alpha=RADIANS",
        "a Phong lobe and a light that fills a cone about its axis; integral 1 - cos(alpha)^(n+1)",
        "a multiple importance sampling problem whose variance is known for every heuristic"},
       {{"n"}, {"alpha"}},
       cap},
  };
}

}  // namespace halfslope
