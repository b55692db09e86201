// The vectorised integrands: plain data across the border to an instruction set's library.
#pragma once

#include <cstddef>
#include <cstdint>

namespace halfslope {

/// No integrand has more dimensions.
inline constexpr int kMostIntegrandDims = 64;

/// One sample of `technique` at each of `count` points (a multiple of kLanes): `high[d]` and `low[d]` (the array of low
/// words may be null) are the technique's own `dims` dimensions; value receives f/p, pdfs[k] the density of technique
/// set[k].
template <class T>
struct IntegrandCall {
  const double* parameters;
  int technique, dims;
  const std::uint32_t* const* high;
  const std::uint32_t* const* low;
  std::size_t count;
  T* value;
  T* const* pdfs;
  const int* set;
  int set_size;
};

template <class T>
using EvaluateIntegrand = void (*)(const IntegrandCall<T>& call);

struct IntegrandKernel {
  const char* name;
  EvaluateIntegrand<float> f32;
  EvaluateIntegrand<double> f64;
};

/// The kernels of one file.
struct IntegrandFamily {
  const IntegrandKernel* integrands;
  std::size_t count;
};

struct IntegrandKernels {
  static constexpr const char* kSymbol = "halfslope_integrand_kernels";
  const IntegrandFamily* families;
  std::size_t count;
};

}  // namespace halfslope
