#include "estimators/local_pixel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/estimators/expect_radiance.h"

namespace halfslope {
namespace {

template <class T>
class LocalPixels : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(LocalPixels, Numbers);

/// The share of `bsdf` samples that a Phong receiver gives its lobe.
template <class T>
T share_of(double diffuse, double specular) {
  const Scene scene = floor_under({ceiling_light(1, 1, 1, grey(1))}, phong(grey(diffuse), grey(specular), 10));
  const Emitters emitters = find_emitters(scene);
  return LocalPixel<T>(scene, emitters, {Vec3::Zero(), Vec3::UnitZ(), 0}, Vec3::UnitZ()).data.specular_share;
}

TYPED_TEST(LocalPixels, APhongLobesShareIsWhatItsCoordinatesCanChoose) {
  // u < share holds for just share · 2²⁴ of binary32's coordinates (2⁵³ of binary64's) if that is a whole number.
  using T = TypeParam;
  const double steps = std::is_same_v<T, float> ? 0x1p24 : 0x1p53;
  for (const double specular : {1e-30, 1e-18, 1e-9, 1e-6, 1e-3, 0.1, 0.5, 0.9}) {
    for (const double diffuse : {1e-30, 1e-18, 1e-9, 1e-6, 1e-3, 0.1}) {
      const double share = share_of<T>(diffuse, specular), exact = specular / (specular + diffuse);
      EXPECT_EQ(share * steps, std::round(share * steps)) << diffuse << ' ' << specular;
      EXPECT_NEAR(share, exact, 1 / steps) << diffuse << ' ' << specular;
      EXPECT_GT(share, 0) << "both reflect, so both are drawn";
      EXPECT_LT(share, 1) << "both reflect, so both are drawn";
    }
  }
  EXPECT_EQ(share_of<T>(0, 1e-30), 1);
  EXPECT_EQ(share_of<T>(1e-30, 0), 0);
}

TYPED_TEST(LocalPixels, AFaintLobeOrAFaintGroundIsNotLost) {
  // Under a dome the lobe along the normal reflects k_s and the rest k_d, however little that is beside the other.
  using T = TypeParam;
  const Primitive dome = emitting(sphere({0.4, 0.2, 0.1}, 2, true), grey(1));
  for (const auto& [k_d, k_s] : {std::pair(0.5, 1e-6), std::pair(1e-9, 0.5), std::pair(0.5, 1e-9)}) {
    Scene scene = floor_under({dome}, phong(grey(k_d), grey(k_s), 3));
    scene.sensor.rays = {looking({0, 0, 0.01}, Vec3::Zero())};
    for (const std::string estimator : {"bsdf", "balance", "balance@bsdf+cosine", "maximum@light+bsdf*2+surface"}) {
      const Request request = {.estimator = estimator, .sampler = "halton-owen", .rounds = 1024, .seed = 4};
      expect_mean(estimate<T>(lighting(scene), 0, request)[0], k_d + k_s, 4e-6, estimator);
    }
  }
}

TYPED_TEST(LocalPixels, ASharpLobeReflectsCosTheta) {
  // Where the lobe ends above the horizon, ∫ cosⁿα cos θ dω = cos θ_r 2π/(n + 2): k_s cos θ_r is reflected.
  using T = TypeParam;
  const Primitive dome = emitting(sphere({0.4, 0.2, 0.1}, 2, true), grey(1));
  for (const double exponent : {1e6, 1e8}) {
    for (const double degrees : {0.0, 60.0, 89.0}) {
      const double theta = degrees * std::numbers::pi / 180;
      Scene scene = floor_under({dome}, phong(grey(0), grey(0.7), exponent));
      scene.sensor.rays = {
          looking(0.01 * Vec3(0.6 * std::sin(theta), 0.8 * std::sin(theta), std::cos(theta)), Vec3::Zero())};
      for (const std::string estimator :
           {"bsdf", "balance", "power", "cutoff:0.1", "maximum", "balance@bsdf+surface"}) {
        const Request request = {.estimator = estimator, .sampler = "halton-owen", .rounds = 1024, .seed = 4};
        const std::string what = estimator + " n = " + std::to_string(exponent) + " at " + std::to_string(degrees);
        expect_mean(estimate<T>(lighting(scene), 0, request)[0], 0.7 * std::cos(theta),
                    std::is_same_v<T, float> ? 1e-5 : 1e-11, what);
      }
    }
  }
}

TYPED_TEST(LocalPixels, TheBsdfsDensityAndWhatFallsBelowTheHorizonMakeOne) {
  using T = TypeParam;
  // Under a dome every direction above the horizon meets the light, so its terms are there to be read. With p the
  // density of `bsdf` at uniform directions, the mean of 2π p is the part above; the rest of `bsdf`'s own samples is
  // worth nothing.
  const Primitive dome = emitting(sphere({0.4, 0.2, 0.1}, 2, true), grey(1));
  constexpr int kSide = 512;  // midpoints
  for (const Bsdf& bsdf : {diffuse(grey(0.5)), phong(grey(0.2), grey(0.5), 0), phong(grey(0.3), grey(0.3), 12),
                           phong(grey(0), grey(1), 1), phong(grey(0), grey(0.5), 60), conductor(0.5), conductor(1)}) {
    for (const double degrees : {0.0, 50.0, 84.0}) {
      const double theta = degrees * std::numbers::pi / 180;
      Scene scene = floor_under({dome}, bsdf);
      scene.sensor.rays = {looking(0.01 * Vec3(std::sin(theta), 0, std::cos(theta)), Vec3::Zero())};
      const DirectLighting source = lighting(scene);
      const PixelIntegral pixel = source.pixel(0);
      PointBlock points;
      // A lobe's number, where there is one, is spread evenly over the others' grid by two irrational steps.
      const int pair = source.techniques()[1].layout.dims() - 2;
      points.reset(2 + pair, kSide / kLanes, true);
      TermBlock<T> terms;
      const std::vector<int> set = {1, 2};
      terms.reset(1, 1, 2, kSide / kLanes);
      double above = 0, below = 0;
      for (int row = 0; row < kSide; ++row) {
        for (std::size_t i = 0; i < kSide; ++i) {
          const double spread = 0.7548776662466927 * row + 0.5698402909980532 * static_cast<double>(i);
          points.high(0)[i] = static_cast<std::uint32_t>((spread - std::floor(spread)) * 0x1p32);
          points.high(pair)[i] = static_cast<std::uint32_t>((row + 0.5) / kSide * 0x1p32);
          points.high(pair + 1)[i] = static_cast<std::uint32_t>((static_cast<double>(i) + 0.5) / kSide * 0x1p32);
          points.low(0)[i] = points.low(pair)[i] = points.low(pair + 1)[i] = 0;
        }
        pixel.integral->sample({2, pair, 0, set}, points, terms);
        for (std::size_t i = 0; i < kSide; ++i) {
          above += 2 * std::numbers::pi * static_cast<double>(terms.pdf(0, 0)[i]) / (kSide * kSide);
        }
        pixel.integral->sample({1, 0, 0, set}, points, terms);
        for (std::size_t i = 0; i < kSide; ++i) below += terms.pdf(0, 1)[i] > 0 ? 0 : 1.0 / (kSide * kSide);
      }
      EXPECT_NEAR(above + below, 1, 2e-3) << static_cast<int>(bsdf.kind) << ' ' << bsdf.exponent << " at " << degrees;
    }
  }
}

}  // namespace
}  // namespace halfslope
