// The shipped scenes show what they are for: every ray sees what is meant, and what makes a closed form hold, holds.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/catalogue.h"
#include "scenes/closed_form.h"
#include "scenes/environment_map.h"
#include "scenes/phong.h"
#include "scenes/solid_angle.h"

namespace halfslope {
namespace {

const Primitive& find(const Scene& scene, const std::string& id) {
  for (const Primitive& primitive : scene.primitives) {
    if (primitive.id == id) return primitive;
  }
  throw std::runtime_error("no " + id);
}

/// The share of the image that shows the front of each shape, by id; "" is the background, "back" any back.
std::map<std::string, double> shares(const Scene& scene) {
  std::map<std::string, double> shares;
  const Sensor& sensor = scene.sensor;
  for (int y = 0; y < sensor.height; ++y) {
    for (int x = 0; x < sensor.width; ++x) {
      const Hit hit = first_hit(scene, sensor.ray(x, y, sensor.width, sensor.height));
      std::string seen;
      if (hit.primitive >= 0) seen = hit.front ? scene.primitives[static_cast<std::size_t>(hit.primitive)].id : "back";
      shares[seen] += 1.0 / (sensor.width * sensor.height);
    }
  }
  return shares;
}

/// The lowest point of a shape along y.
double lowest(const Primitive& primitive) {
  if (const auto* sphere = std::get_if<Sphere>(&primitive.shape)) return sphere->center.y() - sphere->radius;
  const auto& flat = std::get<Flat>(primitive.shape);
  const double u = flat.half_u.y(), v = flat.half_v.y();
  return flat.center.y() - (flat.outline == Flat::Outline::kDisk ? std::hypot(u, v) : std::fabs(u) + std::fabs(v));
}

TEST(DiffuseScenes, OneLightOverAFloor) {
  for (const std::string kind : {"rectangle", "disk", "sphere"}) {
    SCOPED_TRACE(kind);
    const Scene scene = load_catalogue_scene("diffuse-" + kind);
    ASSERT_EQ(scene.primitives.size(), 2u);
    const Primitive &floor = find(scene, "floor"), &light = find(scene, "light");
    EXPECT_EQ(floor.bsdf.kind, BsdfKind::kDiffuse);
    EXPECT_FALSE(floor.emits);
    EXPECT_TRUE(light.emits);
    EXPECT_TRUE((light.bsdf.reflectance == 0).all());
    EXPECT_TRUE(is_grey(scene));
    EXPECT_EQ(std::get<Flat>(floor.shape).normal, Vec3::UnitY());
    EXPECT_GT(lowest(light), 0.1);  // above every horizon, and nothing else stands between
    auto seen = shares(scene);
    EXPECT_GT(seen["floor"], 0.5);
    EXPECT_GT(seen["light"], 0.02);
    EXPECT_GT(seen[""], 0.1);
    EXPECT_EQ(seen["back"], 0);
  }
}

TEST(DiffuseScenes, EveryFloorPixelHasAClosedForm) {
  for (const std::string kind : {"rectangle", "disk", "sphere"}) {
    SCOPED_TRACE(kind);
    const Scene scene = load_catalogue_scene("diffuse-" + kind);
    const Primitive& light = find(scene, "light");
    int lit = 0, floor = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 96; ++x) {
        const Hit hit = first_hit(scene, scene.sensor.ray(x, y, 96, 64));
        if (hit.primitive != 0) continue;
        ++floor;
        const auto factor = form_factor(light, hit.position, hit.normal);
        ASSERT_TRUE(factor.has_value());
        if (*factor > 0) ++lit;
      }
    }
    EXPECT_GT(lit, 0.8 * floor);
    if (kind == "sphere") {
      EXPECT_EQ(lit, floor);
    }
  }
}

TEST(DiffuseScenes, TheWholeLightIsInThePicture) {
  for (const std::string kind : {"rectangle", "disk", "sphere"}) {
    const Scene scene = load_catalogue_scene("diffuse-" + kind);
    for (int i = 0; i < 96; ++i) {  // not cut by the picture's edge
      for (const auto& [x, y] :
           {std::pair(i, 0), std::pair(i, 63), std::pair(0, i * 64 / 96), std::pair(95, i * 64 / 96)}) {
        EXPECT_NE(first_hit(scene, scene.sensor.ray(x, y, 96, 64)).primitive, 1) << kind << ' ' << x << ' ' << y;
      }
    }
  }
}

TEST(Furnace, EachRaySeesTheLightAlone) {
  const Scene scene = load_catalogue_scene("furnace");
  ASSERT_EQ(scene.primitives.size(), 3u);
  ASSERT_EQ(scene.sensor.rays.size(), 64u);
  const Primitive &ball = find(scene, "sphere"), &plane = find(scene, "plane"), &wall = find(scene, "wall");
  EXPECT_TRUE((wall.radiance == 1).all());
  EXPECT_TRUE(std::get<Sphere>(wall.shape).flip_normals);
  std::vector<double> cosines;
  for (int i = 0; i < 64; ++i) {
    const Ray ray = scene.sensor.ray(i, 0, 64, 1);
    const Hit hit = first_hit(scene, ray);
    ASSERT_EQ(scene.primitives[static_cast<std::size_t>(hit.primitive)].id, i < 32 ? "sphere" : "plane") << i;
    ASSERT_TRUE(hit.front);
    cosines.push_back(-ray.direction.dot(hit.normal));
    EXPECT_EQ(form_factor(wall, hit.position, hit.normal), 1);
    const auto height = [&](const Vec3& point) { return (point - hit.position).dot(hit.normal); };
    if (i < 32) {
      const auto& flat = std::get<Flat>(plane.shape);
      for (const double a : {-1.0, 1.0}) {
        for (const double b : {-1.0, 1.0}) {
          EXPECT_LT(height(flat.center + a * flat.half_u + b * flat.half_v), -1e-3) << i;
        }
      }
      EXPECT_LT(hit.position.y(), 0);
    } else {
      const auto& sphere = std::get<Sphere>(ball.shape);
      EXPECT_LT(height(sphere.center) + sphere.radius, -0.5);
    }
  }
  EXPECT_GT(*std::max_element(cosines.begin(), cosines.end()), 0.99);
  EXPECT_LT(*std::min_element(cosines.begin(), cosines.end()), 0.25);
  EXPECT_FALSE(is_grey(scene));
}

TEST(GlossyReflection, LightsOfEqualPowerStandBehindTheFloor) {
  const Scene scene = load_catalogue_scene("glossy-reflection");
  ASSERT_EQ(scene.primitives.size(), 5u);
  double previous = 0;
  for (int i = 1; i <= 4; ++i) {
    const Primitive& light = find(scene, "light" + std::to_string(i));
    EXPECT_GT(area(light), 2 * previous);
    previous = area(light);
    EXPECT_NEAR(area(light) * light.radiance[0], 4 * 1.62, 1e-12);
    const auto& flat = std::get<Flat>(light.shape);
    EXPECT_EQ(flat.center.z(), -3);
    EXPECT_EQ(flat.normal, Vec3::UnitZ());
    EXPECT_GT(lowest(light), 0.1);
  }
  auto seen = shares(scene);
  EXPECT_GT(seen["floor"], 0.5);
  EXPECT_GT(seen["light4"], 0.02);
  EXPECT_EQ(seen["back"], 0);
  // The mirror direction from the floor finds every light somewhere: its reflection is in the picture.
  std::map<std::string, int> mirrored;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 96; ++x) {
      const Ray ray = scene.sensor.ray(x, y, 96, 64);
      const Hit hit = first_hit(scene, ray);
      if (hit.primitive != 0) continue;
      const Vec3 mirror = ray.direction - 2 * ray.direction.dot(hit.normal) * hit.normal;
      const Hit next = first_hit(scene, {leave_surface(scene.primitives[0], hit), mirror});
      if (next.primitive > 0) ++mirrored[scene.primitives[static_cast<std::size_t>(next.primitive)].id];
    }
  }
  EXPECT_EQ(mirrored.size(), 4u);
}

TEST(VeachMisPhong, IsVeachMisWithOtherPlates) {
  const Scene ggx = load_catalogue_scene("veach-mis"), phong = load_catalogue_scene("veach-mis-phong");
  ASSERT_EQ(phong.primitives.size(), ggx.primitives.size());
  const std::array<double, 4> exponents = {10000, 2000, 500, 100};
  for (std::size_t i = 0; i < ggx.primitives.size(); ++i) {
    const Primitive &a = ggx.primitives[i], &b = phong.primitives[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.emits, b.emits);
    EXPECT_TRUE((a.radiance == b.radiance).all());
    EXPECT_EQ(area(a), area(b));
    if (a.bsdf.kind != BsdfKind::kRoughConductor) {
      EXPECT_EQ(b.bsdf.kind, a.bsdf.kind);
      continue;
    }
    EXPECT_EQ(b.bsdf.kind, BsdfKind::kPhong);
    EXPECT_EQ(b.bsdf.exponent, exponents.at(i));
    EXPECT_TRUE((b.bsdf.specular == 1).all() && (b.bsdf.reflectance == 0).all());
    EXPECT_EQ(std::get<Flat>(a.shape).center, std::get<Flat>(b.shape).center);
    EXPECT_EQ(std::get<Flat>(a.shape).normal, std::get<Flat>(b.shape).normal);
  }
  for (int x = 0; x < 96; x += 5) {
    EXPECT_EQ(ggx.sensor.ray(x, 40, 96, 64).direction, phong.sensor.ray(x, 40, 96, 64).direction);
  }
}

TEST(VeachMisPlastic, HasThePlatesOfTheClassicFile) {
  const Scene ggx = load_catalogue_scene("veach-mis"), plastic = load_catalogue_scene("veach-mis-plastic");
  ASSERT_EQ(plastic.primitives.size(), ggx.primitives.size());
  for (std::size_t i = 0; i < ggx.primitives.size(); ++i) {
    const Primitive &a = ggx.primitives[i], &b = plastic.primitives[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_TRUE((a.radiance == b.radiance).all());
    EXPECT_EQ(area(a), area(b));
    if (a.bsdf.kind != BsdfKind::kRoughConductor) continue;
    EXPECT_EQ(b.bsdf.kind, BsdfKind::kRoughPlastic);
    EXPECT_EQ(b.bsdf.distribution, Distribution::kBeckmann);
    EXPECT_EQ(b.bsdf.alpha, a.bsdf.alpha);
    EXPECT_NEAR(b.bsdf.ior, 2 / 1.000277, 1e-6);  // over that of air
    EXPECT_TRUE((b.bsdf.reflectance == Rgb(0.07, 0.09, 0.13)).all());
  }
}

TEST(EnvironmentMesh, HasItsMeshAndItsSkyWithTheSunBehindTheCamera) {
  const Scene scene = load_catalogue_scene("environment-mesh");
  EXPECT_EQ(std::get<std::shared_ptr<const Mesh>>(find(scene, "knot").shape)->triangles.size(), 3072u);
  ASSERT_TRUE(scene.environment);
  const Vec3 sun(std::cos(2 * std::numbers::pi / 9) * std::sin(-std::numbers::pi / 3),
                 std::sin(2 * std::numbers::pi / 9),
                 std::cos(2 * std::numbers::pi / 9) * std::cos(-std::numbers::pi / 3));
  const EnvironmentMap<double> map(*scene.environment);
  double at_sun[3], beside[3], zenith[3];
  environment_radiance(map.data(), Vec<double>{sun.x(), sun.y(), sun.z()}, at_sun);
  environment_radiance(map.data(), Vec<double>{-sun.x(), sun.y(), sun.z()}, beside);
  environment_radiance(map.data(), Vec<double>{0, 1, 0}, zenith);
  EXPECT_GT(at_sun[1], 1000);
  EXPECT_LT(beside[1], 5);
  EXPECT_NEAR(zenith[1], 0.8, 0.02);  // luminance 1, tinted
}

/// ∫ L f_r cos θ dω over the light's cone by the midpoint rule: equal steps in s, 1 − cos = s² (1 − cos σ), resolve a
/// lobe that is narrow beside the cone and points to its middle.
double reflected_radiance(const Primitive& plate, const Primitive& light, const Vec3& point, const Vec3& eye) {
  const auto& sphere = std::get<Sphere>(light.shape);
  const Vec3 normal = std::get<Flat>(plate.shape).normal, to_eye = (eye - point).normalized();
  const Vec3 mirror = 2 * normal.dot(to_eye) * normal - to_eye, to_light = sphere.center - point;
  const Vec3 axis = to_light.normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
  const double n = plate.bsdf.exponent, sine = sphere.radius / to_light.norm();
  const double cap = sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
  const int steps = 1000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double s = (i + 0.5) / steps, versine = s * s * cap, ring = std::sqrt(versine * (2 - versine));
    for (int j = 0; j < steps; ++j) {
      const double phi = 2 * std::numbers::pi * (j + 0.5) / steps;
      const Vec3 w = (1 - versine) * axis + ring * (std::cos(phi) * u + std::sin(phi) * v);
      sum += 2 * s * phong_cos_power(n, 0.5 * (w - mirror).squaredNorm()) * normal.dot(w);  // 1 − cos α = |w − r|²/2
    }
  }
  return light.radiance[0] * plate.bsdf.specular[0] * (n + 2) / (2 * std::numbers::pi) *
         sphere_cap_solid_angle(sphere.radius, to_light.norm()) * sum / (steps * steps);
}

TEST(VeachMisPhong, ReflectedRadianceAgreesWithIndependentQuadrature) {
  struct Reflection {
    int plate, light;
    Vec3 point;
    double radiance;
  };
  const std::array<Reflection, 8> reflections = {
      {{1, 1, {-3.254605606388175, -2.395128859541096, -0.13511793283106321}, 435.3058855534553},
       {1, 3, {1.084868535462725, -2.395128859541096, -0.13511793283106321}, 9.047994536959758},
       {2, 1, {-3.089297929286643, -3.0633820920499355, 0.9230824997343312}, 63.397526177238596},
       {2, 4, {3.089297929286643, -3.0633820920499355, 0.9230824997343312}, 0.8771246296660139},
       {2, 3, {0.6875, -3.0634050000000004, 0.9231280000000001}, 0.3605125973252894},
       {3, 2, {-0.6875, -3.58237, 2.22305}, 1.6582489705307921},
       {4, 1, {-2.0625, -3.90842, 3.574455}, 0.3123245780079836},
       {4, 1, {-2.6562485097563435, -3.908421971498763, 3.574466061899109}, 1.0392393921343361}}};
  const Scene scene = load_catalogue_scene("veach-mis-phong");
  for (const Reflection& reflection : reflections) {
    const Primitive& plate = find(scene, "plate" + std::to_string(reflection.plate));
    const Primitive& light = find(scene, "light" + std::to_string(reflection.light));
    EXPECT_NEAR(reflected_radiance(plate, light, reflection.point, scene.sensor.origin) / reflection.radiance, 1, 1e-4)
        << plate.id << ' ' << light.id;
  }
}

}  // namespace
}  // namespace halfslope
