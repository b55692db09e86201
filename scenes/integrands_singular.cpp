// Integrands without a bound. They are infinite where a coordinate is 0 (`invr`: where all are), so they need samplers
// that never give it; an infinite value is counted and its cell invalid, as any other.
#include <limits>
#include <numbers>

#include "scenes/integrand_table.h"

namespace halfslope {

IntegrandRows singular_integrands() {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  // 2 ln(1 + √2), a square's mean of 1/r from its corner.
  constexpr double kInvR = 1.762747174039086050465;
  return {
      // A factor's mean square is 0.49/0.4.
      row("invsqrtprod2", "product of 0.7 x_i^-0.3, infinite on the axes, needs x > 0; integral 1",
          papers::kOwenSingular, {"", 2, {}, 1, 0.500625}),
      row("invsqrt-heavy", "product of 0.4 x_i^-0.6, needs x > 0; integral 1, infinite variance", papers::kOwenSingular,
          {"", 2, {}, 1, kInfinite}),
      row("invr", "1/r, r from the corner, needs r > 0; integral 2 ln(1 + sqrt 2), infinite variance",
          "the mean of 1/r over a square, whose mean square diverges like a logarithm", {"", 2, {}, kInvR, kInfinite}),
  };
}

}  // namespace halfslope
