// Integrands without a bound: infinite at the origin or on the axes, and they say so there.
#include <iterator>
#include <limits>

#include "scenes/integrand_formula.h"

namespace halfslope::kernel {
namespace {

// (1 − a)² (xy)^−a.
template <class F>
F power_of_product(double a, const Point<F>& u) {
  const F product = u[0] * u[1];
  const auto positive = product > number<F>(0);
  const F logarithm = log(select(positive, product, number<F>(1)));
  return select(positive, number<F>((1 - a) * (1 - a)) * exp(number<F>(-a) * logarithm),
                F(std::numeric_limits<scalar_t<F>>::infinity()));
}

struct InvSqrtProd2 {
  static constexpr const char* kName = "invsqrtprod2";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return power_of_product(0.3, u);
  }
};

struct InvSqrtHeavy {
  static constexpr const char* kName = "invsqrt-heavy";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return power_of_product(0.6, u);
  }
};

struct InvR {
  static constexpr const char* kName = "invr";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return number<F>(1) / sqrt(squared_distance(u, 2, 0));
  }
};

}  // namespace

IntegrandFamily singular_kernels() {
  static constexpr IntegrandKernel kKernels[] = {entry<InvSqrtProd2>(), entry<InvSqrtHeavy>(), entry<InvR>()};
  return {kKernels, std::size(kKernels)};
}

}  // namespace halfslope::kernel
