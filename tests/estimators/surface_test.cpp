// Technique `surface`: how it chooses among surfaces, and that what it says of itself is what it does.
#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "estimators/local_pixel.h"
#include "tests/estimators/expect_radiance.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

/// The number of 32-bit words that choose light l.
std::uint64_t words_of(const Emitters& emitters, std::size_t l) {
  const std::uint64_t last = emitters.surface_last[l];
  return l == 0 ? last + 1 : last - emitters.surface_last[l - 1];
}

/// All that must hold of any scene's choice.
void expect_consistent(const Scene& scene, const std::string& what) {
  const Emitters emitters = find_emitters(scene);
  ASSERT_EQ(emitters.surface_last.size(), emitters.lights.size()) << what;
  ASSERT_EQ(emitters.surface_probability.size(), emitters.lights.size()) << what;
  std::uint64_t sum = 0;
  for (std::size_t l = 0; l < emitters.lights.size(); ++l) {
    ASSERT_GT(l == 0 ? 1u : emitters.surface_last[l], l == 0 ? 0u : emitters.surface_last[l - 1]) << what;
    EXPECT_EQ(emitters.surface_probability[l] * 0x1p32, static_cast<double>(words_of(emitters, l))) << what;
    sum += words_of(emitters, l);
  }
  EXPECT_LE(sum, std::uint64_t{1} << 32) << what;
  const bool only_lights = emitters.lights.size() == scene.primitives.size();
  EXPECT_EQ(sum, only_lights ? std::uint64_t{1} << 32 : sum) << what;
}

/// Lights of these radii beside each other, and dark spheres.
Scene spheres(const std::vector<double>& lights, const std::vector<double>& dark) {
  std::vector<Primitive> all;
  double x = 0;
  const auto next = [&](double radius) {
    x += 2 * radius;
    return sphere({x, 0, 0}, radius);
  };
  for (const double radius : lights) all.push_back(emitting(next(radius), grey(1)));
  for (const double radius : dark) all.push_back(next(radius));
  return scene_of(all, {});
}

TEST(SurfaceChoice, FollowsAreas) {
  const Scene scene = spheres({1, 2, 0.5}, {3});
  expect_consistent(scene, "spheres");
  const Emitters emitters = find_emitters(scene);
  const double total = 1 + 4 + 0.25 + 9;  // of squared radii
  EXPECT_NEAR(emitters.surface_probability[0], 1 / total, 0x1p-32);
  EXPECT_NEAR(emitters.surface_probability[1], 4 / total, 0x1p-32);
  EXPECT_NEAR(emitters.surface_probability[2], 0.25 / total, 0x1p-32);
  // Rectangles by their sides, ellipses by their half axes.
  const auto probability = [](const Primitive& light) {
    const Primitive square = rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
    return find_emitters(scene_of({square, emitting(light, grey(1))}, {})).surface_probability[0];
  };
  const Vec3 u(0.3, 0.4, 0), v(0, 0, 2);
  EXPECT_NEAR(probability(rectangle(Vec3::Zero(), u, v)), 4.0 / (4 + 4), 0x1p-32);
  EXPECT_NEAR(probability(disk(Vec3::Zero(), u, v)), kPi / (kPi + 4), 0x1p-32);
}

TEST(SurfaceChoice, EveryLightIsReachedHoweverSmall) {
  for (const double radius : {3e-5, 1e-6, 1e-12, 1e-100, 1e-170}) {  // area ratios 1e-9, 1e-12, …, and one that is 0
    for (const auto& dark : {std::vector<double>{}, std::vector<double>{1}}) {
      const Scene scene = spheres({radius, 1, radius, 1}, dark);
      expect_consistent(scene, std::to_string(radius));
      for (std::size_t l = 0; l < 4; ++l) EXPECT_GE(words_of(find_emitters(scene), l), 1u);
    }
  }
  expect_consistent(spheres({1}, {}), "one light");
  expect_consistent(spheres({1, 1, 1}, {}), "three alike");
  expect_consistent(spheres({1e-9}, {1, 1, 1}), "one small");
  expect_consistent(spheres(std::vector<double>(1000, 1), {}), "a thousand alike");
}

TEST(SurfaceChoice, SamplesFollowTheStatedProbabilities) {
  // Each light has a colour of its own, a direction sees one of them, and the value of a sample tells which: a red
  // sphere, a green rectangle and a blue disk of areas π, 1 and 2π/3, over a floor of area 1 that is worth nothing.
  const Primitive red = emitting(sphere({-2, 0, 2}, 0.5), Rgb(1, 0, 0)),
                  green = emitting(rectangle({0, 0, 2}, 0.5 * Vec3::UnitY(), 0.5 * Vec3::UnitX()), Rgb(0, 1, 0)),
                  blue = emitting(disk({2, 0, 2}, Vec3::UnitY(), 2.0 / 3 * Vec3::UnitX()), Rgb(0, 0, 1));
  const Primitive floor = made_of(rectangle(Vec3::Zero(), 0.5 * Vec3::UnitX(), 0.5 * Vec3::UnitY()), diffuse(grey(1)));
  const Scene scene = scene_of({red, floor, green, blue}, {looking({0.01, 0.02, 0.05}, Vec3::Zero())});
  const double total = kPi + 1 + 1 + 2 * kPi / 3;
  const auto estimates =
      estimate<double>(lighting(scene), 0, {.estimator = "surface", .rounds = 1, .replicates = 1 << 18});
  // A point of the sphere faces the floor where cos ψ > 0: the cap 1/2 (1 − R/d) of it.
  const double d = std::sqrt(8.0), facing = 0.5 * (1 - 0.5 / d);
  const double expected[] = {kPi * facing / total, 1 / total, 2 * kPi / 3 / total};
  double chi_squared = 0, rest = 1 << 18, expected_rest = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    double count = 0;
    for (const double value : estimates[c]) count += value > 0 ? 1 : 0;
    const double mean = expected[c] * (1 << 18);
    chi_squared += (count - mean) * (count - mean) / mean;
    rest -= count;
    expected_rest -= expected[c];
  }
  const double mean = expected_rest * (1 << 18);
  chi_squared += (rest - mean) * (rest - mean) / mean;
  EXPECT_LT(chi_squared, boost::math::quantile(boost::math::complement(boost::math::chi_squared(3), 1e-6)));
}

TEST(SurfaceChoice, ATinyLightIsFoundAsOftenAsItsDensitySays) {
  // Area ratios 1e-9 and 1e-12. Only one word in 2³² · p chooses such a light, which no test waits for; but the mean of
  // all words is a sum over those that do: with the choice's high word at each end of the light's interval and the
  // other two numbers spread, the value · p must be the light's whole contribution, ρ L F.
  for (const double ratio : {1e-9, 1e-12}) {
    const double half = 0.5 * std::sqrt(ratio);
    const Primitive tiny = emitting(rectangle({0, 0, 1}, half * Vec3::UnitY(), half * Vec3::UnitX()), grey(1));
    const Primitive floor =
        made_of(rectangle(Vec3::Zero(), 0.5 * Vec3::UnitX(), 0.5 * Vec3::UnitY()), diffuse(grey(0.5)));
    const Scene scene = scene_of({floor, tiny}, {looking({0.01, 0.02, 0.05}, Vec3::Zero())});
    const DirectLighting source = lighting(scene);
    const Emitters emitters = find_emitters(scene);
    ASSERT_EQ(emitters.surface_last.size(), 1u);
    for (const std::uint32_t word : {0u, emitters.surface_last[0], emitters.surface_last[0] + 1}) {
      PointBlock points;
      points.reset(3, 64, true);
      for (std::size_t i = 0; i < points.stride(); ++i) {
        const auto golden = static_cast<std::uint32_t>(2654435769u * i), silver = static_cast<std::uint32_t>(i << 22);
        points.high(0)[i] = word, points.high(1)[i] = golden, points.high(2)[i] = silver;
        for (int dim = 0; dim < 3; ++dim) points.low(dim)[i] = 0;
      }
      TermBlock<double> terms;
      terms.reset(1, 1, 1, 64);
      const std::vector<int> set = {4};
      const PixelIntegral pixel = source.pixel(0);
      pixel.integral->sample({4, 0, 0, set}, points, terms);
      double mean = 0;
      for (std::size_t i = 0; i < terms.stride(); ++i)
        mean += terms.value(0, 0)[i] / static_cast<double>(terms.stride());
      const double contribution = emitters.surface_probability[0] * mean, exact = 0.5 * ratio / kPi;
      if (word > emitters.surface_last[0]) {
        EXPECT_EQ(mean, 0) << ratio;
      } else {
        EXPECT_NEAR(contribution / exact, 1, 1e-8) << ratio;
      }
    }
  }
}

TEST(SurfaceChoice, ASmallLightBeforeAWideOneIsWithoutBias) {
  // `surface` seldom meets the small sphere; what it says of its density there decides what `light` is worth.
  const Primitive wide = ceiling_light(6, 6, 3, grey(1)), tiny = emitting(sphere({0.5, 0.4, 1}, 0.01), grey(1000));
  const double factor = 1e-4 / std::pow(1.41, 1.5), corner = 2 / std::sqrt(5.0) * std::atan(2 / std::sqrt(5.0)) / kPi;
  // It hides as much of the wide light as it covers itself.
  const double exact = 0.5 * (1000 * factor + corner - factor);
  const DirectLighting source = lighting(floor_under({tiny, wide}, diffuse(grey(0.5))));
  for (const std::string estimator : {"balance@light+surface", "power@light+surface", "maximum@light*2+surface"}) {
    const Request request = {.estimator = estimator, .sampler = "halton-owen", .rounds = 4096};
    expect_mean(estimate<double>(source, 0, request)[0], exact, 1e-11, estimator);
    expect_mean(estimate<float>(source, 0, request)[0], exact, 4e-6, estimator);
  }
}

}  // namespace
}  // namespace halfslope
