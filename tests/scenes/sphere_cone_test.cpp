// Spheres drawn by solid angle: the stated density by chi-squared from tiny cones to touching and inside, geometry of
// the point, the mean of a cosine against the closed form, and packets.
#include "scenes/sphere_cone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/scenes/chi_squared.h"
#include "tests/scenes/form_factor_helpers.h"

namespace halfslope {
namespace {

struct Case {
  std::string name;
  Vec<double> center;
  double radius;
};

const std::vector<Case>& spheres() {
  static const std::vector<Case> kCases = {
      {"half as far as large", {0, 0, 1}, 0.5},
      {"1e-8 rad", {1, 2, 3}, 3.7416573867739413e-8},
      {"1e-4 rad", {1, -2, 3}, 3.7416573867739413e-4},
      {"the sun", {0, 149597863936.0, 1000000.0}, 695699968.0},
      {"grazing the horizon", {1, 0, 0.25}, 0.5},
      {"close", {1, 2, 3}, 3.5},
      {"almost touching", {1, 2, 3}, 3.74},
      {"around the receiver", {0.25, 0.125, 0.5}, 1},
      {"centred on the receiver", {0, 0, 0}, 1},
      {"just inside", {0, 0, 0.9990234375}, 1},
  };
  return kCases;
}

template <class T>
struct Drawn {
  Vec<T> center;
  T radius;
  explicit Drawn(const Case& c)
      : center{static_cast<T>(c.center.x), static_cast<T>(c.center.y), static_cast<T>(c.center.z)},
        radius(static_cast<T>(c.radius)) {}
  SpherePoint<T> operator()(T u1, T u2) const { return sample_sphere_solid_angle(center, radius, u1, u2); }
  Vec<double> middle() const { return {double{center.x}, double{center.y}, double{center.z}}; }
};

Vec<double> in_double(const auto& v) { return {double{v.x}, double{v.y}, double{v.z}}; }

template <class T>
class SphereCone : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(SphereCone, Numbers);

// In the cone 1 − cos θ and the azimuth are uniform, so 8 × 8 bins of either are equally likely; all around, likewise.
TYPED_TEST(SphereCone, DirectionsAreUniformInSolidAngle) {
  using T = TypeParam;
  constexpr int kBins = 8;
  for (const Case& c : spheres()) {
    const Drawn<T> draw(c);
    const Vec<double> middle = draw.middle();
    const double radius = draw.radius, d = length(middle), s = std::min(1.0, radius / d);
    const bool inside = d < radius;
    const Vec<double> axis = d > 0 ? (1 / d) * middle : Vec<double>{0, 0, 1};
    const Vec<double> side =
        normalise(cross(axis, std::fabs(axis.x) > 0.5 ? Vec<double>{0, 1, 0} : Vec<double>{1, 0, 0}));
    const Vec<double> other = cross(axis, side);
    std::vector<double> counts(kBins * kBins), probabilities(kBins * kBins, 1.0 / (kBins * kBins));
    Coordinates<T> random(31);
    for (int k = 0; k < 40000; ++k) {
      const T u1 = random(), u2 = random();
      const SpherePoint<T> p = draw(u1, u2);
      ASSERT_EQ(p.outside, !inside) << c.name;
      // A small cone's directions differ in digits that a unit vector of T has not, the points on the sphere do not.
      const Vec<double> way = s < 0.125 ? middle + radius * in_double(p.outward) : in_double(p.direction);
      const double sine = length(cross(way, axis)) / length(way), cosine = dot(way, axis) / length(way);
      const double rise = cosine > 0 ? sine * sine / (1 + cosine) : 1 - cosine;
      const double share = inside ? rise / 2 : rise * (1 + std::sqrt((1 - s) * (1 + s))) / (s * s);
      EXPECT_LE(share, 1 + 64 * std::numeric_limits<T>::epsilon()) << c.name;
      const double turns = std::atan2(dot(way, other), dot(way, side)) / (2 * std::numbers::pi) + 0.5;
      const auto bin = [](double x) { return std::clamp(static_cast<int>(x * kBins), 0, kBins - 1); };
      counts[static_cast<std::size_t>(bin(share) * kBins + bin(turns))] += 1;
      const double exact =
          inside ? 0.25 / std::numbers::pi : (1 + std::sqrt((1 - s) * (1 + s))) / (2 * std::numbers::pi) / s / s;
      ASSERT_NEAR(p.pdf / exact, 1, (c.name == "almost touching" ? 4096 : 32) * std::numeric_limits<T>::epsilon())
          << c.name;
    }
    expect_distribution(counts, probabilities, 1e-6 / static_cast<double>(spheres().size()), c.name);
  }
}

TYPED_TEST(SphereCone, ThePointLiesOnTheSphereWhereTheRayMeetsItFirst) {
  using T = TypeParam;
  const double eps = std::numeric_limits<T>::epsilon(), last = 1 - eps / 2;
  for (const Case& c : spheres()) {
    const Drawn<T> draw(c);
    const Vec<double> middle = draw.middle();
    const double radius = draw.radius, d = length(middle);
    // What is left where distance or radius nearly cancel is a rounding of the larger.
    const double rounding = 32 * eps * std::max(1.0, std::min(d, radius) / std::fabs(d - radius));
    for (const double u1 : {0.0, eps, 0.25, 0.5, 0.75, 1 - 1e-3, last}) {
      for (const double u2 : {0.0, 0.3, 0.6, last}) {
        const SpherePoint<T> p = draw(static_cast<T>(u1), static_cast<T>(u2));
        const Vec<double> outward = in_double(p.outward), direction = in_double(p.direction);
        EXPECT_NEAR(length(outward), 1, 8 * eps) << c.name;
        EXPECT_NEAR(length(direction), 1, 8 * eps) << c.name;
        const Vec<double> by_sphere = middle + radius * outward, by_ray = double{p.distance} * direction;
        EXPECT_LE(length(by_sphere - by_ray),
                  rounding * std::max(d, radius) * (1 + double{p.distance} / std::max(d, radius)))
            << c.name << ' ' << u1 << ' ' << u2;
        EXPECT_NEAR(p.cosine, (p.outside ? -1 : 1) * dot(outward, direction), 32 * rounding) << c.name << ' ' << u1;
        EXPECT_GE(p.cosine, 0) << c.name;
        EXPECT_GE(p.distance, 0) << c.name;
        EXPECT_LE(p.distance, (d + radius) * (1 + 4 * eps)) << c.name;
      }
    }
  }
}

TYPED_TEST(SphereCone, TheMeanCosineIsTheClosedForm) {
  using T = TypeParam;
  for (const Case& c : spheres()) {
    const Drawn<T> draw(c);
    const Vec<double> middle = draw.middle();
    const bool inside = length(middle) < draw.radius;
    const auto exact = factor(sphere({middle.x, middle.y, middle.z}, draw.radius, inside));
    ASSERT_TRUE(exact.has_value()) << c.name;
    constexpr int kSamples = 20000;
    double sum = 0, squares = 0, first = -1, pdf = 0;
    Coordinates<T> random(37);
    for (int s = 0; s < kSamples; ++s) {
      const T u1 = random(), u2 = random();
      const SpherePoint<T> p = draw(u1, u2);
      const double cosine = std::max(0.0, double{p.direction.z});
      if (first < 0) first = cosine;
      sum += cosine - first, squares += (cosine - first) * (cosine - first), pdf = p.pdf;
    }
    const double shift = sum / kSamples, mean = first + shift;
    const double se = std::sqrt(std::max(0.0, squares / kSamples - shift * shift) / kSamples);
    const double expected = *exact * std::numbers::pi * pdf;
    const double rounding = c.name == "almost touching" ? 4096 : 32;
    EXPECT_NEAR(mean, expected, 5.5 * se + rounding * std::numeric_limits<T>::epsilon() * expected) << c.name;
  }
}

TYPED_TEST(SphereCone, TouchingItIsAHemisphere) {
  using T = TypeParam;
  const SpherePoint<T> p = sample_sphere_solid_angle<T>({T(0), T(0), T(1)}, T(1), T(0.75), T(0.1));
  EXPECT_EQ(p.outside, true);
  EXPECT_NEAR(p.pdf, 0.5 / std::numbers::pi, 1e-7);
  EXPECT_NEAR(p.direction.z, 0.25, 1e-6);  // z is uniform on a hemisphere
  EXPECT_EQ(p.distance, 0);
}

TYPED_TEST(SphereCone, TheDensityAloneIsTheOneDrawnWith) {
  using T = TypeParam;
  for (const Case& c : spheres()) {
    const Drawn<T> draw(c);
    mask_t<T> outside;
    const T pdf = sphere_solid_angle_pdf(draw.center, draw.radius, outside);
    const SpherePoint<T> p = draw(T(0.3), T(0.6));
    EXPECT_EQ(outside, p.outside) << c.name;
    EXPECT_NEAR(pdf / p.pdf, 1, 4 * std::numeric_limits<T>::epsilon()) << c.name;
  }
}

// From 1e-15 of its distance to touching, from inside to its middle: finite, and of the sphere.
TYPED_TEST(SphereCone, AtAllSizesPointsAreOfTheSphere) {
  using T = TypeParam;
  Coordinates<T> random(13);
  const T eps = std::numeric_limits<T>::epsilon();
  for (int exponent = -50; exponent <= 50; ++exponent) {
    for (int k = 0; k < 40; ++k) {
      const T distance = exponent <= 0 ? T(1)
                         : k % 2       ? 1 + std::ldexp(T(1), -exponent)
                                       : 1 - std::ldexp(T(1), -exponent);
      const T radius = exponent <= 0 ? std::ldexp(T(1), exponent) : T(1);
      const T u1 = k % 3 == 0 ? 1 - eps / 2 : random(), u2 = random();
      const SpherePoint<T> p = sample_sphere_solid_angle<T>({T(0), -distance, T(0)}, radius, u1, u2);
      EXPECT_NEAR(dot(p.direction, p.direction), 1, 8 * eps) << exponent << ' ' << k;
      EXPECT_NEAR(dot(p.outward, p.outward), 1, 8 * eps) << exponent << ' ' << k;
      EXPECT_GT(p.pdf, 0);
      EXPECT_TRUE(std::isfinite(p.pdf));
      EXPECT_LE(std::fabs(p.distance - distance), radius * (1 + 8 * eps) + 2 * eps) << exponent << ' ' << k;
    }
  }
}

TYPED_TEST(SphereCone, PacketsDrawWhatScalarsDo) {
  using T = TypeParam;
  using F = NativePacket<T>;
  constexpr auto kLanes = static_cast<std::size_t>(kWidth<F>);
  alignas(64) std::array<T, kLanes> x, y, z, radius, u1, u2, distance, pdf, normal;
  Coordinates<T> random(5);
  for (std::size_t first = 0; first < spheres().size(); ++first) {
    const auto of_lane = [&](std::size_t l) { return Drawn<T>(spheres()[(first + l) % spheres().size()]); };
    for (std::size_t l = 0; l < kLanes; ++l) {
      const Drawn<T> c = of_lane(l);
      x[l] = c.center.x, y[l] = c.center.y, z[l] = c.center.z, radius[l] = c.radius, u1[l] = random(), u2[l] = random();
    }
    const SpherePoint<F> p =
        sample_sphere_solid_angle<F>({load<F>(x.data()), load<F>(y.data()), load<F>(z.data())}, load<F>(radius.data()),
                                     load<F>(u1.data()), load<F>(u2.data()));
    store(distance.data(), p.distance), store(pdf.data(), p.pdf), store(normal.data(), p.outward.y);
    for (std::size_t l = 0; l < kLanes; ++l) {
      const SpherePoint<T> alone = of_lane(l)(u1[l], u2[l]);
      EXPECT_EQ(distance[l], alone.distance);
      EXPECT_EQ(pdf[l], alone.pdf);
      EXPECT_EQ(normal[l], alone.outward.y);
    }
  }
}

}  // namespace
}  // namespace halfslope
