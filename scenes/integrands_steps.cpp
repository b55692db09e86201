// Integrands of two values: what part of the cube a region fills is their integral p, and p (1 − p) their variance.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/error.h"
#include "scenes/integrand_table.h"
#include "scenes/kernels.h"

namespace halfslope {
namespace {

Integrand jump(Integrand integrand) { return of_class(Regularity::kJump, std::move(integrand)); }

Integrand step(double p) { return jump({"", 2, {}, p, step_variance(p)}); }

// The part of the unit cube where w·x > c. With x → 1 − x wherever w is negative, all weights are |w| and c grows by
// those; then one minus the corner below the plane, by inclusion and exclusion over the vertices v:
// 1/(d! ∏|w|) Σ (−1)^|v| max(0, c − |w|·v)^d. Up to six dimensions its terms are of the order of the sum.
double halfspace_volume(std::span<const double> weights, double c) {
  const std::size_t dims = weights.size();
  long double corner = c, scale = 1, sum = 0;
  for (std::size_t i = 0; i < dims; ++i) {
    corner += std::max(0.0, -weights[i]);
    scale *= static_cast<long double>(i + 1) * std::fabs(weights[i]);
  }
  for (unsigned vertex = 0; vertex < 1u << dims; ++vertex) {
    long double rest = corner, power = 1;
    for (std::size_t i = 0; i < dims; ++i) {
      if (vertex >> i & 1) {
        rest -= std::fabs(weights[i]);
        power = -power;
      }
    }
    if (rest <= 0) continue;
    for (std::size_t i = 0; i < dims; ++i) power *= rest;
    sum += power;
  }
  return static_cast<double>(1 - sum / scale);
}

// Weights one over the root of a prime, so that the plane is in general position; signs that lead it through the
// middle of the cube.
Integrand halfspace(int dims) {
  const double r2 = 1 / std::sqrt(2.0), r3 = 1 / std::sqrt(3.0), r5 = 1 / std::sqrt(5.0), r7 = 1 / std::sqrt(7.0),
               r11 = 1 / std::sqrt(11.0);
  const std::vector<double> weights[6] = {
      {r2}, {1, -r2}, {1, -r2, r3}, {1, r2, -r3, -r5}, {1, r2, -r3, -r5, r7}, {1, r2, -r3, -r5, r7, -r11}};
  const std::vector<double>& own = weights[dims - 1];
  const double p = halfspace_volume(own, 0.1);
  return jump({"", dims, own, p, step_variance(p)});
}

// π^(d/2) r^d / Γ(d/2 + 1), by V_d = V_(d−2) 2π r²/d from V_0 = 1 and V_1 = 2r.
Integrand ball(const std::string& subject, const Parameters& values) {
  const int dims = values.whole(subject, "d", 1, kMostIntegrandDims);
  const double r = values.number("r");
  if (!(r > 0 && r <= 0.5)) {
    fail(ExitCode::kBadInput, "{}: r is the radius of a ball in the unit cube, in (0, 0.5]; found {}", subject, r);
  }
  double p = dims % 2 == 1 ? 2 * r : 1;
  for (int d = dims % 2 == 1 ? 3 : 2; d <= dims; d += 2) p *= 2 * std::numbers::pi * r * r / d;
  return jump({"", dims, {r * r}, p, step_variance(p)});
}

// Squares whose row and column add up to an odd number: ⌊n²/2⌋ of n².
Integrand checker(const std::string& subject, const Parameters& values) {
  const int n = values.whole(subject, "n", 2, 1024);
  Integrand integrand = step(static_cast<double>(n * n / 2) / (static_cast<double>(n) * n));
  integrand.parameters = {static_cast<double>(n)};
  return of_class(Regularity::kAxisJump, integrand);
}

}  // namespace

IntegrandRows step_integrands() {
  using enum Regularity;
  using std::numbers::inv_pi, std::numbers::phi;
  return {
      row("stepx", "1 where x < 1/pi, on the unit square; integral 1/pi", papers::kChristensen,
          of_class(kOneCoordinateJump, step(inv_pi))),
      row("quarterdisk", "1 where x^2 + y^2 < 2/pi, on the unit square; integral 1/2", papers::kChristensen, step(0.5)),
      row("fulldisk", "1 where (x - 1/2)^2 + (y - 1/2)^2 < 1/(2 pi), on the unit square; integral 1/2",
          papers::kChristensen, step(0.5)),
      row("triangle", "1 where x + y < 1, an edge at 45 degrees that grids and nets resonate with; integral 1/2",
          papers::kChristensen, step(0.5)),
      row("halfplane", "1 where y < x/phi^2 + 1/5, phi the golden ratio; integral 1/(2 phi^2) + 1/5",
          "an edge of irrational slope that no grid meets again", step(1 - phi / 2 + 0.2)),
      row_of_dims("halfspace", 1, 6, "1 on one side of a plane through the unit cube of 1 to 6 dimensions",
                  "Cho & Kim, Volume of hypercubes clipped by hyperplanes and combinatorial identities (2020)",
                  halfspace),
      row_of_dims("simplex", 1, kMostIntegrandDims, "1 where x_1 + ... + x_d < d/2; integral 1/2",
                  "Hall, The distribution of means for samples of size N (1927)",
                  [](int d) {
                    return jump({"", d, {}, 0.5, 0.25});
                  }),
      {{"ball", "d=DIMENSIONS,r=0.4", "1 in a ball of radius r about the middle of the unit cube",
        "Jarosz et al., Orthogonal array sampling for Monte Carlo rendering (2019): steps with a curved edge"},
       {{"d"}, {"r", 0.4}},
       ball},
      {{"checker", "n=SIDE", "1 on the odd squares of an n x n checkerboard; n = 8 is exact for every base-2 net",
        "the board whose edges a base-2 sampler's strata never cross when n is a power of two"},
       {{"n"}},
       checker},
  };
}

}  // namespace halfslope
