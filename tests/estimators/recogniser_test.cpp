// Which pixels have a closed form, and its value; lights by figures computed outside this project.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "tests/estimators/expect_radiance.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

/// The closed form of pixel 0 in channel c.
std::optional<double> known(const Scene& scene, int c = 0) {
  const auto colour = lighting(scene).closed_form(0);
  if (!colour) return std::nullopt;
  return (*colour)[static_cast<std::size_t>(c)];
}

void expect_known(const Scene& scene, const Rgb& exact, const std::string& what) {
  for (int c = 0; c < 3; ++c) {
    const auto found = known(scene, c);
    ASSERT_TRUE(found) << what;
    EXPECT_NEAR(*found, exact[c], 1e-12 * exact[c]) << what;
  }
}

Primitive lamp() { return ceiling_light(2, 1, 2, grey(1)); }
constexpr double kLamp = 0.09018437056;  // its form factor over a corner, X = 1, Y = 1/2

TEST(Recogniser, FormFactorsOfRectanglesDisksAndSpheres) {
  const Rgb albedo(0.6, 0.5, 0.4), radiance(3, 2, 1);
  const auto expect = [&](const Primitive& light, double factor, const std::string& what) {
    const Scene scene = floor_under({light}, diffuse(albedo));
    expect_known(scene, albedo * radiance * factor, what);
    expect_known(moved(scene, some_turn(), 7, {1, 2, -3}), albedo * radiance * factor, what + " moved");
  };
  expect(ceiling_light(2, 1, 0.5, radiance), 0.2207776223347616, "rectangle 2 x 1 at 0.5");
  expect(ceiling_light(4, 4, 0.1, radiance), 0.24987220674946534, "rectangle 4 x 4 at 0.1");
  const auto disk_at = [&](double r, double h, double a) {
    return emitting(disk({a, 0, h}, r * Vec3::UnitY(), r * Vec3::UnitX()), radiance);
  };
  expect(disk_at(1, 2, 0), 0.2, "disk on axis");
  expect(disk_at(2, 0.3, 1.5), 0.9052108391896465, "disk off axis");
  expect(disk_at(1, 1, 3), 0.011906469908023687, "disk far off axis");
  const auto sphere_at = [&](double r, double d, double degrees) {
    const double theta = degrees * kPi / 180;
    return emitting(sphere({d * std::sin(theta), 0, d * std::cos(theta)}, r), radiance);
  };
  expect(sphere_at(1, 2, 45), 0.17677669529663692, "sphere at 45");
  expect(sphere_at(1, 2, 70), 0.08765460334902503, "sphere at 70");
  expect(sphere_at(1, 2, 110), 0.0021495675176077954, "sphere at 110");
  expect(sphere_at(0.9, 4, 85), 0.005185693420762436, "sphere at 85");
}

TEST(Recogniser, LightsAddAndWhatThePointEmitsIsAdded) {
  const Primitive square = ceiling_light(2, 1, 0.5, Rgb(1, 2, 3));
  const Primitive ball = emitting(sphere({-2, -2, 1}, 0.3), Rgb(5, 0, 1));
  const double of_ball = 0.09 / 9 * (1.0 / 3);
  const Rgb albedo(0.2, 0.5, 1), glow(0.25, 0, 4);
  const Rgb reflected = albedo * (square.radiance * 0.2207776223347616 + ball.radiance * of_ball);
  Scene scene = floor_under({square, ball}, diffuse(albedo));
  expect_known(scene, reflected, "two lights");
  scene.primitives[0] = emitting(scene.primitives[0], glow);
  expect_known(scene, glow + reflected, "a floor that glows");
  // What faces away or is below adds nothing, and takes nothing.
  scene.primitives.push_back(emitting(rectangle({0, 0, 3}, Vec3::UnitX(), Vec3::UnitY()), grey(9)));
  scene.primitives.push_back(emitting(sphere({0, 0, -3}, 1), grey(9)));
  expect_known(scene, glow + reflected, "and lights that do not reach it");
}

TEST(Recogniser, ADomeAndTheInsideOfALightShowTheirRadiance) {
  const Primitive dome = emitting(sphere({0.4, 0.2, 0.1}, 20, true), Rgb(1, 2, 3));
  const auto floor = lighting(floor_under({dome}, diffuse(Rgb(0.1, 0.2, 0.3)))).closed_form(0);
  ASSERT_TRUE(floor);
  EXPECT_DOUBLE_EQ((*floor)[0], 0.1);
  EXPECT_DOUBLE_EQ((*floor)[1], 0.4);
  EXPECT_DOUBLE_EQ((*floor)[2], 0.9);
  // A sphere that shines inwards on itself: L + albedo L, wherever on it and wherever it stands.
  std::vector<Ray> rays;
  for (int i = 0; i < 50; ++i) rays.push_back({Vec3(1, 1, 1), Vec3(i - 20, 3 * i - 70, 11).normalized()});
  const Scene shell = scene_of({made_of(dome, diffuse(grey(0.5)))}, rays);
  for (const double far : {0.0, 1e3, 1e6}) {
    const DirectLighting source = lighting(moved(shell, some_turn(), 0.7, {far, -far, far}));
    for (int pixel = 0; pixel < source.pixels(); ++pixel) {
      const auto found = source.closed_form(pixel);
      ASSERT_TRUE(found);
      EXPECT_DOUBLE_EQ((*found)[2], 4.5) << pixel << " at " << far;
    }
  }
}

TEST(Recogniser, GlossyReceiversAreSampled) {
  EXPECT_TRUE(known(floor_under({lamp()}, diffuse(grey(0.5)))));
  EXPECT_FALSE(known(floor_under({lamp()}, conductor(0.3))));
  EXPECT_FALSE(known(floor_under({lamp()}, phong(grey(0.5), grey(0.2), 10))));
}

TEST(Recogniser, WhatMayStandBetweenIsSampled) {
  const auto with = [](const Primitive& other) { return known(floor_under({lamp(), other}, diffuse(grey(0.5)))); };
  EXPECT_FALSE(with(sphere({0.5, 0.3, 1}, 0.1)));
  EXPECT_FALSE(with(disk({0.5, 0.3, 1}, 0.1 * Vec3::UnitX(), 0.1 * Vec3::UnitY())));
  EXPECT_FALSE(with(emitting(sphere({0.5, 0.3, 1}, 0.1), grey(1)))) << "a light may hide another";
  EXPECT_TRUE(with(sphere({-2, -2, 1}, 0.1))) << "beside";
  EXPECT_TRUE(with(sphere({0.5, 0.3, 5}, 0.1))) << "behind";
  EXPECT_NEAR(*with(sphere({0.5, 0.3, 5}, 0.1)), 0.5 * kLamp, 1e-8);
}

TEST(Recogniser, ADiskThatTheHorizonCutsIsSampled) {
  const auto standing = [](double z) {
    return floor_under({emitting(disk({2, 0, z}, 0.5 * Vec3::UnitZ(), 0.5 * Vec3::UnitY()), grey(1))},
                       diffuse(grey(0.5)));
  };
  ASSERT_LT(std::get<Flat>(standing(1).primitives[1].shape).normal.x(), 0) << "the disk must face the origin";
  EXPECT_TRUE(known(standing(0.51)));
  EXPECT_FALSE(known(standing(0.49)));
  EXPECT_FALSE(known(standing(-0.49)));
  ASSERT_TRUE(known(standing(-0.51)));
  EXPECT_EQ(*known(standing(-0.51)), 0);
}

TEST(Recogniser, ARectangleThatTheHorizonCutsIsClipped) {
  // Its lower half is hidden: what is left is a rectangle from z = 0 to 0.5, twice E₁₂ of its half 0.5 × 0.5 seen at
  // right angles from a corner, (atan(1/Y) − A Y atan A)/(2π), A = 1/√(X² + Y²) (J. R. Howell, catalogue B-4).
  const Primitive wall = emitting(rectangle({2, 0, 0}, 0.5 * Vec3::UnitZ(), 0.5 * Vec3::UnitY()), grey(1));
  const double x = 1, y = 4, a = 1 / std::sqrt(x * x + y * y);
  const double factor = 2 * (std::atan(1 / y) - a * y * std::atan(a)) / (2 * kPi);
  expect_known(floor_under({wall}, diffuse(grey(1))), grey(factor), "a wall through the floor");
}

TEST(Recogniser, PixelsThatAreNotSampledAreKnown) {
  const Scene sky = scene_of({lamp()}, {looking({0, 0, 0}, {0.1, 0.1, 2}), looking({0, 0, 0}, {0, 0, -1})});
  EXPECT_EQ((*lighting(sky).closed_form(0))[0], 1);
  EXPECT_EQ((*lighting(sky).closed_form(1))[0], 0);
}

}  // namespace
}  // namespace halfslope
