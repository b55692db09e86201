// Where rays meet each shape in double precision: closed forms, coordinates on surfaces, edges, and both ways of
// finding the first.
#include "scenes/intersector.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "scenes/mesh_reader.h"
#include "scenes/shape_hits.h"

namespace halfslope {
namespace {

template <class Shape>
Scene scene_of(Shape shape) {
  Scene scene;
  Primitive primitive;
  primitive.shape = std::move(shape);
  scene.primitives.push_back(std::move(primitive));
  return scene;
}

template <class Shape>
SurfaceHit hit_of(Shape shape, const Vec3& origin, const Vec3& direction) {
  const Scene scene = scene_of(std::move(shape));
  return Intersector(scene).first({origin, direction.normalized()});
}

void expect_near(const Vec3& found, const Vec3& expected, double tolerance = 1e-15) {
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance)
      << found.transpose() << " not " << expected.transpose();
}
void expect_near(const Eigen::Vector2d& found, double u, double v, double tolerance = 1e-15) {
  EXPECT_NEAR(found.x(), u, tolerance);
  EXPECT_NEAR(found.y(), v, tolerance);
}

TEST(SphereHit, NearAndFarSideWithItsCoordinates) {
  const SurfaceHit near = hit_of(Sphere{{1, 2, 3}, 2}, {1, -5, 3}, {0, 1, 0});
  EXPECT_EQ(near.primitive, 0);
  EXPECT_DOUBLE_EQ(near.distance, 5);
  expect_near(near.position, {1, 0, 3});
  expect_near(near.normal, {0, -1, 0});
  EXPECT_TRUE(near.front);
  expect_near(near.uv, 0.75, 0.5);  // φ = 3π/2, θ = π/2
  const SurfaceHit far = hit_of(Sphere{{1, 2, 3}, 2, true}, {1, 2, 3}, {0, 0, 1});
  EXPECT_DOUBLE_EQ(far.distance, 2);
  expect_near(far.normal, {0, 0, -1});
  EXPECT_TRUE(far.front);
  EXPECT_DOUBLE_EQ(far.uv.y(), 0);
  EXPECT_EQ(hit_of(Sphere{{0, 0, 0}, 1}, {0, 0, 2}, {0, 0, 1}).primitive, -1);
}

TEST(SphereHit, CoordinatesTurnWithTheSphere) {
  Sphere sphere{{0, 0, 0}, 1};
  // The pole is at +x in the world, and φ = 0 at −z.
  sphere.from_world = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitY()).toRotationMatrix();
  expect_near(hit_of(sphere, {5, 0, 0}, {-1, 0, 0}).position, {1, 0, 0});
  EXPECT_NEAR(hit_of(sphere, {5, 0, 0}, {-1, 0, 0}).uv.y(), 0, 1e-15);
  const Eigen::Vector2d uv = hit_of(sphere, {0, 5, -1e-9}, {0, -1, 0}).uv;
  expect_near(uv, 0.25, 0.5, 1e-9);
}

TEST(SphereHit, PolesKeepTheirDigits) {
  // θ = 1e-7 from the pole, where acos would have an absolute error near 1e-9.
  const double x = 1e-7;
  EXPECT_NEAR(hit_of(Sphere{}, {x, 0, 3}, {0, 0, -1}).uv.y(), x / std::numbers::pi, 1e-22);
}

TEST(FlatHit, RectangleAndDiskWithTheirCoordinates) {
  const Flat rectangle{{0, 0, 1}, {2, 0, 0}, {0, 3, 0}, {0, 0, 1}};
  const SurfaceHit hit = hit_of(rectangle, {1, -1.5, 5}, {0, 0, -1});
  EXPECT_DOUBLE_EQ(hit.distance, 4);
  expect_near(hit.uv, 0.75, 0.25);
  EXPECT_TRUE(hit.front);
  EXPECT_EQ(hit_of(rectangle, {2.0001, 0, 5}, {0, 0, -1}).primitive, -1);
  Flat disk = rectangle;
  disk.outline = Flat::Outline::kDisk;
  const SurfaceHit below = hit_of(disk, {0, -1.5, -5}, {0, 0, 1});
  expect_near(below.uv, 0.5, 0.75);
  EXPECT_FALSE(below.front);
  expect_near(below.normal, {0, 0, 1});
  EXPECT_EQ(hit_of(disk, {1.9, 2.9, 5}, {0, 0, -1}).primitive, -1);
}

TEST(CylinderHit, SideInsideAndBeyondTheEnds) {
  const Cylinder cylinder{{1, 1, 0}, {1, 1, 4}, 2};
  const SurfaceHit outside = hit_of(cylinder, {-9, 1, 1}, {1, 0, 0});
  EXPECT_DOUBLE_EQ(outside.distance, 8);
  expect_near(outside.position, {-1, 1, 1});
  expect_near(outside.normal, {-1, 0, 0});
  EXPECT_TRUE(outside.front);
  expect_near(outside.uv, 0.5, 0.25);
  const SurfaceHit inside = hit_of(cylinder, {1, 1, 2}, {0, 1, 1});
  EXPECT_DOUBLE_EQ(inside.distance, 2 * std::numbers::sqrt2);
  expect_near(inside.position, {1, 3, 4});
  EXPECT_FALSE(inside.front);
  expect_near(inside.uv, 0.25, 1);
  // In through the open top, onto the far side; and along the axis, past everything.
  const SurfaceHit through = hit_of(cylinder, {-3, 1, 6}, {2, 0, -1});
  expect_near(through.position, {3, 1, 3}, 1e-14);
  EXPECT_EQ(hit_of(cylinder, {2, 1, -3}, {0, 0, 1}).primitive, -1);
  EXPECT_EQ(hit_of(cylinder, {-9, 1, 4.5}, {1, 0, 0}).primitive, -1);
}

TEST(CylinderHit, AngleBeginsAtStartByTheRightHand) {
  Cylinder cylinder{{0, 0, 0}, {2, 0, 0}, 1};
  cylinder.start = {5, 0, 1};  // not perpendicular: what counts is +z
  cylinder.flip_normals = true;
  const SurfaceHit start = hit_of(cylinder, {1, 0, 9}, {0, 0, -1});
  expect_near(start.normal, {0, 0, -1});
  EXPECT_FALSE(start.front);
  EXPECT_NEAR(start.uv.x(), 0, 1e-15);
  EXPECT_DOUBLE_EQ(hit_of(cylinder, {1, -9, 0}, {0, 1, 0}).uv.x(), 0.25);  // x × z = −y
}

TEST(CylinderHit, FarAndThinOnesKeepTheirDigits) {
  // From 10⁶ away to a radius of 10⁻³: the quadratic's textbook form has no digit left.
  for (const double off : {0.0, 6e-4, 9.99e-4}) {
    const double exact = 1e6 - std::sqrt((1e-3 - off) * (1e-3 + off));
    const SurfaceHit hit = hit_of(Cylinder{{0, 0, -1}, {0, 0, 1}, 1e-3}, {-1e6, off, 0}, {1, 0, 0});
    ASSERT_EQ(hit.primitive, 0);
    EXPECT_NEAR(hit.distance, exact, 4e-10);  // two roundings of 10⁶
    EXPECT_NEAR(std::hypot(hit.position.x(), hit.position.y()), 1e-3, 1e-18);
    EXPECT_NEAR(hit.normal.y(), off / 1e-3, 1e-6);
  }
  EXPECT_EQ(hit_of(Cylinder{{0, 0, -1}, {0, 0, 1}, 1e-3}, {-1e6, 1.001e-3, 0}, {1, 0, 0}).primitive, -1);
}

TEST(FirstTangent, IsPerpendicularUnitLengthAndMitsubasForTheDefaultCylinder) {
  expect_near(first_tangent(Vec3::UnitZ()), Vec3::UnitX());
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = Vec3(normal(random), normal(random), normal(random)).normalized();
    EXPECT_NEAR(first_tangent(n).norm(), 1, 1e-15);
    EXPECT_NEAR(first_tangent(n).dot(n), 0, 1e-15);
  }
}

TEST(TriangleHit, WeightsAreThoseOfTheCorners) {
  const Vec3 p0(1, 2, 3), p1(4, 2, 5), p2(2, 6, 4);
  const Vec3 inside = 0.5 * p0 + 0.2 * p1 + 0.3 * p2;
  const Vec3 origin(-3, -1, 20);
  const TrianglePoint point = hit_triangle(p0, p1, p2, {origin, (inside - origin).normalized()});
  EXPECT_NEAR(point.distance, (inside - origin).norm(), 1e-14);
  EXPECT_NEAR(point.u, 0.2, 1e-14);
  EXPECT_NEAR(point.v, 0.3, 1e-14);
  EXPECT_EQ(hit_triangle(p0, p1, p2, {origin, (origin - inside).normalized()}).distance, kNoHit);
  EXPECT_EQ(hit_triangle(p0, p1, p2, {origin, (p0 - 0.01 * (p1 - p0) - origin).normalized()}).distance, kNoHit);
}

TEST(TriangleHit, SmallAndFarOnesKeepTheirDigits) {
  // Edges of 10⁻⁴ at a distance of 10³: products of the corners' positions would lose 14 digits.
  const Vec3 p0(0, 0, 1000), p1(1e-4, 0, 1000), p2(0, 1e-4, 1000);
  const Vec3 inside = 0.5 * p0 + 0.2 * p1 + 0.3 * p2;
  const TrianglePoint point = hit_triangle(p0, p1, p2, {Vec3::Zero(), inside.normalized()});
  EXPECT_NEAR(point.u, 0.2, 1e-8);
  EXPECT_NEAR(point.v, 0.3, 1e-8);
}

TEST(TriangleHit, NoRayPassesBetweenTwoThatShareAnEdge) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vec = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  int on_both = 0;
  for (int i = 0; i < 100000; ++i) {
    // The shared edge and a corner on either side of it as seen from the origin.
    const Vec3 origin = vec() - Vec3(0, 0, 9), a = vec(), b = vec();
    const Vec3 across = (b - a).cross(a - origin).normalized();
    const Vec3 c = a + 0.3 * (b - a) + 2 * across, d = a + 0.6 * (b - a) - 2 * across;
    const Vec3 target = a + 0.5 * (1 + uniform(random)) * (b - a);
    const Ray ray{origin, (target - origin).normalized()};
    const bool one = hit_triangle(a, b, c, ray).distance < kNoHit, other = hit_triangle(b, a, d, ray).distance < kNoHit;
    ASSERT_TRUE(one || other) << i;
    on_both += one && other;
  }
  EXPECT_LT(on_both, 100000);
}

TEST(MeshHit, NormalsAndCoordinatesAreInterpolated) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const SurfaceHit plain = hit_of(std::make_shared<const Mesh>(mesh), {0.25, 0.5, 1}, {0, 0, -1});
  EXPECT_EQ(plain.triangle, 0);
  expect_near(plain.position, {0.25, 0.5, 0});
  expect_near(plain.normal, {0, 0, 1});
  expect_near(plain.shading_normal, {0, 0, 1});
  expect_near(plain.uv, 0.25, 0.5);
  EXPECT_TRUE(plain.front);
  mesh.normals = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  mesh.uvs = {{1, 1}, {3, 1}, {1, 5}};
  const SurfaceHit smooth = hit_of(std::make_shared<const Mesh>(mesh), {0.25, 0.5, -1}, {0, 0, 1});
  expect_near(smooth.normal, {0, 0, 1});
  expect_near(smooth.shading_normal, Vec3(0.25, 0.5, 0.25).normalized());
  expect_near(smooth.uv, 1.5, 3);
  EXPECT_FALSE(smooth.front);
  // Normals that cancel leave the geometric one.
  mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
  expect_near(hit_of(std::make_shared<const Mesh>(mesh), {0.5, 0, 1}, {0, 0, -1}).shading_normal, {0, 0, 1});
}

TEST(Intersector, SaysHowItTracesAndWhy) {
  Scene scene = scene_of(std::make_shared<const Mesh>(make_cube()));
  EXPECT_EQ(count_pieces(scene), 12U);
  EXPECT_FALSE(Intersector(scene).uses_embree());
  EXPECT_EQ(why_traced(12), "12 pieces, at most " + std::to_string(kHandful) + ": each is tried");
  while (count_pieces(scene) <= kHandful) scene.primitives.push_back(scene.primitives[0]);
  EXPECT_TRUE(Intersector(scene).uses_embree());
  EXPECT_EQ(Intersector(scene).why(), std::to_string(scene.primitives.size() * 12) + " pieces, more than " +
                                          std::to_string(kHandful) + ": Embree's hierarchy");
}

/// Shapes in a 5³ lattice, one kind after the other.
Scene lattice() {
  Scene scene;
  for (int i = 0; i < 125; ++i) {
    const Vec3 at(i % 5, i / 5 % 5, i / 25);
    Primitive primitive;
    if (i % 4 == 0) primitive.shape = Sphere{at, 0.4};
    if (i % 4 == 1) primitive.shape = Flat{at, {0.4, 0, 0}, {0, 0.3, 0.3}, Vec3(0, -1, 1).normalized()};
    if (i % 4 == 2) primitive.shape = Cylinder{at - Vec3(0.3, 0.1, 0), at + Vec3(0.3, 0.1, 0), 0.25};
    if (i % 4 == 3) {
      Eigen::Affine3d place = Eigen::Translation3d(at) * Eigen::AngleAxisd(i, Vec3(2, 1, 2) / 3) * Eigen::Scaling(0.2);
      primitive.shape = std::make_shared<const Mesh>(transformed(make_cube(), place.matrix(), false, false));
    }
    scene.primitives.push_back(std::move(primitive));
  }
  return scene;
}

TEST(Intersector, EmbreeFindsWhatTryingEachFinds) {
  const Scene scene = lattice();
  const Intersector embree(scene);
  ASSERT_TRUE(embree.uses_embree());
  // The same shapes by the handful, each with its own intersector: the nearest of all.
  std::vector<Scene> parts(5);
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) parts[i / 25].primitives.push_back(scene.primitives[i]);
  std::vector<std::unique_ptr<Intersector>> own;
  std::vector<Scene> singles;
  for (const Primitive& primitive : scene.primitives) singles.emplace_back().primitives.push_back(primitive);
  for (const Scene& single : singles) own.push_back(std::make_unique<Intersector>(single));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 5);
  int hits = 0, differ = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 origin(uniform(random), uniform(random), -8), target(uniform(random), uniform(random), uniform(random));
    const Ray ray{origin, (target - origin).normalized()};
    SurfaceHit nearest;
    nearest.distance = kNoHit;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const SurfaceHit hit = own[k]->first(ray);
      if (hit.primitive < 0 || hit.distance >= nearest.distance) continue;
      nearest = hit;
      nearest.primitive = static_cast<int>(k);
    }
    const SurfaceHit found = embree.first(ray);
    if (found.primitive != nearest.primitive || found.triangle != nearest.triangle) {
      ++differ;  // a ray that binary32 takes past an edge
      continue;
    }
    if (found.primitive < 0) continue;
    ++hits;
    EXPECT_EQ(found.distance, nearest.distance);
    EXPECT_EQ(found.position, nearest.position);
    EXPECT_EQ(found.shading_normal, nearest.shading_normal);
    EXPECT_EQ(found.uv, nearest.uv);
  }
  EXPECT_GT(hits, 2000);
  EXPECT_LE(differ, 2);
}

}  // namespace
}  // namespace halfslope
