#include "scenes/scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

namespace halfslope {
namespace {

void expect_vector(const Vec3& found, const Vec3& expected, double tolerance = 1e-15) {
  EXPECT_LE((found - expected).norm(), tolerance) << found.transpose() << " is not " << expected.transpose();
}

Scene scene_of(const Shape& shape) {
  Scene scene;
  scene.primitives.push_back({.shape = shape, .bsdf = {}, .emits = false, .radiance = Rgb::Zero(), .id = "shape1"});
  return scene;
}

/// A camera at the origin that looks along +z with +y up: the image's left is +x, as in Mitsuba.
Sensor camera(double fov, Sensor::FovAxis axis) {
  Sensor sensor;
  sensor.fov_degrees = fov;
  sensor.fov_axis = axis;
  return sensor;
}

TEST(Sensor, RaysGoThroughPixelCentres) {
  const Sensor sensor = camera(90, Sensor::FovAxis::kX);  // at distance 1 the image is 2 wide and, at 4 × 2, 1 high
  expect_vector(sensor.ray(0, 0, 4, 2).direction, Vec3(0.75, 0.25, 1).normalized());
  expect_vector(sensor.ray(3, 0, 4, 2).direction, Vec3(-0.75, 0.25, 1).normalized());
  expect_vector(sensor.ray(0, 1, 4, 2).direction, Vec3(0.75, -0.25, 1).normalized());
  expect_vector(sensor.ray(2, 1, 5, 3).direction, Vec3(0, 0, 1));  // the middle of odd sizes
}

TEST(Sensor, FovAxisChoosesTheSideThatItSpans) {
  const auto corner = [](Sensor::FovAxis axis, int width, int height) {  // tan of the image's half width
    const Vec3 d = camera(90, axis).ray(0, 0, width, height).direction;
    return d.x() / d.z() / (1 - 1.0 / width);
  };
  using Axis = Sensor::FovAxis;
  EXPECT_NEAR(corner(Axis::kX, 30, 20), 1, 1e-14);
  EXPECT_NEAR(corner(Axis::kY, 30, 20), 1.5, 1e-14);
  EXPECT_NEAR(corner(Axis::kSmaller, 30, 20), 1.5, 1e-14);
  EXPECT_NEAR(corner(Axis::kLarger, 30, 20), 1, 1e-14);
  EXPECT_NEAR(corner(Axis::kSmaller, 20, 30), 1, 1e-14);
  EXPECT_NEAR(corner(Axis::kLarger, 20, 30), 2.0 / 3, 1e-14);
  EXPECT_NEAR(corner(Axis::kDiagonal, 40, 30), 0.8, 1e-14);  // half diagonal 1: sides 0.8 and 0.6
}

TEST(Sensor, RaysGivenOneByOneComeBackAsTheyAre) {
  Sensor sensor;
  sensor.kind = Sensor::Kind::kRays;
  sensor.rays = {{Vec3(1, 2, 3), Vec3::UnitX()}, {Vec3(4, 5, 6), Vec3::UnitY()}};
  expect_vector(sensor.ray(1, 0, 2, 1).origin, Vec3(4, 5, 6), 0);
  expect_vector(sensor.ray(1, 0, 2, 1).direction, Vec3::UnitY(), 0);
  EXPECT_DEATH(sensor.ray(2, 0, 2, 1), "index of a ray: found 2, promised 1");
}

TEST(FirstHit, SphereFromOutsideAndInside) {
  const Scene scene = scene_of(Sphere{.center = Vec3(0, 0, 5), .radius = 2, .flip_normals = false});
  const Hit outside = first_hit(scene, {Vec3::Zero(), Vec3::UnitZ()});
  EXPECT_EQ(outside.primitive, 0);
  EXPECT_DOUBLE_EQ(outside.distance, 3);
  expect_vector(outside.position, Vec3(0, 0, 3));
  expect_vector(outside.normal, -Vec3::UnitZ());
  EXPECT_TRUE(outside.front);
  const Hit inside = first_hit(scene, {Vec3(0, 0, 5), Vec3::UnitX()});
  EXPECT_DOUBLE_EQ(inside.distance, 2);
  expect_vector(inside.normal, Vec3::UnitX());
  EXPECT_FALSE(inside.front);
  EXPECT_EQ(first_hit(scene, {Vec3::Zero(), -Vec3::UnitZ()}).primitive, -1);  // it lies behind
  EXPECT_EQ(first_hit(scene, {Vec3(2.001, 0, 0), Vec3::UnitZ()}).primitive, -1);
  EXPECT_EQ(first_hit(scene, {Vec3(1.999, 0, 0), Vec3::UnitZ()}).primitive, 0);
}

TEST(FirstHit, FlippedSphereShowsItsInside) {
  const Scene scene = scene_of(Sphere{.center = Vec3::Zero(), .radius = 1, .flip_normals = true});
  const Hit inside = first_hit(scene, {Vec3::Zero(), Vec3::UnitY()});
  expect_vector(inside.normal, -Vec3::UnitY());
  EXPECT_TRUE(inside.front);
  EXPECT_FALSE(first_hit(scene, {Vec3(0, -3, 0), Vec3::UnitY()}).front);
}

TEST(FirstHit, SmallDistantSphereKeepsItsDigits) {
  // R = 1e-6 at distance 1e4, 5e-7 off the axis: the sphere is met √0.75 R in front of its centre. The textbook's
  // b² − (|o − c|² − R²) has an error of 1e8 · 2⁻⁵³ ≫ R² here.
  const double r = 1e-6;
  const Scene scene = scene_of(Sphere{.center = Vec3(r / 2, 0, 1e4), .radius = r, .flip_normals = false});
  const Hit hit = first_hit(scene, {Vec3::Zero(), Vec3::UnitZ()});
  ASSERT_EQ(hit.primitive, 0);
  EXPECT_NEAR((hit.position - Vec3(r / 2, 0, 1e4)).norm() / r, 1, 3e-6);  // z itself has a grid of 1.8e-12
  expect_vector(hit.normal, Vec3(-0.5, 0, -std::sqrt(0.75)), 3e-6);
  EXPECT_EQ(first_hit(scene, {Vec3(1.501 * r, 0, 0), Vec3::UnitZ()}).primitive, -1);
  EXPECT_EQ(first_hit(scene, {Vec3(1.499 * r, 0, 0), Vec3::UnitZ()}).primitive, 0);
}

TEST(FirstHit, RectangleEdgesAndSides) {
  Flat rectangle;
  rectangle.center = Vec3(1, 0, 4);
  rectangle.half_u = Vec3(3, 0, 0);
  rectangle.half_v = Vec3(0, 0.5, 0);
  rectangle.normal = -Vec3::UnitZ();
  const Scene scene = scene_of(rectangle);
  const auto along_z = [&](double x, double y) { return first_hit(scene, {Vec3(x, y, 0), Vec3::UnitZ()}); };
  EXPECT_EQ(along_z(3.999, 0.499).primitive, 0);
  EXPECT_EQ(along_z(4.001, 0).primitive, -1);
  EXPECT_EQ(along_z(-2.001, 0).primitive, -1);
  EXPECT_EQ(along_z(0, 0.501).primitive, -1);
  const Hit hit = along_z(2, 0.25);
  EXPECT_DOUBLE_EQ(hit.distance, 4);
  expect_vector(hit.position, Vec3(2, 0.25, 4));
  EXPECT_TRUE(hit.front);
  EXPECT_FALSE(first_hit(scene, {Vec3(0, 0, 8), -Vec3::UnitZ()}).front);
  EXPECT_EQ(first_hit(scene, {Vec3(0, 0, 8), Vec3::UnitZ()}).primitive, -1);
  EXPECT_EQ(first_hit(scene, {Vec3(-9, 0, 4), Vec3::UnitX()}).primitive, -1);  // within its plane
  EXPECT_EQ(first_hit(scene, {Vec3(0, 0, 3), Vec3::UnitX()}).primitive, -1);   // parallel to it
}

TEST(FirstHit, DiskAndEllipseHaveRoundRims) {
  Flat ellipse;
  ellipse.outline = Flat::Outline::kDisk;
  ellipse.center = Vec3(1, 0, 4);
  ellipse.half_u = Vec3(3, 0, 0);
  ellipse.half_v = Vec3(0, 0.5, 0);
  const Scene scene = scene_of(ellipse);
  const auto along_z = [&](double x, double y) { return first_hit(scene, {Vec3(x, y, 0), Vec3::UnitZ()}).primitive; };
  for (const double phi : {0.0, 0.5, 1.5, 3.0, 4.4}) {
    EXPECT_EQ(along_z(1 + 2.999 * std::cos(phi), 0.4999 * std::sin(phi)), 0);
    EXPECT_EQ(along_z(1 + 3.001 * std::cos(phi), 0.5001 * std::sin(phi)), -1);
  }
  EXPECT_NEAR(area(scene.primitives[0]), std::numbers::pi * 1.5, 1e-15);
}

/// Directions all over the sphere, the nearest to grazing 1e-4 off the plane of `normal`.
std::vector<Vec3> directions_on(const Vec3& normal) {
  std::vector<Vec3> directions;
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  for (const double z : {1e-4, 1e-2, 0.3, 0.9}) {
    for (int k = 0; k < 16; ++k) {
      const double phi = k * std::numbers::pi / 8, r = std::sqrt(1 - z * z);
      directions.push_back(r * std::cos(phi) * u + r * std::sin(phi) * v + z * normal);
    }
  }
  return directions;
}

TEST(LeaveSurface, RaysDoNotMeetTheSurfaceThatTheyLeave) {
  // A ray's end loses more than 1e-5 to rounding at 1e6 in binary32, and 1e-10 in binary64: no offset fits everywhere.
  const Vec3 normal = Vec3(1, 2, -2) / 3, u = Vec3(2, 1, 2) / 3, v = Vec3(2, -2, -1) / 3;
  for (const double reach : {1e-6, 1.0, 1e6, 1e12}) {
    Flat flat;
    flat.center = reach * Vec3(0.8, -1, 0.9), flat.half_u = reach * u, flat.half_v = 0.3 * reach * v;
    flat.normal = normal;
    const Sphere ball{.center = flat.center, .radius = 1e-3 * reach, .flip_normals = false};
    for (const Scene& scene : {scene_of(flat), scene_of(ball)}) {
      for (int i = 0; i < 200; ++i) {
        const Vec3 aim = flat.center + 1e-4 * reach * Vec3(std::sin(7.0 * i), std::cos(3.0 * i), std::sin(i + 1.0));
        const Vec3 from = aim + reach * (i % 2 ? 1 : -1) * Vec3(0.3, 0.9, -0.5 + 0.001 * i);
        const Hit hit = first_hit(scene, {from, (aim - from).normalized()});
        ASSERT_EQ(hit.primitive, 0);
        const Vec3 side = hit.front ? hit.normal : Vec3(-hit.normal);
        const Vec3 start = leave_surface(scene.primitives[0], hit);
        EXPECT_LE((start - hit.position).norm(), 1e-14 * reach);
        for (const Vec3& direction : directions_on(side)) {
          ASSERT_EQ(first_hit(scene, {start, direction}).primitive, -1) << reach << ' ' << i;
        }
      }
    }
  }
}

TEST(LeaveSurface, TheInsideOfASphereIsStillThere) {
  const Scene scene = scene_of(Sphere{.center = Vec3(1e6, 0, 0), .radius = 2, .flip_normals = true});
  const Hit hit = first_hit(scene, {Vec3(1e6, 0, 0), Vec3::UnitX()});
  ASSERT_TRUE(hit.front);
  const Hit across = first_hit(scene, {leave_surface(scene.primitives[0], hit), -Vec3::UnitX()});
  EXPECT_NEAR(across.distance, 4, 1e-8);
}

TEST(FirstHit, TheNearestWinsWhateverTheOrder) {
  Scene scene = scene_of(Sphere{.center = Vec3(0, 0, 9), .radius = 1, .flip_normals = false});
  scene.primitives.push_back(
      scene_of(Sphere{.center = Vec3(0, 0, 4), .radius = 1, .flip_normals = false}).primitives[0]);
  EXPECT_EQ(first_hit(scene, {Vec3::Zero(), Vec3::UnitZ()}).primitive, 1);
  std::swap(scene.primitives[0], scene.primitives[1]);
  EXPECT_EQ(first_hit(scene, {Vec3::Zero(), Vec3::UnitZ()}).primitive, 0);
}

TEST(IsGrey, AnyColourThatCountsIsSeen) {
  Scene scene = scene_of(Sphere{});
  EXPECT_TRUE(is_grey(scene));
  Primitive& primitive = scene.primitives[0];
  const Rgb colour(0.1, 0.2, 0.3);
  primitive.radiance = colour;
  EXPECT_TRUE(is_grey(scene));  // it does not emit
  primitive.emits = true;
  EXPECT_FALSE(is_grey(scene));
  primitive.emits = false;
  primitive.bsdf.reflectance = colour;
  EXPECT_FALSE(is_grey(scene));
  primitive.bsdf = {};
  primitive.bsdf.kind = BsdfKind::kRoughConductor;
  primitive.bsdf.k = colour;
  EXPECT_TRUE(is_grey(scene));  // F = 1 whatever k
  primitive.bsdf.unit_fresnel = false;
  EXPECT_FALSE(is_grey(scene));
}

}  // namespace
}  // namespace halfslope
