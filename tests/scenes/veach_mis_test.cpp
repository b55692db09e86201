// The shipped scene against the figures that define it, and light reflected in it against independent integration.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "scenes/catalogue.h"
#include "scenes/ggx.h"
#include "scenes/shipped_files.h"
#include "scenes/solid_angle.h"

namespace halfslope {
namespace {

const Primitive& find(const Scene& scene, const std::string& id) {
  const auto found = std::find_if(scene.primitives.begin(), scene.primitives.end(),
                                  [&](const Primitive& primitive) { return primitive.id == id; });
  if (found == scene.primitives.end()) throw std::runtime_error("no " + id);
  return *found;
}

void expect_vector(const Vec3& found, const Vec3& expected, double tolerance) {
  EXPECT_LE((found - expected).norm(), tolerance) << found.transpose() << " is not " << expected.transpose();
}

TEST(Catalogue, EveryShippedFileHasAnEntryAndLoads) {
  EXPECT_EQ(shipped_files().size(), rendered_scenes().size());
  for (const SceneEntry& entry : rendered_scenes()) {
    ASSERT_TRUE(shipped_scene_text(entry.name).has_value()) << entry.name;
    EXPECT_EQ(load_catalogue_scene(entry.name).name, entry.name);
    EXPECT_FALSE(entry.description.empty() || entry.reference.empty());
  }
}

TEST(Catalogue, UnknownNameOffersTheNearest) {
  EXPECT_FALSE(shipped_scene_text("veach").has_value());
  try {
    load_catalogue_scene("veach-mi");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_STREQ(error.what(),
                 "unknown scene 'veach-mi', allowed: veach-mis, veach-mis-plastic, veach-mis-phong, diffuse-rectangle, "
                 "diffuse-disk, "
                 "diffuse-sphere, furnace, glossy-reflection, cornell-box, glossy-indirect, environment-mesh; did you "
                 "mean 'veach-mis'?");
  }
}

TEST(VeachMis, Camera) {
  const Sensor sensor = load_catalogue_scene("veach-mis").sensor;
  EXPECT_EQ(sensor.width, 768);
  EXPECT_EQ(sensor.height, 512);
  EXPECT_EQ(sensor.fov_degrees, 28);
  EXPECT_EQ(sensor.fov_axis, Sensor::FovAxis::kSmaller);
  expect_vector(sensor.origin, Vec3(0, 2, 15), 0);
  expect_vector(sensor.forward, Vec3(0, -4, -12.5).normalized(), 1e-15);
  // Looking along −z with y up, +x is the image's right.
  expect_vector(sensor.left, Vec3(-1, 0, 0), 1e-15);
  expect_vector(sensor.up, Vec3(0, 12.5, -4).normalized(), 1e-15);
  EXPECT_LT(sensor.ray(0, 0, 768, 512).direction.x(), 0);
  EXPECT_GT(sensor.ray(767, 0, 768, 512).direction.x(), 0);
  EXPECT_GT(sensor.ray(0, 0, 768, 512).direction.y(), sensor.ray(0, 511, 768, 512).direction.y());
  // The upper left corner, half a pixel in: tan 14° upwards, 3/2 as much to the left.
  const double t = std::tan(14 * std::numbers::pi / 180);
  const Vec3 corner = sensor.forward + t * (1 - 1.0 / 512) * sensor.up + 1.5 * t * (1 - 1.0 / 768) * sensor.left;
  expect_vector(sensor.ray(0, 0, 768, 512).direction, corner.normalized(), 1e-14);
}

TEST(VeachMis, Lights) {
  const Scene scene = load_catalogue_scene("veach-mis");
  struct Light {
    const char* id;
    Vec3 center;
    double radius, radiance;
  };
  const std::array<Light, 5> lights = {{{"lightbig", {10, 10, 4}, 0.5, 800},
                                        {"light1", {-3.75, 0, 0}, 0.03333, 901.803},
                                        {"light2", {-1.25, 0, 0}, 0.1, 100},
                                        {"light3", {1.25, 0, 0}, 0.3, 11.1111},
                                        {"light4", {3.75, 0, 0}, 0.9, 1.23457}}};
  for (const Light& light : lights) {
    const Primitive& primitive = find(scene, light.id);
    const auto& sphere = std::get<Sphere>(primitive.shape);
    expect_vector(sphere.center, light.center, 0);
    EXPECT_EQ(sphere.radius, light.radius);
    EXPECT_FALSE(sphere.flip_normals);
    EXPECT_TRUE(primitive.emits);
    EXPECT_TRUE((primitive.radiance == light.radiance).all());
    EXPECT_TRUE((primitive.bsdf.reflectance == 0).all());
  }
  EXPECT_EQ(std::count_if(scene.primitives.begin(), scene.primitives.end(), [](const auto& p) { return p.emits; }), 5);
  EXPECT_EQ(scene.primitives.size(), 11u);
  EXPECT_TRUE(is_grey(scene));
}

TEST(VeachMis, Plates) {
  const Scene scene = load_catalogue_scene("veach-mis");
  struct Plate {
    double alpha, front_y, front_z, back_y, back_z;
    Vec3 normal;
  };
  const std::array<Plate, 4> plates = {
      {{0.005, -2.70651, 0.25609, -2.08375, -0.526323, {0, 0.7824129529891104, 0.6227599625817802}},
       {0.02, -3.28825, 1.36972, -2.83856, 0.476536, {0, 0.8931845564738021, 0.44969028016702495}},
       {0.05, -3.73096, 2.70046, -3.43378, 1.74564, {0, 0.9548213440074698, 0.2971804183114512}},
       {0.1, -3.99615, 4.0667, -3.82069, 3.08221, {0, 0.9844866666814627, 0.17545940592177636}}}};
  for (std::size_t i = 0; i < plates.size(); ++i) {
    const Primitive& primitive = find(scene, "plate" + std::to_string(i + 1));
    const auto& rectangle = std::get<Flat>(primitive.shape);
    expect_vector(rectangle.center - rectangle.half_u - rectangle.half_v, {-4, plates[i].front_y, plates[i].front_z},
                  1e-15);
    expect_vector(rectangle.center + rectangle.half_u + rectangle.half_v, {4, plates[i].back_y, plates[i].back_z},
                  1e-15);
    expect_vector(rectangle.half_u, {4, 0, 0}, 0);
    expect_vector(rectangle.normal, plates[i].normal, 1e-15);
    EXPECT_EQ(primitive.bsdf.kind, BsdfKind::kRoughConductor);
    EXPECT_EQ(primitive.bsdf.alpha, plates[i].alpha);
    EXPECT_TRUE(primitive.bsdf.unit_fresnel);
    EXPECT_TRUE((primitive.bsdf.reflectance == 1).all());
    EXPECT_FALSE(primitive.emits);
  }
}

TEST(VeachMis, FloorAndWall) {
  const Scene scene = load_catalogue_scene("veach-mis");
  for (const auto& [id, center, normal] :
       {std::tuple{"floor", Vec3(0, -4.14615, 0), Vec3(0, 1, 0)}, std::tuple{"wall", Vec3(0, 0, -2), Vec3(0, 0, 1)}}) {
    const Primitive& primitive = find(scene, id);
    const auto& rectangle = std::get<Flat>(primitive.shape);
    expect_vector(rectangle.center, center, 0);
    expect_vector(rectangle.normal, normal, 0);
    EXPECT_EQ(rectangle.half_u.norm(), 10);
    EXPECT_EQ(rectangle.half_v.norm(), 10);
    EXPECT_EQ(primitive.bsdf.kind, BsdfKind::kDiffuse);
    EXPECT_TRUE((primitive.bsdf.reflectance == 0.4).all());
  }
}

/// Radiance from one light, reflected to the eye at a point, by the midpoint rule over the light's cone: cosines
/// uniform in solid angle, rings and azimuths.
double reflected_radiance(const Primitive& plate, const Primitive& light, const Vec3& point, const Vec3& eye) {
  const auto& sphere = std::get<Sphere>(light.shape);
  const Vec3 normal = std::get<Flat>(plate.shape).normal;
  const Vec3 to_eye = (eye - point).normalized(), to_light = sphere.center - point;
  const Vec3 axis = to_light.normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
  const Vec3 tangent = Vec3::UnitX(), bitangent = normal.cross(tangent);
  const auto local = [&](const Vec3& d) { return Vec<double>{d.dot(tangent), d.dot(bitangent), d.dot(normal)}; };
  const Vec<double> w_o = local(to_eye);
  const double solid_angle = sphere_cap_solid_angle(sphere.radius, to_light.norm());
  const double sin_max = sphere.radius / to_light.norm();
  const int rings = 1000, azimuths = 1000;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    // 1 − cos θ = s² (1 − cos θ_max): equal steps in s resolve a narrow lobe about the axis.
    const double s = (i + 0.5) / rings;
    const double versine = s * s * sin_max * sin_max / (1 + std::sqrt(1 - sin_max * sin_max));
    const double sine = std::sqrt(versine * (2 - versine));
    for (int j = 0; j < azimuths; ++j) {
      const double phi = 2 * std::numbers::pi * (j + 0.5) / azimuths;
      const Vec<double> w_i = local((1 - versine) * axis + sine * (std::cos(phi) * u + std::sin(phi) * v));
      const Vec<double> h = normalise(w_i + w_o);
      sum += 2 * s * ggx_d(plate.bsdf.alpha, h) * ggx_visibility(plate.bsdf.alpha, w_i.z, w_o.z) * w_i.z;
    }
  }
  return light.radiance[0] * solid_angle * sum / (rings * azimuths);
}

struct Reflection {
  int plate, light;
  Vec3 point;
  double radiance;  ///< independent: Chebyshev-mapped Gauss quadrature
};

TEST(VeachMis, ReflectedRadianceAgreesWithIndependentQuadrature) {
  const Scene scene = load_catalogue_scene("veach-mis");
  const std::array<Reflection, 8> reflections = {
      {{1, 1, {-3.254605606388175, -2.395128859541096, -0.13511793283106321}, 626.5518006318341},
       {1, 3, {1.084868535462725, -2.395128859541096, -0.13511793283106321}, 11.05249525272393},
       {2, 1, {-3.089297929286643, -3.0633820920499355, 0.9230824997343312}, 75.29478388678692},
       {2, 4, {3.089297929286643, -3.0633820920499355, 0.9230824997343312}, 1.2159136321877568},
       {2, 3, {0.6875, -3.0634050000000004, 0.9231280000000001}, 0.6821074738788769},
       {3, 2, {-0.6875, -3.58237, 2.22305}, 1.2982851774073214},
       {4, 1, {-2.0625, -3.90842, 3.574455}, 0.20915190134785056},
       {4, 1, {-2.6562485097563435, -3.908421971498763, 3.574466061899109}, 1.422452156739722}}};
  for (const Reflection& reflection : reflections) {
    const Primitive& plate = find(scene, "plate" + std::to_string(reflection.plate));
    const Primitive& light = find(scene, "light" + std::to_string(reflection.light));
    const Vec3 eye = scene.sensor.origin;
    const Hit hit = first_hit(scene, {eye, (reflection.point - eye).normalized()});
    ASSERT_GE(hit.primitive, 0);
    EXPECT_EQ(scene.primitives[static_cast<std::size_t>(hit.primitive)].id, plate.id);
    EXPECT_TRUE(hit.front);
    expect_vector(hit.position, reflection.point, 1e-5);
    EXPECT_NEAR(reflected_radiance(plate, light, reflection.point, eye) / reflection.radiance, 1, 1e-4)
        << plate.id << ' ' << light.id;
  }
}

}  // namespace
}  // namespace halfslope
