// The six families of A. Genz's package (1984). parameters: a₁ … a_d, u₁ … u_d, unless it says otherwise.
#include <iterator>

#include "scenes/integrand_formula.h"

namespace halfslope::kernel {
namespace {

// parameters: a_i/(2π), u₁: cos(2πu₁ + Σ a_i x_i), the argument in turns.
struct Oscillatory {
  static constexpr const char* kName = "genz-oscillatory";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F turns = number<F>(parameters[dims]);
    for (int d = 0; d < dims; ++d) turns = fma(number<F>(parameters[d]), u[d], turns);
    return sin_cos_2pi(turns - floor_positive(turns)).cos;
  }
};

// parameters: a_i⁻², u_i.
struct ProductPeak {
  static constexpr const char* kName = "genz-productpeak";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F product = number<F>(1);
    for (int d = 0; d < dims; ++d) {
      const F offset = u[d] - number<F>(parameters[dims + d]);
      product = product * fma(offset, offset, number<F>(parameters[d]));
    }
    return number<F>(1) / product;
  }
};

struct CornerPeak {
  static constexpr const char* kName = "genz-cornerpeak";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F sum = number<F>(1);
    for (int d = 0; d < dims; ++d) sum = fma(number<F>(parameters[d]), u[d], sum);
    F power = sum;
    for (int d = 0; d < dims; ++d) power = power * sum;
    return number<F>(1) / power;
  }
};

struct Gaussian {
  static constexpr const char* kName = "genz-gaussian";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F sum = number<F>(0);
    for (int d = 0; d < dims; ++d) {
      const F scaled = number<F>(parameters[d]) * (u[d] - number<F>(parameters[dims + d]));
      sum = fma(scaled, scaled, sum);
    }
    return exp(-sum);
  }
};

struct Continuous {
  static constexpr const char* kName = "genz-continuous";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F sum = number<F>(0);
    for (int d = 0; d < dims; ++d) {
      sum = fma(number<F>(parameters[d]), abs(u[d] - number<F>(parameters[dims + d])), sum);
    }
    return exp(-sum);
  }
};

struct Discontinuous {
  static constexpr const char* kName = "genz-discontinuous";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F sum = number<F>(0);
    for (int d = 0; d < dims; ++d) sum = fma(number<F>(parameters[d]), u[d], sum);
    const F zero = number<F>(0);
    F value = select(u[0] <= number<F>(parameters[dims]), exp(sum), zero);
    if (dims > 1) value = select(u[1] <= number<F>(parameters[dims + 1]), value, zero);
    return value;
  }
};

}  // namespace

IntegrandFamily genz_kernels() {
  static constexpr IntegrandKernel kKernels[] = {entry<Oscillatory>(), entry<ProductPeak>(), entry<CornerPeak>(),
                                                 entry<Gaussian>(),    entry<Continuous>(),  entry<Discontinuous>()};
  return {kKernels, std::size(kKernels)};
}

}  // namespace halfslope::kernel
