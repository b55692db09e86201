// Analytic integrands, each a template over the number type: the formula stands once, for every precision and width.
#include <numbers>

#include "core/coordinates.h"
#include "core/packet.h"
#include "core/point_block.h"
#include "scenes/kernels.h"

namespace halfslope::kernel {
namespace {

/// What one sample is worth: f/p of its technique, and the densities of the integrand's (at most two) techniques.
template <class F>
struct Sampled {
  F value, pdf[2];
};

// 1 where x² + y² < 2/π: a quarter of a disc of area 1/2 (Christensen, Kensler & Kilpatrick 2018).
struct QuarterDisk {
  static constexpr const char* kName = "quarterdisk";
  template <class F>
  static Sampled<F> sample(const double*, int, const F* u) {
    using T = scalar_t<F>;
    const F one(T(1)), zero(T(0));
    const F r2 = fma(u[0], u[0], u[1] * u[1]);
    return {select(r2 < F(T(2 * std::numbers::inv_pi)), one, zero), {one, one}};
  }
};

// 1 where x < 1/π (Christensen, Kensler & Kilpatrick 2018).
struct StepX {
  static constexpr const char* kName = "stepx";
  template <class F>
  static Sampled<F> sample(const double*, int, const F* u) {
    using T = scalar_t<F>;
    const F one(T(1)), zero(T(0));
    return {select(u[0] < F(T(std::numbers::inv_pi)), one, zero), {one, one}};
  }
};

// x y (Christensen, Kensler & Kilpatrick 2018).
struct Bilinear {
  static constexpr const char* kName = "bilinear";
  template <class F>
  static Sampled<F> sample(const double*, int, const F* u) {
    const F one(scalar_t<F>(1));
    return {u[0] * u[1], {one, one}};
  }
};

// exp(−x² − y²) (Christensen, Kensler & Kilpatrick 2018).
struct QuarterGaussian {
  static constexpr const char* kName = "quartergaussian";
  template <class F>
  static Sampled<F> sample(const double*, int, const F* u) {
    const F one(scalar_t<F>(1));
    return {exp(-fma(u[0], u[0], u[1] * u[1])), {one, one}};
  }
};

// f(x) = x on [0, 1] with p₁ = 1 (technique 0) and p₂ = 2x (technique 1, x = √u). At x = 0, where p₂ is 0, f/p₂ = ½ by
// its limit; it has no weight in any estimate.
struct MisToy {
  static constexpr const char* kName = "mis-toy";
  template <class F>
  static Sampled<F> sample(const double*, int technique, const F* u) {
    using T = scalar_t<F>;
    const F one(T(1)), two(T(2));
    if (technique == 0) return {u[0], {one, two * u[0]}};
    return {F(T(0.5)), {one, two * sqrt(u[0])}};
  }
};

// A Phong lobe (n+1)/(2π) cosⁿθ and a light of radiance 1 that fills the cone of half-angle α about its axis.
// parameters: n, 1 − cos α. Everything is a function of v = 1 − cos θ, which keeps its digits where cos θ rounds to 1;
// the azimuth integrates out, so one dimension is enough. Technique 0 draws v uniformly in the cone, technique 1 from
// the lobe.
struct AlignedPhongCap {
  static constexpr const char* kName = "aligned-phong-cap";
  template <class F>
  static Sampled<F> sample(const double* parameters, int technique, const F* u) {
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

// exp(−Σ aᵢ² (xᵢ − uᵢ)²) (Genz 1984). parameters: a₁ … a_D, u₁ … u_D.
template <int kDims>
struct GenzGaussian {
  static constexpr const char* kNames[] = {"genz-gaussian:d=1", "genz-gaussian:d=2", "genz-gaussian:d=3",
                                           "genz-gaussian:d=4", "genz-gaussian:d=5", "genz-gaussian:d=6"};
  static constexpr const char* kName = kNames[kDims - 1];
  template <class F>
  static Sampled<F> sample(const double* parameters, int, const F* u) {
    using T = scalar_t<F>;
    const F one(T(1));
    F sum(T(0));
    for (int d = 0; d < kDims; ++d) {
      const F scaled = F(static_cast<T>(parameters[d])) * (u[d] - F(static_cast<T>(parameters[kDims + d])));
      sum = fma(scaled, scaled, sum);
    }
    return {exp(-sum), {one, one}};
  }
};

// 1 where Σ wᵢ xᵢ > 1/10. parameters: w₁ … w_D.
template <int kDims>
struct HalfSpace {
  static constexpr const char* kNames[] = {"halfspace:d=1", "halfspace:d=2", "halfspace:d=3",
                                           "halfspace:d=4", "halfspace:d=5", "halfspace:d=6"};
  static constexpr const char* kName = kNames[kDims - 1];
  template <class F>
  static Sampled<F> sample(const double* parameters, int, const F* u) {
    using T = scalar_t<F>;
    const F one(T(1)), zero(T(0));
    F sum(T(-0.1));
    for (int d = 0; d < kDims; ++d) sum = fma(F(static_cast<T>(parameters[d])), u[d], sum);
    return {select(sum > zero, one, zero), {one, one}};
  }
};

template <class T, class Integrand, int kDims>
void evaluate(const IntegrandCall<T>& call) {
  using F = NativePacket<T>;
  constexpr std::size_t kChunk = 16 * kLanes;
  alignas(64) T coordinates[kDims][kChunk];
  for (std::size_t begin = 0; begin < call.count; begin += kChunk) {
    const std::size_t size = call.count - begin < kChunk ? call.count - begin : kChunk;
    for (int d = 0; d < kDims; ++d) {
      to_coordinates(call.high[d] + begin, call.low[d] ? call.low[d] + begin : nullptr, size, coordinates[d]);
    }
    for (std::size_t i = 0; i < size; i += kWidth<F>) {
      F u[kDims];
      for (int d = 0; d < kDims; ++d) u[d] = load<F>(coordinates[d] + i);
      const Sampled<F> sampled = Integrand::sample(call.parameters, call.technique, u);
      store(call.value + begin + i, sampled.value);
      for (int k = 0; k < call.set_size; ++k) store(call.pdfs[k] + begin + i, sampled.pdf[call.set[k]]);
    }
  }
}

template <class Integrand, int kDims>
constexpr IntegrandKernel entry() {
  return {Integrand::kName, evaluate<float, Integrand, kDims>, evaluate<double, Integrand, kDims>};
}

}  // namespace
}  // namespace halfslope::kernel

extern "C" __attribute__((visibility("default"))) const void* halfslope_integrand_kernels() {
  using namespace halfslope::kernel;
  static constexpr halfslope::IntegrandKernel kIntegrands[] = {
      entry<QuarterDisk, 2>(),     entry<QuarterGaussian, 2>(), entry<MisToy, 1>(),
      entry<AlignedPhongCap, 1>(), entry<StepX, 2>(),           entry<Bilinear, 2>(),
      entry<GenzGaussian<1>, 1>(), entry<GenzGaussian<2>, 2>(), entry<GenzGaussian<3>, 3>(),
      entry<GenzGaussian<4>, 4>(), entry<GenzGaussian<5>, 5>(), entry<GenzGaussian<6>, 6>(),
      entry<HalfSpace<1>, 1>(),    entry<HalfSpace<2>, 2>(),    entry<HalfSpace<3>, 3>(),
      entry<HalfSpace<4>, 4>(),    entry<HalfSpace<5>, 5>(),    entry<HalfSpace<6>, 6>(),
  };
  static constexpr halfslope::IntegrandKernels kTable = {kIntegrands, std::size(kIntegrands)};
  return &kTable;
}
