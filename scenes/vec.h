// Three-component vectors over the number types of kernels (core/packet.h).
#pragma once

#include "core/packet.h"

namespace halfslope {

template <class F>
struct Vec {
  F x, y, z;
};

template <class F>
inline Vec<F> operator+(const Vec<F>& a, const Vec<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
inline Vec<F> operator-(const Vec<F>& a, const Vec<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
inline Vec<F> operator-(const Vec<F>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class F>
inline Vec<F> operator*(const F& s, const Vec<F>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class F>
inline Vec<F> operator*(const Vec<F>& a, const F& s) {
  return s * a;
}

template <class F>
inline F dot(const Vec<F>& a, const Vec<F>& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
template <class F>
inline Vec<F> cross(const Vec<F>& a, const Vec<F>& b) {
  return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
}
template <class F>
inline F length(const Vec<F>& a) {
  return sqrt(dot(a, a));
}
/// a / |a|; NaN for the zero vector.
template <class F>
inline Vec<F> normalise(const Vec<F>& a) {
  return (F(scalar_t<F>(1)) / length(a)) * a;
}

}  // namespace halfslope
