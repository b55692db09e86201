// Problems of multiple importance sampling: an integrand and two techniques, each a template over the number type.
#include <iterator>

#include "scenes/integrand_formula.h"

namespace halfslope::kernel {
namespace {

// f(x) = x on [0, 1] with p₁ = 1 (technique 0) and p₂ = 2x (technique 1, x = √u). At x = 0, where p₂ is 0, f/p₂ = ½ by
// its limit; it has no weight in any estimate.
struct MisToy {
  static constexpr const char* kName = "mis-toy";
  static constexpr int kDims = 1;
  template <class F>
  static Sampled<F> sample(const double*, int technique, const Point<F>& u) {
    const F one = number<F>(1), two = number<F>(2);
    if (technique == 0) return {u[0], {one, two * u[0]}};
    return {number<F>(0.5), {one, two * sqrt(u[0])}};
  }
};

// A Phong lobe (n+1)/(2π) cosⁿθ and a light of radiance 1 that fills the cone of half-angle α about its axis.
// parameters: n, 1 − cos α. Everything is a function of v = 1 − cos θ, which keeps its digits where cos θ rounds to 1;
// the azimuth integrates out, so one dimension is enough. Technique 0 draws v uniformly in the cone, technique 1 from
// the lobe.
struct AlignedPhongCap {
  static constexpr const char* kName = "aligned-phong-cap";
  static constexpr int kDims = 1;
  template <class F>
  static Sampled<F> sample(const double* parameters, int technique, const Point<F>& u) {
    using T = scalar_t<F>;
    const T n = static_cast<T>(parameters[0]), v_max = static_cast<T>(parameters[1]);
    const F one(T(1)), zero(T(0));
    const F lobe((n + 1) * T(0.5) * std::numbers::inv_pi_v<T>);
    const F light(T(0.5) * std::numbers::inv_pi_v<T> / v_max);
    if (technique == 0) {
      const F cos_n = exp(F(n) * log1p(-(u[0] * F(v_max))));
      return {F((n + 1) * v_max) * cos_n, {light, lobe * cos_n}};
    }
    const F log_cos = log1p(-u[0]) / F(n + 1);
    const auto inside = -expm1(log_cos) <= F(v_max);
    return {select(inside, one, zero), {select(inside, light, zero), lobe * exp(F(n) * log_cos)}};
  }
};

}  // namespace

IntegrandFamily mis_kernels() {
  static constexpr IntegrandKernel kKernels[] = {entry<MisToy>(), entry<AlignedPhongCap>()};
  return {kKernels, std::size(kKernels)};
}

}  // namespace halfslope::kernel
