// Integrands without jumps or kinks, from constant to wild.
#include <array>
#include <iterator>

#include "scenes/integrand_formula.h"

namespace halfslope::kernel {
namespace {

struct LinearX {
  static constexpr const char* kName = "linearx";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return u[0];
  }
};

struct GaussX {
  static constexpr const char* kName = "gaussx";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return exp(-(u[0] * u[0]));
  }
};

struct SinPiX {
  static constexpr const char* kName = "sinpix";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return sin_cos_2pi(number<F>(0.5) * u[0]).sin;
  }
};

// sin(2πx) = sin(2π(½ − x)), where ½ − x is exact and the opposite of that of 1 − x.
struct Sin2PiX {
  static constexpr const char* kName = "sin2pix";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return odd_sin_2pi(number<F>(0.5) - u[0]);
  }
};

// As above: sin(π(x + y)) = sin(π((½ − x) + (½ − y))).
struct SinXY {
  static constexpr const char* kName = "sinxy";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F half = number<F>(0.5);
    return odd_sin_2pi(half * ((half - u[0]) + (half - u[1])));
  }
};

struct QuarterGaussian {
  static constexpr const char* kName = "quartergaussian";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return exp(-fma(u[0], u[0], u[1] * u[1]));
  }
};

struct FullGaussian {
  static constexpr const char* kName = "fullgaussian";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return exp(-squared_distance(u, 2, 0.5));
  }
};

struct Bilinear {
  static constexpr const char* kName = "bilinear";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return u[0] * u[1];
  }
};

struct Biquadratic {
  static constexpr const char* kName = "biquadratic";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F product = u[0] * u[1];
    return product * product;
  }
};

struct ExpProd {
  static constexpr const char* kName = "expprod";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    return u[0] * exp(u[0] * u[1]);
  }
};

struct FormFactorRect {
  static constexpr const char* kName = "formfactor-rect";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F q = fma(u[0], u[0], fma(u[1], u[1], number<F>(0.25)));
    return number<F>(0.25 * std::numbers::inv_pi) / (q * q);
  }
};

// With t = π(2x − 1), sin t = sin(2π(x − ½)).
struct Ishigami {
  static constexpr const char* kName = "ishigami";
  static constexpr int kDims = 3;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F half = number<F>(0.5), s0 = odd_sin_2pi(u[0] - half), s1 = odd_sin_2pi(u[1] - half);
    const F t2 = number<F>(2 * std::numbers::pi) * (u[2] - half), square = t2 * t2;
    return fma(s0, fma(number<F>(0.1) * square, square, number<F>(1)), number<F>(7) * s1 * s1);
  }
};

// The argument in turns, 100 r²/(2π) ≤ 32, loses its whole turns exactly.
struct ZonePlate {
  static constexpr const char* kName = "zoneplate100";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F half = number<F>(0.5);
    const F turns = fma(u[0], u[0], u[1] * u[1]) * number<F>(50 * std::numbers::inv_pi);
    return fma(sin_cos_2pi(turns - floor_positive(turns)).cos, half, half);
  }
};

// Within 5e-10 of the origin, where it turns more than 2³⁰ times and has no limit, it counts as 0.
struct SinInvR {
  static constexpr const char* kName = "sininvr";
  static constexpr int kDims = 2;
  template <class F>
  static F value(const double*, int, const Point<F>& u) {
    const F all = number<F>(0.5) / sqrt(squared_distance(u, 2, 0));
    const F turns = select(all < number<F>(0x1p30), all, number<F>(0));
    return sin_cos_2pi(turns - floor_positive(turns)).sin;
  }
};

template <class F>
F polynomial(const std::array<double, 8>& coefficients, const F& x) {
  F sum = number<F>(coefficients[7]);
  for (std::size_t i = 7; i-- > 0;) sum = fma(sum, x, number<F>(coefficients[i]));
  return sum;
}

// Φ⁻¹(x)² for x in (0, 1), by M. Wichura's rational approximations, "The percentage points of the normal distribution"
// (algorithm AS 241, 1988): one about the middle, two in the tails, where 1 − x is exact.
template <class F>
F squared_normal_quantile(const F& x) {
  constexpr std::array<double, 8> kMiddleTop = {
      3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
      4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3};
  constexpr std::array<double, 8> kMiddleBottom = {1.0,
                                                   4.2313330701600911252e1,
                                                   6.8718700749205790830e2,
                                                   5.3941960214247511077e3,
                                                   2.1213794301586595867e4,
                                                   3.9307895800092710610e4,
                                                   2.8729085735721942674e4,
                                                   5.2264952788528545610e3};
  constexpr std::array<double, 8> kNearTop = {
      1.42343711074968357734e0, 4.63033784615654529590e0,  5.76949722146069140550e0,  3.64784832476320460504e0,
      1.27045825245236838258e0, 2.41780725177450611770e-1, 2.27238449892691845833e-2, 7.74545014278341407640e-4};
  constexpr std::array<double, 8> kNearBottom = {1.0,
                                                 2.05319162663775882187e0,
                                                 1.67638483018380384940e0,
                                                 6.89767334985100004550e-1,
                                                 1.48103976427480074590e-1,
                                                 1.51986665636164571966e-2,
                                                 5.47593808499534494600e-4,
                                                 1.05075007164441684324e-9};
  constexpr std::array<double, 8> kFarTop = {
      6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,  2.96560571828504891230e-1,
      2.65321895265761230930e-2, 1.24266094738807843860e-3, 2.71155556874348757815e-5, 2.01033439929228813265e-7};
  constexpr std::array<double, 8> kFarBottom = {1.0,
                                                5.99832206555887937690e-1,
                                                1.36929880922735805310e-1,
                                                1.48753612908506148525e-2,
                                                7.86869131145613259100e-4,
                                                1.84631831751005468180e-5,
                                                1.42151175831644588870e-7,
                                                2.04426310338993978564e-15};
  const F offset = x - number<F>(0.5), middle = fma(-offset, offset, number<F>(0.180625));
  const F central = offset * polynomial(kMiddleTop, middle) / polynomial(kMiddleBottom, middle);
  const F root = sqrt(-log(min(x, number<F>(1) - x)));
  const F near = root - number<F>(1.6), far = root - number<F>(5);
  const F near_tail = polynomial(kNearTop, near) / polynomial(kNearBottom, near);
  const F far_tail = polynomial(kFarTop, far) / polynomial(kFarBottom, far);
  const F tail = select(root > number<F>(5), far_tail, near_tail);
  const F quantile = select(abs(offset) > number<F>(0.425), tail, central);
  return quantile * quantile;
}

// parameters: π^(d/2). On the faces x_i = 0, where it has no limit, it counts as 0.
struct Keister {
  static constexpr const char* kName = "keister";
  static constexpr int kDims = kAnyDims;
  template <class F>
  static F value(const double* parameters, int dims, const Point<F>& u) {
    F sum = number<F>(0), least = number<F>(1);
    for (int d = 0; d < dims; ++d) {
      const F x = u[d];
      least = min(least, x);
      // Where x is 0 the middle stands in, so that no lane meets an infinity.
      sum = sum + squared_normal_quantile(select(x > number<F>(0), x, number<F>(0.5)));
    }
    const F turns = sqrt(sum * number<F>(0.5)) * number<F>(0.5 * std::numbers::inv_pi);
    const F cosine = sin_cos_2pi(turns - floor_positive(turns)).cos;
    return select(least > number<F>(0), number<F>(parameters[0]) * cosine, number<F>(0));
  }
};

}  // namespace

IntegrandFamily smooth_kernels() {
  static constexpr IntegrandKernel kKernels[] = {
      entry<LinearX>(),         entry<GaussX>(),       entry<SinPiX>(),    entry<Sin2PiX>(),     entry<SinXY>(),
      entry<QuarterGaussian>(), entry<FullGaussian>(), entry<Bilinear>(),  entry<Biquadratic>(), entry<ExpProd>(),
      entry<FormFactorRect>(),  entry<Ishigami>(),     entry<ZonePlate>(), entry<SinInvR>(),     entry<Keister>()};
  return {kKernels, std::size(kKernels)};
}

}  // namespace halfslope::kernel
