// What a formula of an integrand's kernel is made of, and the loop that evaluates one over points.
#pragma once

#include <cstddef>
#include <numbers>

#include "core/coordinates.h"
#include "core/packet.h"
#include "core/point_block.h"
#include "scenes/kernels.h"

namespace halfslope::kernel {

/// As many points as F has lanes; u[d] are their coordinates d.
template <class F>
class Point {
 public:
  Point(const scalar_t<F>* first, std::size_t stride) : first_(first), stride_(stride) {}
  F operator[](int d) const { return load<F>(first_ + static_cast<std::size_t>(d) * stride_); }

 private:
  const scalar_t<F>* first_;
  std::size_t stride_;
};

/// What one sample of several techniques is worth: f/p of its own, and the density of each of the two.
template <class F>
struct Sampled {
  F value, pdf[2];
};

template <class F>
F number(double x) {
  return F(static_cast<scalar_t<F>>(x));
}

template <class F>
F one_where(const mask_t<F>& inside) {
  return select(inside, number<F>(1), number<F>(0));
}

template <class F>
F clamp(const F& x, double least, double most) {
  return min(max(x, number<F>(least)), number<F>(most));
}

/// sin(2πs) for |s| ≤ 1/2, exactly odd.
template <class F>
F odd_sin_2pi(const F& s) {
  const F sine = sin_cos_2pi(abs(s)).sin;
  return select(s < number<F>(0), -sine, sine);
}

/// Σ (x_i − centre)².
template <class F>
F squared_distance(const Point<F>& u, int dims, double centre) {
  F sum = number<F>(0);
  for (int d = 0; d < dims; ++d) {
    const F offset = u[d] - number<F>(centre);
    sum = fma(offset, offset, sum);
  }
  return sum;
}

/// The `kDims` of a formula that takes as many as the call has.
inline constexpr int kAnyDims = 0;

/// A formula is a type with
///   kName   the kernel's name
///   kDims   the dimensions that it takes, or kAnyDims
///   value   f at a point u: template <class F> static F value(const double* parameters, int dims, const Point<F>& u)
///   sample  instead of `value`, where f is sampled by two techniques:
///           template <class F> static Sampled<F> sample(const double* parameters, int technique, const Point<F>& u)
template <class T, class Formula>
void evaluate(const IntegrandCall<T>& call) {
  using F = NativePacket<T>;
  constexpr bool kAny = Formula::kDims == kAnyDims;
  constexpr int kMost = kAny ? kMostIntegrandDims : Formula::kDims;
  constexpr std::size_t kChunk = (kAny ? 4 : 16) * kLanes;
  const int dims = kAny ? call.dims : Formula::kDims;
  alignas(64) T coordinates[kMost][kChunk];
  for (std::size_t begin = 0; begin < call.count; begin += kChunk) {
    const std::size_t size = call.count - begin < kChunk ? call.count - begin : kChunk;
    for (int d = 0; d < dims; ++d) {
      to_coordinates(call.high[d] + begin, call.low[d] ? call.low[d] + begin : nullptr, size, coordinates[d]);
    }
    for (std::size_t i = 0; i < size; i += kWidth<F>) {
      const Point<F> u(coordinates[0] + i, kChunk);
      Sampled<F> sampled;
      if constexpr (requires { Formula::template sample<F>(call.parameters, 0, u); }) {
        sampled = Formula::template sample<F>(call.parameters, call.technique, u);
      } else {
        sampled = {Formula::template value<F>(call.parameters, dims, u), {number<F>(1), number<F>(1)}};
      }
      store(call.value + begin + i, sampled.value);
      for (int k = 0; k < call.set_size; ++k) store(call.pdfs[k] + begin + i, sampled.pdf[call.set[k]]);
    }
  }
}

template <class Formula>
constexpr IntegrandKernel entry() {
  return {Formula::kName, evaluate<float, Formula>, evaluate<double, Formula>};
}

// One family a file.
IntegrandFamily step_kernels();
IntegrandFamily ramp_kernels();
IntegrandFamily smooth_kernels();
IntegrandFamily genz_kernels();
IntegrandFamily product_kernels();
IntegrandFamily singular_kernels();
IntegrandFamily mis_kernels();

}  // namespace halfslope::kernel
