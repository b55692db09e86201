// Paths in scenes whose radiance is known: geometric series in closed rooms, lights in spheres.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/estimators/estimates.h"
#include "tests/estimators/path_scenes.h"

namespace halfslope {
namespace {

/// 64 replicates of an estimate of one number, within what chance of 1e-6 allows; `slack` for rounding.
void expect_all(const Scene& scene, const PathOptions& options, double exact, std::uint64_t paths) {
  const PathTransport source(scene, 1, 1, options);
  for (const std::string& light : light_techniques()) {
    const auto names = path_estimators(light);
    const auto f32 = estimate_together<float>(source, 0, names, {.estimator = "", .rounds = paths});
    const auto f64 = estimate_together<double>(source, 0, names, {.estimator = "", .rounds = paths, .seed = 2});
    for (std::size_t k = 0; k < names.size(); ++k) {
      expect_mean(f32[k][0], exact, 1e-5, names[k] + " f32");
      expect_mean(f64[k][0], exact, 1e-9, names[k] + " f64");
    }
  }
  const auto bsdf = estimate<double>(source, 0, {.estimator = "path-bsdf", .rounds = paths});
  expect_mean(bsdf[0], exact, 1e-9, "path-bsdf");
}

// Σ_k ρ^k L: published with Nori's furnace and pbrt's integrator tests; at Mitsuba's depth d, d terms.
TEST(PathFurnace, ClosedBoxesSumTheirSeries) {
  struct Case {
    double albedo;
    int depth;
    double radiance;
  };
  for (const Case& c :
       {Case{0.5, 1, 1.0}, Case{0.5, 2, 1.5}, Case{0.5, 3, 1.75}, Case{0.5, 5, 1.9375}, Case{0.5, 9, 1.99609375},
        Case{0.8, 2, 1.8}, Case{0.8, 3, 2.44}, Case{0.8, 5, 3.3616}, Case{0.8, 9, 4.32891136}}) {
    SCOPED_TRACE(fmt::format("albedo {}, depth {}", c.albedo, c.depth));
    expect_all(closed_box(c.albedo), {c.depth, 0}, c.radiance, 64);
  }
}

TEST(PathFurnace, RussianRouletteReachesTheWholeSeries) {
  expect_all(closed_box(0.5), {kMostDepth, 2}, 2, 128);
  expect_all(closed_box(0.8), {kMostDepth, 5}, 5, 128);
}

// Two triangles of one plane, with normals so that they are not joined to a rectangle: rays that meet their common edge
// are not shaded by the other triangle.
TEST(PathFurnace, NoEdgeOfAMeshShadesItsOwnPlane) {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {{-3, -1, -1}, {3, -1, 1}, {3, 1, 1}, {-3, 1, -1}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  const float length = std::sqrt(10.f);
  mesh->normals.assign(4, {-1 / length, 0, 3 / length});
  Scene scene;
  Primitive primitive = diffuse(rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()), grey(1));
  primitive.shape = std::shared_ptr<const Mesh>(mesh);
  scene.primitives = {primitive};
  scene.delta_lights.push_back(DirectionalLight{-Vec3::UnitZ(), grey(std::numbers::pi)});
  scene.sensor.kind = Sensor::Kind::kRays;
  for (int k = -9; k <= 9; ++k) scene.sensor.rays.push_back({Vec3(0.3 * k, 0.1 * k, 5), -Vec3::UnitZ()});
  scene.sensor.width = static_cast<int>(scene.sensor.rays.size());
  const DirectLighting direct(scene, scene.sensor.width, 1);
  const PathTransport paths(scene, scene.sensor.width, 1, {2, 0});
  for (int p = 0; p < scene.sensor.width; ++p) {
    EXPECT_NEAR(direct.pixel(p).constant[0], 3 / std::sqrt(10.), 1e-6) << p;
    const auto found = estimate<float>(paths, p, {.estimator = "path-light", .replicates = 16});
    for (const double value : found[0]) EXPECT_NEAR(value, 3 / std::sqrt(10.), 1e-5) << p;
  }
}

// pbrt's integrator test: a point light of intensity π in the middle of a unit sphere of albedo ½ gives ½ after one
// bounce, and Σ ½^k = 1 after all.
TEST(PathFurnace, PointLightInASphere) {
  Scene scene;
  scene.primitives.push_back(diffuse(sphere(Vec3::Zero(), 1, true), grey(0.5)));
  scene.delta_lights.push_back(PointLight{Vec3::Zero(), grey(std::numbers::pi)});
  scene.sensor = one_ray(Vec3(0, 0, 0.5), Vec3(0.3, 1, 0.2));
  for (const int depth : {2, 3, 9}) expect_all(scene, {depth, 0}, 1 - std::exp2(1 - depth), 16);
}

// Radiance is not changed by a perfect mirror, nor by a pane that lets all through, whatever lies between.
TEST(PathFurnace, MirrorsAndMasksChangeNothing) {
  Scene scene = closed_box(0.5);
  Bsdf mirror;
  mirror.kind = BsdfKind::kConductor;
  mirror.reflectance = grey(1);
  scene.primitives.push_back(made_of(sphere(Vec3(0.3, -0.1, 0.6), 0.25), mirror));
  Bsdf mask;
  mask.opacity = 0.3;
  mask.reflectance = grey(0);
  Primitive pane = rectangle(Vec3(-0.4, 0, 0), Vec3(0, 0.5, 0), Vec3(0, 0, 0.5));
  pane.bsdf = mirror;
  pane.back = mirror;
  scene.primitives.push_back(pane);
  const PathTransport source(scene, 1, 1, {kMostDepth, 8});
  for (const auto& name : path_estimators("light")) {
    const auto found = estimate<double>(source, 0, {.estimator = name, .rounds = 128});
    expect_mean(found[0], 2, 1e-9, name);
  }
}

}  // namespace
}  // namespace halfslope
