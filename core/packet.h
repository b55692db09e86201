// The number types of kernels. A kernel is a template over F: float, double, or a packet xsimd::batch<T> of them; the
// functions here mean the same for each, so the scalar build of a kernel is its packets' own reference.
#pragma once

#ifdef __FINITE_MATH_ONLY__
#if __FINITE_MATH_ONLY__
#error "halfslope needs IEEE infinities and NaNs: do not build with -ffast-math"
#endif
#endif

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

// xsimd 8.1 has no fused multiply-add for AVX-512 and would fall back to two roundings; with these overloads, seen
// before its API is, AVX-512 packets give AVX2's bits.
#ifdef __AVX512F__
#include <immintrin.h>

#include <xsimd/types/xsimd_all_registers.hpp>
#include <xsimd/types/xsimd_utils.hpp>

namespace xsimd::kernel {
template <class A>
inline batch<float, A> fma(const batch<float, A>& x, const batch<float, A>& y, const batch<float, A>& z,
                           requires_arch<avx512f>) noexcept {
  return _mm512_fmadd_ps(x, y, z);
}
template <class A>
inline batch<double, A> fma(const batch<double, A>& x, const batch<double, A>& y, const batch<double, A>& z,
                            requires_arch<avx512f>) noexcept {
  return _mm512_fmadd_pd(x, y, z);
}
template <class A>
inline batch<float, A> fms(const batch<float, A>& x, const batch<float, A>& y, const batch<float, A>& z,
                           requires_arch<avx512f>) noexcept {
  return _mm512_fmsub_ps(x, y, z);
}
template <class A>
inline batch<double, A> fms(const batch<double, A>& x, const batch<double, A>& y, const batch<double, A>& z,
                            requires_arch<avx512f>) noexcept {
  return _mm512_fmsub_pd(x, y, z);
}
template <class A>
inline batch<float, A> fnma(const batch<float, A>& x, const batch<float, A>& y, const batch<float, A>& z,
                            requires_arch<avx512f>) noexcept {
  return _mm512_fnmadd_ps(x, y, z);
}
template <class A>
inline batch<double, A> fnma(const batch<double, A>& x, const batch<double, A>& y, const batch<double, A>& z,
                             requires_arch<avx512f>) noexcept {
  return _mm512_fnmadd_pd(x, y, z);
}
template <class A>
inline batch<float, A> fnms(const batch<float, A>& x, const batch<float, A>& y, const batch<float, A>& z,
                            requires_arch<avx512f>) noexcept {
  return _mm512_fnmsub_ps(x, y, z);
}
template <class A>
inline batch<double, A> fnms(const batch<double, A>& x, const batch<double, A>& y, const batch<double, A>& z,
                             requires_arch<avx512f>) noexcept {
  return _mm512_fnmsub_pd(x, y, z);
}
}  // namespace xsimd::kernel
#endif

#include <xsimd/xsimd.hpp>

namespace halfslope {

template <class F>
struct PacketTraits {
  using Scalar = F;
  using Mask = bool;
  static constexpr int kWidth = 1;
};
template <class T, class A>
struct PacketTraits<xsimd::batch<T, A>> {
  using Scalar = T;
  using Mask = xsimd::batch_bool<T, A>;
  static constexpr int kWidth = static_cast<int>(xsimd::batch<T, A>::size);
};
/// The type of one lane.
template <class F>
using scalar_t = typename PacketTraits<F>::Scalar;
/// What a comparison gives.
template <class F>
using mask_t = typename PacketTraits<F>::Mask;
template <class F>
inline constexpr int kWidth = PacketTraits<F>::kWidth;

template <class F>
concept Packet = (kWidth<F>) > 1;
template <class F>
concept ScalarNumber = std::floating_point<F>;

template <ScalarNumber F>
inline F load(const F* p) {
  return *p;
}
template <ScalarNumber F>
inline void store(F* p, F x) {
  *p = x;
}
template <Packet F>
inline F load(const scalar_t<F>* p) {
  return F::load_aligned(p);
}
template <Packet F>
inline void store(scalar_t<F>* p, const F& x) {
  x.store_aligned(p);
}

template <ScalarNumber F>
inline F select(bool mask, F a, F b) {
  return mask ? a : b;
}
template <Packet F>
inline F select(const mask_t<F>& mask, const F& a, const F& b) {
  return xsimd::select(mask, a, b);
}
inline bool any_lane(bool mask) { return mask; }
template <class T, class A>
inline bool any_lane(const xsimd::batch_bool<T, A>& mask) {
  return xsimd::any(mask);
}

template <ScalarNumber F>
inline F sqrt(F x) {
  return std::sqrt(x);
}
template <Packet F>
inline F sqrt(const F& x) {
  return xsimd::sqrt(x);
}
template <ScalarNumber F>
inline F abs(F x) {
  return std::fabs(x);
}
template <Packet F>
inline F abs(const F& x) {
  return xsimd::abs(x);
}
/// The smaller; b where either is NaN.
template <class F>
inline F min(const F& a, const F& b) {
  return select(a < b, a, b);
}
/// The larger; b where either is NaN.
template <class F>
inline F max(const F& a, const F& b) {
  return select(a > b, a, b);
}

/// x·y + z with one rounding where the target has the instruction (every class but the baseline).
template <ScalarNumber F>
inline F fma(F x, F y, F z) {
#ifdef __FMA__
  return std::fma(x, y, z);
#else
  return x * y + z;
#endif
}
template <Packet F>
inline F fma(const F& x, const F& y, const F& z) {
  return xsimd::fma(x, y, z);
}

template <ScalarNumber F>
inline F floor_positive(F x) {  ///< x in [0, 2³¹)
  return static_cast<F>(static_cast<int>(x));
}
template <Packet F>
inline F floor_positive(const F& x) {
  return xsimd::trunc(x);
}

// Transcendental functions: used by analytic scenes, general power weights and a few BSDFs only.
template <ScalarNumber F>
inline F exp(F x) {
  return std::exp(x);
}
template <Packet F>
inline F exp(const F& x) {
  return xsimd::exp(x);
}
template <ScalarNumber F>
inline F log(F x) {
  return std::log(x);
}
template <Packet F>
inline F log(const F& x) {
  return xsimd::log(x);
}
template <ScalarNumber F>
inline F log1p(F x) {
  return std::log1p(x);
}
template <Packet F>
inline F log1p(const F& x) {
  return xsimd::log1p(x);
}
template <ScalarNumber F>
inline F expm1(F x) {
  return std::expm1(x);
}
template <Packet F>
inline F expm1(const F& x) {
  return xsimd::expm1(x);
}

/// In packets of double it is right to 80 units of the last place only, 1e-14.
template <ScalarNumber F>
inline F erf(F x) {
  return std::erf(x);
}
template <Packet F>
inline F erf(const F& x) {
  return xsimd::erf(x);
}

template <class F>
struct SinCos {
  F sin, cos;
};

namespace packet_detail {

/// sin x and cos x for |x| ≤ π/4 by their Taylor polynomials (truncation below a quarter ulp), then turned by `quarter`
/// quarter turns, 0 … 4.
template <class F>
inline SinCos<F> sin_cos_reduced(const F& quarter, const F& x) {
  using T = scalar_t<F>;
  const F x2 = x * x;
  F s, c;
  if constexpr (std::is_same_v<T, float>) {
    s = fma(x2, F(2.7557319e-6f), F(-1.9841270e-4f));
    s = fma(x2, s, F(8.3333333e-3f));
    s = fma(x2, s, F(-1.6666667e-1f));
    c = fma(x2, F(-2.7557319e-7f), F(2.4801587e-5f));
    c = fma(x2, c, F(-1.3888889e-3f));
    c = fma(x2, c, F(4.1666667e-2f));
    c = fma(x2, c, F(-0.5f));
  } else {
    constexpr std::array<double, 8> kSin = {-1.0 / 6,
                                            1.0 / 120,
                                            -1.0 / 5040,
                                            1.0 / 362880,
                                            -1.0 / 39916800.0,
                                            1.0 / 6227020800.0,
                                            -1.0 / 1307674368000.0,
                                            1.0 / 355687428096000.0};
    constexpr std::array<double, 9> kCos = {-1.0 / 2,
                                            1.0 / 24,
                                            -1.0 / 720,
                                            1.0 / 40320,
                                            -1.0 / 3628800.0,
                                            1.0 / 479001600.0,
                                            -1.0 / 87178291200.0,
                                            1.0 / 20922789888000.0,
                                            -1.0 / 6402373705728000.0};
    s = F(kSin[7]);
    for (int i = 6; i >= 0; --i) s = fma(x2, s, F(kSin[static_cast<std::size_t>(i)]));
    c = F(kCos[8]);
    for (int i = 7; i >= 0; --i) c = fma(x2, c, F(kCos[static_cast<std::size_t>(i)]));
  }
  s = fma(x2 * x, s, x);
  c = fma(x2, c, F(T(1)));
  const auto odd = (quarter == F(T(1))) | (quarter == F(T(3)));
  const auto sin_negative = (quarter == F(T(2))) | (quarter == F(T(3)));
  const auto cos_negative = (quarter == F(T(1))) | (quarter == F(T(2)));
  const F sine = select(odd, c, s), cosine = select(odd, s, c);
  return {select(sin_negative, -sine, sine), select(cos_negative, -cosine, cosine)};
}

/// π/2 in three parts: products of the first two with 0 … 4 are exact.
template <class T>
inline constexpr std::array<T, 3> kHalfPi = {T(0x1.92p0), T(0x1.fb4p-12), T(0x1.4442d2p-24)};
template <>
inline constexpr std::array<double, 3> kHalfPi<double> = {0x1.921fb544p0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};

/// (atan t − t)/t³ as a polynomial in t², minimax on |t| ≤ tan(π/8) (Remez): the error of atan t is below 7·10⁻¹⁰ t in
/// binary32 and 2·10⁻¹⁸ t in binary64.
template <class F>
inline F atan_tail(const F& t2) {
  if constexpr (std::is_same_v<scalar_t<F>, float>) {
    constexpr std::array<float, 5> kTail = {-0.3333331549707184f, 0.19998488892799043f, -0.14243837746677332f,
                                            0.10595915432864471f, -0.06083223752852424f};
    F p(kTail[4]);
    for (int i = 3; i >= 0; --i) p = fma(t2, p, F(kTail[static_cast<std::size_t>(i)]));
    return p;
  } else {
    constexpr std::array<double, 11> kTail = {-0.333333333333332,  0.19999999999954013,  -0.14285714280241865,
                                              0.1111111078581742,  -0.09090897827431184, 0.07692061478694526,
                                              -0.0666311859502837, 0.05847995935629288,  -0.05039787025470772,
                                              0.03807683223398627, -0.017920643679001078};
    F p(kTail[10]);
    for (int i = 9; i >= 0; --i) p = fma(t2, p, F(kTail[static_cast<std::size_t>(i)]));
    return p;
  }
}

}  // namespace packet_detail

/// sin(2πu) and cos(2πu) for u in [0, 1]: u is reduced exactly to the nearest quarter turn. No branches: one lane never
/// changes another.
template <class F>
inline SinCos<F> sin_cos_2pi(const F& u) {
  using T = scalar_t<F>;
  const F quarter = floor_positive(fma(u, F(T(4)), F(T(0.5))));  // 0 … 4
  return packet_detail::sin_cos_reduced(quarter, fma(quarter, F(T(-0.25)), u) * F(T(6.283185307179586476925286766559)));
}

/// sin x and cos x for x in [0, 2π], x in radians: small x keep their digits, as do the zeros of either to the last
/// places of π.
template <class F>
inline SinCos<F> sin_cos(const F& x) {
  using T = scalar_t<F>;
  constexpr std::array<T, 3> half_pi = packet_detail::kHalfPi<T>;
  const F quarter = floor_positive(fma(x, F(T(0.6366197723675813430755)), F(T(0.5))));  // 0 … 4
  F r = fma(quarter, F(-half_pi[0]), x);
  r = fma(quarter, F(-half_pi[1]), r);
  r = fma(quarter, F(-half_pi[2]), r);
  return packet_detail::sin_cos_reduced(quarter, r);
}

/// The angle in (−π, π] of the point (x, y), as std::atan2 but for its zeros: y = ±0 counts as +0, and (0, 0) gives 0.
/// For |x|, |y| below half the largest number; where the smaller over the larger underflows, so does the angle's
/// distance from an axis. The same bits in every build with fma (and so not called atan2, which for packets would find
/// xsimd's). Reduced to |t| ≤ tan(π/8) by atan(b/a) = π/4 + atan((b − a)/(b + a)).
template <class F>
inline F arctan2(const F& y, const F& x) {
  using T = scalar_t<F>;
  constexpr std::array<T, 3> half_pi = packet_detail::kHalfPi<T>;
  const F zero(T(0)), ax = abs(x), ay = abs(y), large = max(ax, ay), small = min(ax, ay);
  const auto octant = small > F(T(0.41421356237309504880)) * large;
  const F above = select(octant, small - large, small), below = select(octant, small + large, large);
  const F t = above / select(below > zero, below, F(T(1)));
  const F t2 = t * t;
  const F tail = t * (t2 * packet_detail::atan_tail(t2));
  // Each of the sums below is of a constant's leading part and what is smaller by far.
  constexpr T high = half_pi[0] + half_pi[1], low = (half_pi[0] - high + half_pi[1]) + half_pi[2];
  F angle = select(octant, F(high / 2) + (t + (tail + F(low / 2))), t + tail);
  angle = select(ay > ax, F(high) - (angle - F(low)), angle);
  angle = select(x < zero, F(2 * high) - (angle - F(2 * low)), angle);
  return select(y < zero, -angle, angle);
}

/// arccos x in [0, π] for x in [−1, 1], where 1 − x² is taken as (1 − x)(1 + x).
template <class F>
inline F arccos(const F& x) {
  const F one(scalar_t<F>(1));
  return arctan2(sqrt((one - x) * (one + x)), x);
}

/// arcsin x in [−π/2, π/2] for x in [−1, 1].
template <class F>
inline F arcsin(const F& x) {
  const F one(scalar_t<F>(1));
  return arctan2(x, sqrt((one - x) * (one + x)));
}

/// The largest power of two that is at most x, for normal x > 0: lengths are scaled by it without a rounding.
template <ScalarNumber F>
inline F power_of_two_below(F x) {
  using Bits = std::conditional_t<std::is_same_v<F, float>, std::uint32_t, std::uint64_t>;
  return std::bit_cast<F>(std::bit_cast<Bits>(x) & std::bit_cast<Bits>(std::numeric_limits<F>::infinity()));
}
template <Packet F>
inline F power_of_two_below(const F& x) {
  return x & F(std::numeric_limits<scalar_t<F>>::infinity());
}

/// The widest number type of this translation unit's target for lanes of T; plain T in the scalar build of the kernels.
#ifdef HALFSLOPE_SCALAR_KERNELS
template <class T>
using NativePacket = T;
#else
template <class T>
using NativePacket = xsimd::batch<T>;
#endif

}  // namespace halfslope
