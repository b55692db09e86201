// Integrands that are continuous but for a derivative: ramps and kinks.
#include <numbers>

#include "scenes/integrand_table.h"

namespace halfslope {
namespace {

using std::numbers::pi;

Integrand ramp(double integral, double mean_square) {
  return of_class(Regularity::kKinked, {"", 2, {}, integral, mean_square - integral * integral});
}

// 1 within r₁, then with t = (r₂ − r)/w, w = r₂ − r₁, a profile g(t) down to 0 at r₂: the mean is
// turn (r₁²/2 + ∫ g(t) (r₂ − w t) w dt), turn the angle that lies in the square, and so for g².
Integrand linear_disk(double turn, double r1, double r2) {
  const double w = r2 - r1;
  return ramp(turn * (r1 * r1 / 2 + w * (r2 / 2 - w / 3)), turn * (r1 * r1 / 2 + w * (r2 / 3 - w / 4)));
}

// g = t²(3 − 2t): ∫ g = 1/2, ∫ t g = 7/20, ∫ g² = 13/35, ∫ t g² = 2/7.
Integrand smooth_disk(double r1, double r2) {
  const double w = r2 - r1;
  return ramp(2 * pi * (r1 * r1 / 2 + w * (r2 / 2 - w * 7 / 20)),
              2 * pi * (r1 * r1 / 2 + w * (r2 * 13 / 35 - w * 2 / 7)));
}

}  // namespace

IntegrandRows ramp_integrands() {
  // y − x has density 1 − |t|: of the square of clamp(5t, −1/2, 1/2) the ramp has 2 ∫ 25 t² (1 − t) up to 1/10, the
  // rest 1/4 · (9/10)².
  const double triangle_variance = 50 * (1e-3 / 3 - 1e-4 / 4) + 0.25 * 0.81;
  return {
      row("rampx", "1 down to 0 from x = 0.2 to x = 0.4, on the unit square; integral 3/10", papers::kChristensen,
          of_class(Regularity::kOneCoordinateKinked, ramp(0.3, 0.2 + 0.2 / 3))),
      row("quarterdiskramp", "1 down to 0 from r = 0.7 to r = 0.9, r from the corner; integral 193 pi/1200",
          papers::kChristensen, linear_disk(pi / 2, 0.7, 0.9)),
      row("fulldiskramp", "1 down to 0 from r = 0.35 to r = 0.45, r from the middle; integral 193 pi/1200",
          papers::kChristensen, linear_disk(2 * pi, 0.35, 0.45)),
      row("triangleramp", "0 up to 1 across the diagonal, 5 (y - x) + 1/2 between; integral 1/2", papers::kChristensen,
          ramp(0.5, 0.25 + triangle_variance)),
      row("smoothdisk", "1 down to 0 from r = 0.3 to r = 0.5 by smoothstep, r from the middle; C1",
          "Jarosz et al., Orthogonal array sampling for Monte Carlo rendering (2019): the ladder of smoothness",
          of_class(Regularity::kMixedDerivative, smooth_disk(0.3, 0.5))),
      row("kinkmax", "max(x + y - 1, 0), a kink on the diagonal; integral 1/6", "the shape of a basket option's payoff",
          ramp(1.0 / 6, 1.0 / 12)),
  };
}

}  // namespace halfslope
