// Integrands of two values: 1 inside a region, 0 outside.
#include <iterator>

#include "scenes/integrand_formula.h"

namespace halfslope::kernel {
namespace {

struct StepX {
  static constexpr const char* kName = "stepx";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return one_where<F>(u[0] < number<F>(std::numbers::inv_pi));
  }
};

struct QuarterDisk {
  static constexpr const char* kName = "quarterdisk";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return one_where<F>(fma(u[0], u[0], u[1] * u[1]) < number<F>(2 * std::numbers::inv_pi));
  }
};

struct FullDisk {
  static constexpr const char* kName = "fulldisk";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return one_where<F>(squared_distance(u, 2, 0.5) < number<F>(0.5 * std::numbers::inv_pi));
  }
};

// Distances from the centre are exact and so is their sum: what lies on the diagonal is not left to rounding.
struct Triangle {
  static constexpr const char* kName = "triangle";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F half = number<F>(0.5);
    return one_where<F>((u[0] - half) + (u[1] - half) < number<F>(0));
  }
};

struct HalfPlane {
  static constexpr const char* kName = "halfplane";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    constexpr double kSlope = 2 - std::numbers::phi;  // 1/φ²
    return one_where<F>(u[1] < fma(u[0], number<F>(kSlope), number<F>(0.2)));
  }
};

// parameters: w₁ … w_d.
struct HalfSpace {
  static constexpr const char* kName = "halfspace";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F sum = number<F>(-0.1);
    for (int d = 0; d < dims; ++d) sum = fma(number<F>(parameters[d]), u[d], sum);
    return one_where<F>(sum > number<F>(0));
  }
};

// From the centre, so that x and 1 − x never agree, whatever rounds.
struct Simplex {
  static constexpr const char* kName = "simplex";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double*, int dims, const Point<F>& u) {
    F sum = number<F>(0);
    for (int d = 0; d < dims; ++d) sum = sum + (u[d] - number<F>(0.5));
    return one_where<F>(sum < number<F>(0));
  }
};

// parameters: r².
struct Ball {
  static constexpr const char* kName = "ball";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    return one_where<F>(squared_distance(u, dims, 0.5) < number<F>(parameters[0]));
  }
};

// parameters: n.
struct Checker {
  static constexpr const char* kName = "checker";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double* parameters, int, const Point<F>& u) {
    const F n = number<F>(parameters[0]), sum = floor_positive(n * u[0]) + floor_positive(n * u[1]);
    return sum - number<F>(2) * floor_positive(sum * number<F>(0.5));
  }
};

}  // namespace

IntegrandFamily step_kernels() {
  static constexpr IntegrandKernel kKernels[] = {entry<StepX>(),    entry<QuarterDisk>(), entry<FullDisk>(),
                                                 entry<Triangle>(), entry<HalfPlane>(),   entry<HalfSpace>(),
                                                 entry<Simplex>(),  entry<Ball>(),        entry<Checker>()};
  return {kKernels, std::size(kKernels)};
}

}  // namespace halfslope::kernel
