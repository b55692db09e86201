// The warps: unit length, heights that never vanish, and the densities that they promise, by moments and by area.
#include "scenes/warp.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace halfslope {
namespace {

template <class T>
class Warp : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(Warp, Numbers);

TYPED_TEST(Warp, DirectionsAreUnitLengthAndAboveTheHorizon) {
  using T = TypeParam;
  const T last = 1 - std::numeric_limits<T>::epsilon() / 2, ulps = 8 * std::numeric_limits<T>::epsilon();
  for (const T u1 : {T(0), std::numeric_limits<T>::epsilon(), T(0.25), T(0.5), T(0.9), last}) {
    for (const T u2 : {T(0), T(0.125), T(0.3), T(0.75), last}) {
      for (const Vec<T>& w : {cosine_hemisphere(u1, u2), uniform_hemisphere(u1, u2)}) {
        EXPECT_NEAR(dot(w, w), 1, ulps);
        EXPECT_GT(w.z, 0);
      }
      const Vec<T> w = uniform_sphere(u1, u2);
      EXPECT_NEAR(dot(w, w), 1, ulps);
      const DiskPoint<T> p = uniform_disk(u1, u2);
      EXPECT_NEAR(p.x * p.x + p.y * p.y, u1, ulps);
    }
  }
}

struct Moments {
  double z = 0, z2 = 0, x2 = 0, y2 = 0, xy = 0, x = 0;
};

/// Over the midpoints of an n × n grid.
template <class Map>
Moments moments(const Map& map) {
  const int n = 512;
  Moments m;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Vec<double> w = map((i + 0.5) / n, (j + 0.5) / n);
      const double weight = 1.0 / (n * n);
      m.z += w.z * weight, m.z2 += w.z * w.z * weight, m.x2 += w.x * w.x * weight, m.y2 += w.y * w.y * weight;
      m.xy += w.x * w.y * weight, m.x += w.x * weight;
    }
  }
  return m;
}

void expect_moments(const Moments& found, double z, double z2, double x2) {
  EXPECT_NEAR(found.z, z, 2e-5);
  EXPECT_NEAR(found.z2, z2, 2e-5);
  EXPECT_NEAR(found.x2, x2, 2e-5);
  EXPECT_NEAR(found.y2, x2, 2e-5);
  EXPECT_NEAR(found.xy, 0, 1e-12);
  EXPECT_NEAR(found.x, 0, 1e-12);
}

TEST(WarpMoments, AreThoseOfTheDensities) {
  expect_moments(moments(cosine_hemisphere<double>), 2.0 / 3, 0.5, 0.25);  // ∫ cos²/π dω, ∫ cos³/π dω
  expect_moments(moments(uniform_hemisphere<double>), 0.5, 1.0 / 3, 1.0 / 3);
  expect_moments(moments(uniform_sphere<double>), 0, 1.0 / 3, 1.0 / 3);
  expect_moments(moments([](double u1, double u2) {
                   const DiskPoint<double> p = uniform_disk(u1, u2);
                   return Vec<double>{p.x, p.y, 0};
                 }),
                 0, 0, 0.25);
}

TEST(WarpMoments, HeightsAreDistributedAsPromised) {
  // P(z < h): h² under the cosine, h on the hemisphere, (1 + h)/2 on the sphere; z falls with u₁, so it is 1 − u₁.
  for (const double u : {0.0, 0.1, 0.5, 0.999}) {
    EXPECT_NEAR(std::pow(cosine_hemisphere(u, 0.3).z, 2), 1 - u, 1e-15);
    EXPECT_NEAR(uniform_hemisphere(u, 0.3).z, 1 - u, 1e-15);
    EXPECT_NEAR(0.5 * (1 + uniform_sphere(u, 0.3).z), 1 - u, 1e-15);
  }
}

}  // namespace
}  // namespace halfslope
