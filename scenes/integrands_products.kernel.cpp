// Products and sums over any number of dimensions.
#include <iterator>

#include "scenes/integrand_formula.h"

namespace halfslope::kernel {
namespace {

// parameters: a_i/(1 + a_i), 1/(1 + a_i).
struct SobolG {
  static constexpr const char* kName = "sobol-g";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F product = number<F>(1);
    for (int d = 0; d < dims; ++d) {
      const F fold = abs(number<F>(4) * u[d] - number<F>(2));
      product = product * fma(fold, number<F>(parameters[dims + d]), number<F>(parameters[d]));
    }
    return product;
  }
};

struct SumSq {
  static constexpr const char* kName = "sumsq";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double*, int dims, const Point<F>& u) {
    F sum = number<F>(0);
    for (int d = 0; d < dims; ++d) sum = sum + u[d];
    return sum * sum;
  }
};

// Each factor is exactly odd about ½, and so is their product where their number is.
struct OddProd {
  static constexpr const char* kName = "oddprod";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double*, int dims, const Point<F>& u) {
    F product = number<F>(1);
    for (int d = 0; d < dims; ++d) product = product * (number<F>(2 * std::numbers::sqrt3) * (u[d] - number<F>(0.5)));
    return product;
  }
};

// parameters: 1/d, (1 + 1/d)^d. By logarithms, since a product of many coordinates leaves the range of numbers.
struct Morokoff {
  static constexpr const char* kName = "morokoff";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F sum = number<F>(0), least = number<F>(1);
    for (int d = 0; d < dims; ++d) {
      const F x = u[d];
      least = min(least, x);
      sum = sum + log(select(x > number<F>(0), x, number<F>(1)));
    }
    const F power = number<F>(parameters[1]) * exp(sum * number<F>(parameters[0]));
    return select(least > number<F>(0), power, number<F>(0));
  }
};

// parameters: d, 1/(d − ½).
struct Subcube {
  static constexpr const char* kName = "subcube";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F product = number<F>(1);
    for (int d = 0; d < dims; ++d) product = product * ((number<F>(parameters[0]) - u[d]) * number<F>(parameters[1]));
    return product;
  }
};

// −x₁ (1 − x₂ (1 − x₃ (…))).
struct Bratley {
  static constexpr const char* kName = "bratley";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double*, int dims, const Point<F>& u) {
    F nested = u[dims - 1];
    for (int d = dims - 1; d-- > 0;) nested = u[d] * (number<F>(1) - nested);
    return -nested;
  }
};

// 1 + B₂(x) = (x − ½)² + 11/12.
struct Bernoulli2 {
  static constexpr const char* kName = "bernoulli2";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double*, int dims, const Point<F>& u) {
    F product = number<F>(1);
    for (int d = 0; d < dims; ++d) {
      const F offset = u[d] - number<F>(0.5);
      product = product * fma(offset, offset, number<F>(11.0 / 12));
    }
    return product;
  }
};

}  // namespace

IntegrandFamily product_kernels() {
  static constexpr IntegrandKernel kKernels[] = {entry<SobolG>(),    entry<SumSq>(),   entry<OddProd>(),
                                                 entry<Morokoff>(),  entry<Subcube>(), entry<Bratley>(),
                                                 entry<Bernoulli2>()};
  return {kKernels, std::size(kKernels)};
}

}  // namespace halfslope::kernel
