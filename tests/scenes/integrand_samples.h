// What the integrands' tests share: a technique's samples at random points.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "scenes/integrand.h"

namespace halfslope {

inline constexpr double kPi = std::numbers::pi;
inline constexpr int kSamples = 64;

inline PointBlock random_points(int dims, int count = kSamples) {
  PointBlock points;
  points.reset(dims, count, true);
  std::mt19937_64 random(static_cast<std::uint64_t>(dims));
  for (int d = 0; d < dims; ++d) {
    for (std::size_t i = 0; i < points.stride(); ++i) {
      points.high(d)[i] = static_cast<std::uint32_t>(random());
      points.low(d)[i] = static_cast<std::uint32_t>(random() >> 43);
    }
  }
  // The ends of the interval too.
  for (int d = 0; d < dims; ++d) {
    points.high(d)[0] = points.low(d)[0] = 0;
    points.high(d)[1] = 0xffffffffu;
    points.low(d)[1] = (1u << 21) - 1;
  }
  return points;
}

template <class T>
double coordinate_as(const PointBlock& points, int dim, std::size_t i) {
  const double u = points.coordinate(dim, static_cast<int>(i / kLanes), static_cast<int>(i % kLanes));
  return std::is_same_v<T, float> ? std::floor(u * 0x1p24) * 0x1p-24 : u;
}

/// Value and densities of one technique at random points, with every density of the set.
template <class T>
struct Samples {
  PointBlock points;
  TermBlock<T> terms;
  Samples(const IntegralSource& scene, int technique)
      : points(random_points(scene.techniques()[static_cast<std::size_t>(technique)].layout.dims())) {
    std::vector<int> set;
    for (std::size_t k = 0; k < scene.techniques().size(); ++k) set.push_back(static_cast<int>(k));
    terms.reset(1, 1, static_cast<int>(set.size()), kSamples);
    scene.pixel(0).integral->sample({technique, 0, 0, set}, points, terms);
  }
  double u(int dim, std::size_t i) const { return coordinate_as<T>(points, dim, i); }
  std::size_t size() const { return points.stride(); }
  double value(std::size_t i) { return terms.value(0, 0)[i]; }
  double pdf(int k, std::size_t i) { return terms.pdf(0, k)[i]; }
};

template <class T>
class Integrands : public testing::Test {
 protected:
  static constexpr double kUlps = 16 * std::numeric_limits<T>::epsilon();
  static void close(double found, double exact) { ASSERT_LE(std::fabs(found - exact), kUlps * std::fabs(exact)); }
};
using Numbers = testing::Types<float, double>;

}  // namespace halfslope
