// The number types of kernels. A kernel is a template over F: float, double, or a packet xsimd::batch<T> of them; the
// functions here mean the same for each, so the scalar build of a kernel is its packets' own reference.
#pragma once

#ifdef __FINITE_MATH_ONLY__
#if __FINITE_MATH_ONLY__
#error "halfslope needs IEEE infinities and NaNs: do not build with -ffast-math"
#endif
#endif

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
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

/// sin(2πu) and cos(2πu) for u in [0, 1]: u is reduced exactly to the nearest quarter turn, then the Taylor polynomials
/// on [−π/4, π/4] (truncation below a quarter ulp). No branches: one lane never changes another.
template <class F>
inline SinCos<F> sin_cos_2pi(const F& u) {
  using T = scalar_t<F>;
  const F quarter = floor_positive(fma(u, F(T(4)), F(T(0.5))));  // 0 … 4
  const F x = fma(quarter, F(T(-0.25)), u) * F(T(6.283185307179586476925286766559));
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

/// The widest number type of this translation unit's target for lanes of T; plain T in the scalar build of the kernels.
#ifdef HALFSLOPE_SCALAR_KERNELS
template <class T>
using NativePacket = T;
#else
template <class T>
using NativePacket = xsimd::batch<T>;
#endif

}  // namespace halfslope
