// Integrands that are continuous but for a derivative.
#include <iterator>

#include "scenes/integrand_formula.h"

namespace halfslope::kernel {
namespace {

struct RampX {
  static constexpr const char* kName = "rampx";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return clamp(fma(u[0], number<F>(-5), number<F>(2)), 0, 1);
  }
};

struct QuarterDiskRamp {
  static constexpr const char* kName = "quarterdiskramp";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return clamp(fma(sqrt(squared_distance(u, 2, 0)), number<F>(-5), number<F>(4.5)), 0, 1);
  }
};

struct FullDiskRamp {
  static constexpr const char* kName = "fulldiskramp";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return clamp(fma(sqrt(squared_distance(u, 2, 0.5)), number<F>(-10), number<F>(4.5)), 0, 1);
  }
};

// Where the ramp is, 5 (y − x) is exact, so the values at x and at 1 − x add up to 1.
struct TriangleRamp {
  static constexpr const char* kName = "triangleramp";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return clamp(number<F>(5) * (u[1] - u[0]), -0.5, 0.5) + number<F>(0.5);
  }
};

// 1 − t²(3 − 2t) = (1 − t)² (1 + 2t), which keeps its digits where it ends.
struct SmoothDisk {
  static constexpr const char* kName = "smoothdisk";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F left = clamp(fma(sqrt(squared_distance(u, 2, 0.5)), number<F>(-5), number<F>(2.5)), 0, 1);
    return left * left * fma(left, number<F>(-2), number<F>(3));
  }
};

struct KinkMax {
  static constexpr const char* kName = "kinkmax";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F half = number<F>(0.5);
    return max((u[0] - half) + (u[1] - half), number<F>(0));
  }
};

}  // namespace

IntegrandFamily ramp_kernels() {
  static constexpr IntegrandKernel kKernels[] = {entry<RampX>(),        entry<QuarterDiskRamp>(), entry<FullDiskRamp>(),
                                                 entry<TriangleRamp>(), entry<SmoothDisk>(),      entry<KinkMax>()};
  return {kKernels, std::size(kKernels)};
}

}  // namespace halfslope::kernel
