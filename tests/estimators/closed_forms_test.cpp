// Direct light against closed forms: every technique and combination, in both precisions, within t⁻¹(1 − 5e-7) standard
// errors of 64 replicates (a false alarm in a million for each comparison).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/closed_form.h"
#include "tests/estimators/expect_radiance.h"
#include "tests/estimators/random_scenes.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

/// The form factor of a rectangle of sides a and b at height c over its corner: 1/(2π) [X/√(1+X²) atan(Y/√(1+X²)) +
/// Y/√(1+Y²) atan(X/√(1+Y²))], X = a/c, Y = b/c.
double corner_factor(double a, double b, double c) {
  const double x = a / c, y = b / c, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

/// Lambert's formula for a rectangle above the horizon that faces the origin, where the normal is +z: E/(π L).
double lambert_factor(const Flat& r) {
  const std::array<Vec3, 4> v = {r.center - r.half_u - r.half_v, r.center + r.half_u - r.half_v,
                                 r.center + r.half_u + r.half_v, r.center - r.half_u + r.half_v};
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 a = v[i].normalized(), b = v[(i + 1) % 4].normalized(), gamma = a.cross(b);
    sum += std::atan2(gamma.norm(), a.dot(b)) * gamma.normalized().z();
  }
  return std::fabs(sum) / (2 * kPi);
}

TEST(ClosedForms, RectangleOverACorner) {
  EXPECT_NEAR(corner_factor(2, 1, 0.5), 0.2207776223347616, 1e-15);
  EXPECT_NEAR(corner_factor(4, 4, 0.1), 0.24987220674946534, 1e-15);
  const auto at = [](double a, double b, double c) {
    return floor_under({ceiling_light(a, b, c, grey(3))}, diffuse(grey(0.6)));
  };
  expect_radiance(at(2, 1, 0.5), grey(0.6 * 3 * corner_factor(2, 1, 0.5)), "corner of 2 x 1 at 0.5");
  expect_radiance(at(4, 4, 1), grey(0.6 * 3 * corner_factor(4, 4, 1)), "corner of 4 x 4 at 1");
  // The nearly touching one wants many points by area.
  expect_radiance(at(4, 4, 0.1), grey(0.6 * 3 * corner_factor(4, 4, 0.1)), "corner of 4 x 4 at 0.1", 8192);
}

TEST(ClosedForms, TiltedRectangle) {
  const Vec3 u = Vec3(1, 0.2, 0.3).normalized() * 0.4, v = u.cross(Vec3(0.1, 0.2, 1)).normalized() * 0.7;
  const Primitive light = emitting(rectangle({0.5, -0.6, 1.1}, u, v), grey(2));
  const auto& r = std::get<Flat>(light.shape);
  ASSERT_LT(r.normal.dot(r.center), 0) << "the test's light must face the origin";
  expect_radiance(floor_under({light}, diffuse(grey(0.5))), grey(lambert_factor(r)), "tilted rectangle");
}

TEST(ClosedForms, RectangleThatFacesAwayIsBlack) {
  const Primitive away = emitting(rectangle({0, 0, 1}, Vec3::UnitX(), Vec3::UnitY()), grey(5));
  expect_radiance(floor_under({away}, diffuse(grey(0.5))), grey(0), "a light that faces away");
  // Beside another light it takes its half of the light samples, and shades it.
  const Primitive above = ceiling_light(2, 1, 2, grey(1));
  const Primitive beyond = emitting(rectangle({-4, -4, 1}, Vec3::UnitX(), Vec3::UnitY()), grey(5));
  expect_radiance(floor_under({above, beyond}, diffuse(grey(0.5))), grey(0.5 * corner_factor(2, 1, 2)), "one of two");
  const Primitive between = emitting(rectangle({0, 0, 1}, 9 * Vec3::UnitX(), 9 * Vec3::UnitY()), grey(5));
  expect_radiance(floor_under({above, between}, diffuse(grey(0.5))), grey(0), "one before the other");
}

struct SphereCase {
  double radius, distance, theta_degrees, factor;  ///< E/(π L)
};

TEST(ClosedForms, SphereAboveAndThroughTheHorizon) {
  for (const SphereCase& c :
       {SphereCase{1, 2, 45, 0.17677669529663692}, SphereCase{1, 2, 70, 0.08765460334902503},
        SphereCase{1, 2, 110, 0.0021495675176077954}, SphereCase{0.9, 4, 85, 0.005185693420762436}}) {
    const double theta = c.theta_degrees * kPi / 180;
    const Vec3 center = c.distance * Vec3(0.6 * std::sin(theta), -0.8 * std::sin(theta), std::cos(theta));
    // A small floor: it must not hide the part of the sphere that is below.
    const Primitive tile =
        made_of(rectangle(Vec3::Zero(), 0.1 * Vec3::UnitX(), 0.1 * Vec3::UnitY()), diffuse(grey(0.7)));
    const Scene scene =
        scene_of({emitting(sphere(center, c.radius), grey(4)), tile}, {looking({0.003, 0.004, 0.01}, Vec3::Zero())});
    const std::string what = "sphere at " + std::to_string(c.theta_degrees);
    expect_radiance(scene, grey(0.7 * 4 * c.factor), what, 2048);
    expect_radiance(moved(scene, some_turn(), 3, {20, -30, 10}), grey(0.7 * 4 * c.factor), what + " moved", 2048);
  }
}

struct DiskCase {
  double radius, height, offset, factor;  ///< E/(π L) under a disk that is parallel to the receiver
};

TEST(ClosedForms, DiskOnAndOffItsAxis) {
  for (const DiskCase& c :
       {DiskCase{1, 2, 0, 0.2}, DiskCase{2, 0.3, 1.5, 0.9052108391896465}, DiskCase{1, 1, 3, 0.011906469908023687}}) {
    const double r = c.radius;
    const Primitive light =
        emitting(disk({0.6 * c.offset, -0.8 * c.offset, c.height}, r * Vec3::UnitY(), r * Vec3::UnitX()), grey(3));
    const std::string what = "disk at " + std::to_string(c.height) + " off by " + std::to_string(c.offset);
    expect_radiance(floor_under({light}, diffuse(grey(0.6))), grey(0.6 * 3 * c.factor), what, 2048);
  }
}

TEST(ClosedForms, TiltedEllipsesBesideARectangleInColour) {
  const Vec3 u = Vec3(1, 0.2, 0.3).normalized(), v = u.cross(Vec3(0.1, 0.2, 1)).normalized();
  const Primitive first = emitting(disk({0.5, -0.6, 1.1}, 0.4 * u, 0.7 * v), Rgb(1, 2, 4)),
                  second = emitting(disk({-0.9, 0.8, 0.7}, 0.2 * u, 0.3 * v), Rgb(9, 0, 5)),
                  third = emitting(rectangle({-1, -0.5, 2.5}, 0.5 * Vec3::UnitY(), Vec3::UnitX()), Rgb(1, 1, 0));
  double factors[2];
  for (const Primitive* light : {&first, &second}) {
    const auto& flat = std::get<Flat>(light->shape);
    ASSERT_LT(flat.normal.dot(flat.center), 0) << "the test's lights must face the origin";
    const auto factor = form_factor(*light, Vec3::Zero(), Vec3::UnitZ());
    ASSERT_TRUE(factor);
    factors[light == &second] = *factor;
  }
  const Rgb albedo(0.2, 0.5, 0.9);
  const Rgb exact =
      albedo * (first.radiance * factors[0] + second.radiance * factors[1] + third.radiance * corner_factor(2, 1, 2.5));
  const Scene scene = floor_under({first, second, third}, diffuse(albedo));
  expect_radiance(scene, exact, "ellipses", 2048);
  expect_radiance(moved(scene, some_turn(), 30, {-4, 0, 7}), exact, "ellipses moved", 2048);
}

TEST(ClosedForms, RandomLights) {
  RandomScenes random(77);
  int tested = 0;
  while (tested < 24) {
    const Vec3 u = random.direction(), v = u.cross(random.direction()).normalized(), center = random.in_box(1.5);
    const double a = std::pow(10, random.uniform(-0.7, 0.3)), b = std::pow(10, random.uniform(-0.7, 0.3));
    Primitive light = rectangle(center, a * u, b * v);
    if (tested % 3 == 1) light = disk(center, a * u, b * v);
    if (tested % 3 == 2) light = sphere(center, a);
    light = emitting(light, grey(2));
    const Scene scene = floor_under({light}, diffuse(grey(0.5)));
    const auto exact = lighting(scene).closed_form(0);
    // What is seen at all, and of which 1000 samples meet enough.
    if (first_hit(scene, scene.sensor.rays[0]).primitive != 0 || !exact || (*exact)[0] < 0.01) continue;
    expect_radiance(scene, grey((*exact)[0]), "random light " + std::to_string(tested++));
  }
}

TEST(ClosedForms, TwoLightsAddInEveryChannel) {
  const Rgb first(1, 2, 3), second(7, 0.5, 0), albedo(0.2, 0.5, 0.9);
  const Vec3 center(-1.2, -0.9, 2);
  const Primitive ball = emitting(sphere(center, 0.5), second);
  const double cosine = center.z() / center.norm(), factor = 0.25 / center.squaredNorm() * cosine;
  const Scene scene = floor_under({ceiling_light(2, 1, 0.5, first), ball}, diffuse(albedo));
  const Rgb exact = albedo * (first * corner_factor(2, 1, 0.5) + second * factor);
  expect_radiance(scene, exact, "two lights", 2048);
  expect_radiance(moved(scene, some_turn(), 0.1, {3, 4, 5}), exact, "two lights moved", 2048);
}

TEST(ClosedForms, InsideALightEverythingIsLit) {
  // A diffuse floor that sees radiance L all around reflects albedo · L, whatever the shape of the light.
  const Primitive dome = emitting(sphere({0.4, 0.2, 0.1}, 20, true), Rgb(1, 2, 3));
  expect_radiance(floor_under({dome}, diffuse(Rgb(0.1, 0.2, 0.3))), Rgb(0.1, 0.4, 0.9), "under a dome");
  // Lit by the light's own inside: E = π L on the wall of a sphere, from one bounce.
  Scene wall = scene_of({made_of(dome, diffuse(grey(0.5)))}, {{Vec3(1, 1, 1), Vec3(1, 2, 3).normalized()}});
  expect_radiance(wall, 0.5 * Rgb(1, 2, 3), "on the inside of a light");
  expect_radiance(moved(wall, some_turn(), 0.7, {1, 1, 0}), 0.5 * Rgb(1, 2, 3), "on the inside of a light, moved");
}

TEST(ClosedForms, TheInsideOfASphereShadesWhatIsOutside) {
  const Primitive shell = made_of(sphere({0, 0, 0}, 1, true), diffuse(grey(0.5)));
  const Primitive outside = emitting(sphere({0, 0, 3}, 0.5), grey(100)),
                  inside = emitting(sphere({0, 0, 0}, 0.25), grey(1));
  const Ray down = {Vec3(0.5, 0, 0.5), Vec3(0.1, 0, -1).normalized()};
  expect_radiance(scene_of({shell, outside}, {down}), grey(0), "a light outside the shell");
  // From the wall the small light covers sin² = 1/16 about the normal.
  expect_radiance(scene_of({shell, outside, inside}, {down}), grey(0.5 / 16), "and one inside", 2048);
}

TEST(ClosedForms, ALightFlushWithAWallIsNotInItsShadow) {
  const Primitive wall = made_of(rectangle({0, 0, 1}, 3 * Vec3::UnitY(), 3 * Vec3::UnitX()), diffuse(grey(0.5)));
  const Scene scene = floor_under({wall, ceiling_light(2, 1, 1, grey(1))}, diffuse(grey(1)));
  expect_radiance(scene, grey(corner_factor(2, 1, 1)), "flush");
  expect_radiance(moved(scene, some_turn(), 1.3, {7, 8, 9}), grey(corner_factor(2, 1, 1)), "flush, moved");
}

TEST(ClosedForms, ACoplanarShapeShadesNothing) {
  // Another tile in the floor's plane, before a light that reaches through that plane.
  const Primitive tile = rectangle({0.05, 0.05, 0}, Vec3::UnitX(), Vec3::UnitY());
  const Primitive receiver =
      made_of(rectangle(Vec3::Zero(), 0.1 * Vec3::UnitX(), 0.1 * Vec3::UnitY()), diffuse(grey(0.7)));
  const Primitive light = emitting(sphere(2 * Vec3(std::sin(70 * kPi / 180), 0, std::cos(70 * kPi / 180)), 1), grey(1));
  const Scene scene = scene_of({receiver, tile, light}, {looking({0.003, 0.004, 0.01}, Vec3::Zero())});
  expect_radiance(scene, grey(0.7 * 0.08765460334902503), "tile", 2048);
  // Turned, the two planes differ by rounding, and so does which of them a ray sees; wherever it is the receiver, the
  // tile changes no bit.
  std::vector<Ray> rays;
  for (int i = 0; i < 100; ++i) rays.push_back(looking({0.003, 0.004, 0.01}, {0.0005 * i, -0.0003 * i, 0}));
  const Scene both = moved(scene_of({receiver, tile, light}, rays), some_turn(), 1, {0.1, 0.2, 0.3});
  Scene one = both;
  one.primitives.erase(one.primitives.begin() + 1);
  const DirectLighting with_tile = lighting(both), without = lighting(one);
  int compared = 0;
  for (int pixel = 0; pixel < with_tile.pixels(); ++pixel) {
    if (first_hit(both, both.sensor.rays[static_cast<std::size_t>(pixel)]).primitive != 0) continue;
    ++compared;
    const Request request = {.estimator = "light", .rounds = 64, .replicates = kLanes};
    ASSERT_EQ(estimate<double>(with_tile, pixel, request), estimate<double>(without, pixel, request)) << pixel;
  }
  EXPECT_GT(compared, 10);
}

TEST(ClosedForms, Binary32KnowsWhichSideOfACloseWallItIsOn) {
  // A wide wall passes 3e-7 behind the receiver and through the light, of which it hides the half behind it. Binary32
  // rounds the wall's centre by more than that.
  const Primitive receiver =
      made_of(rectangle(Vec3::Zero(), 0.1 * Vec3::UnitX(), 0.1 * Vec3::UnitY()), diffuse(grey(0.7)));
  const Vec3 n = Vec3(0.8, 0.3, 0.5).normalized(), side = n.cross(Vec3::UnitZ()).normalized(), up = side.cross(n);
  const Primitive wall = rectangle(-3e-7 * n + 13 * up + 7 * side, 60 * side, 60 * up);
  const Primitive light = emitting(sphere(2 * up, 0.5), grey(1));
  std::vector<Ray> rays;
  for (int i = 0; i < 32; ++i) rays.push_back(looking(0.01 * n, 0.0005 * i * side));
  const DirectLighting source = lighting(scene_of({receiver, wall, light}, rays));
  for (int pixel = 0; pixel < source.pixels(); ++pixel) {
    const Request request = {.estimator = "light", .rounds = 64, .replicates = kLanes};
    const auto f32 = estimate<float>(source, pixel, request)[0], f64 = estimate<double>(source, pixel, request)[0];
    for (std::size_t l = 0; l < kLanes; ++l) {
      ASSERT_GT(f64[l], 0);
      ASSERT_NEAR(f32[l] / f64[l], 1, 1e-4) << pixel;
    }
  }
}

TEST(ClosedForms, TheUnitOfLengthDoesNotMatter) {
  const Scene scene = floor_under({ceiling_light(2, 1, 0.5, grey(3))}, diffuse(grey(0.6)));
  for (const double unit : {0x1p-100, 0x1p-70, 0x1p70, 0x1p100}) {  // r² is beyond binary32, r is not
    const DirectLighting here = lighting(scene);
    const DirectLighting there = lighting(moved(scene, Eigen::Matrix3d::Identity(), unit, Vec3::Zero()));
    for (const std::string estimator : {"light", "bsdf", "balance"}) {
      const Request request = {.estimator = estimator, .rounds = 64};
      EXPECT_EQ(estimate<float>(here, 0, request), estimate<float>(there, 0, request)) << unit << ' ' << estimator;
      EXPECT_EQ(estimate<double>(here, 0, request), estimate<double>(there, 0, request)) << unit << ' ' << estimator;
    }
  }
}

}  // namespace
}  // namespace halfslope
