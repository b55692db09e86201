// Light reflected by conductors, against integration over the cone of the light.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/estimators/estimates.h"
#include "tests/estimators/reference_tracer.h"
#include "tests/estimators/scene_builder.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

/// One light over one plate of the classic scene: the radiance that a GGX conductor with F = 1 sends from p to the eye
/// at (0, 2, 15), nothing in between. Computed outside this project by two-dimensional Gauss quadrature.
struct PlatePoint {
  int plate, light;
  std::array<double, 3> p, n;
  double alpha, radiance;
};

constexpr PlatePoint kPlatePoints[] = {
    {2,
     3,
     {2.0625, -3.0634050000000004, 0.9231280000000001},
     {0.0, 0.8931845564738021, 0.44969028016702495},
     0.02,
     0.015032581900649787},
    {4, 0, {-2.0625, -3.90842, 3.574455}, {0.0, 0.9844866666814627, 0.17545940592177636}, 0.1, 0.20915190134785056},
    {1,
     0,
     {-3.254605606388175, -2.395128859541096, -0.13511793283106321},
     {0.0, 0.7824129529891104, 0.6227599625817802},
     0.005,
     626.5518006318341},
    {2,
     3,
     {3.089297929286643, -3.0633820920499355, 0.9230824997343312},
     {0.0, 0.8931845564738021, 0.44969028016702495},
     0.02,
     1.2159136321877568},
    {3,
     0,
     {-2.8793473611055904, -3.5823848389590722, 2.2230976766098074},
     {0.0, 0.9548213440074698, 0.2971804183114512},
     0.05,
     8.331262296922208},
    {2,
     2,
     {0.6875, -3.0634050000000004, 0.9231280000000001},
     {0.0, 0.8931845564738021, 0.44969028016702495},
     0.02,
     0.6821074738788769},
    {1,
     2,
     {1.084868535462725, -2.395128859541096, -0.13511793283106321},
     {0.0, 0.7824129529891104, 0.6227599625817802},
     0.005,
     11.05249525272393},
    {2,
     2,
     {1.029765976428881, -3.0633820920499355, 0.9230824997343312},
     {0.0, 0.8931845564738021, 0.44969028016702495},
     0.02,
     9.76386126620638},
    {4,
     0,
     {-2.6562485097563435, -3.908421971498763, 3.574466061899109},
     {0.0, 0.9844866666814627, 0.17545940592177636},
     0.1,
     1.422452156739722},
    {3, 1, {-0.6875, -3.58237, 2.22305}, {0.0, 0.9548213440074698, 0.2971804183114512}, 0.05, 1.2982851774073214},
    {2,
     0,
     {-3.089297929286643, -3.0633820920499355, 0.9230824997343312},
     {0.0, 0.8931845564738021, 0.44969028016702495},
     0.02,
     75.29478388678692},
    {2,
     1,
     {-1.029765976428881, -3.0633820920499355, 0.9230824997343312},
     {0.0, 0.8931845564738021, 0.44969028016702495},
     0.02,
     45.06197362524111},
    {1, 3, {2.0625, -2.39513, -0.1351165}, {0.0, 0.7824129529891104, 0.6227599625817802}, 0.005, 0.0003843323499901827},
    {4,
     1,
     {-0.8854161699187812, -3.908421971498763, 3.574466061899109},
     {0.0, 0.9844866666814627, 0.17545940592177636},
     0.1,
     1.4266182821777567},
    {4, 1, {-0.6875, -3.90842, 3.574455}, {0.0, 0.9844866666814627, 0.17545940592177636}, 0.1, 1.0214497450265223},
    {1,
     0,
     {-2.0625, -2.39513, -0.1351165},
     {0.0, 0.7824129529891104, 0.6227599625817802},
     0.005,
     0.00011812475527056944},
};

Scene plate_under_light(const PlatePoint& c) {
  struct Light {
    double x, radius, radiance;
  };
  constexpr Light kLights[] = {
      {-3.75, 0.03333, 901.803}, {-1.25, 0.1, 100}, {1.25, 0.3, 11.1111}, {3.75, 0.9, 1.23457}};
  const Light& light = kLights[c.light];
  const Vec3 p(c.p.data()), n = Vec3(c.n.data()).normalized(), u = n.cross(Vec3::UnitX()).normalized();
  return scene_of({made_of(rectangle(p, u, n.cross(u)), conductor(c.alpha)),
                   emitting(sphere({light.x, 0, 0}, light.radius), grey(light.radiance))},
                  {looking({0, 2, 15}, p)});
}

TEST(Conductors, PlatesOfTheClassicScene) {
  // 64 replicates of 2 · 32768 samples; t⁻¹(1 − 5e-7) standard errors must lie within 1e-3 of the radiance, so the mean
  // is sharp as well as right.
  for (const PlatePoint& c : kPlatePoints) {
    const DirectLighting source = lighting(plate_under_light(c));
    const std::string what = "plate " + std::to_string(c.plate) + " light " + std::to_string(c.light);
    Request request = {.estimator = "balance", .sampler = "halton-owen", .rounds = 32768, .seed = 3};
    const auto values = estimate<double>(source, 0, request)[0];
    expect_mean(values, c.radiance, 1e-9, what);
    EXPECT_LT(kStudent64 * mean_of(values).standard_error / c.radiance, 1e-3) << what;
    request.rounds = 4096;
    expect_mean(estimate<float>(source, 0, request)[0], c.radiance, 1e-4, what + " f32");
  }
}

/// Nodes and weights of Gauss and Legendre on [−1, 1].
struct Gauss {
  std::vector<double> x, w;
};
Gauss gauss_legendre(int n) {
  Gauss rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (x * p1 - p0) / (x * x - 1);
      x -= p1 / slope;
    }
    rule.x.push_back(x);
    rule.w.push_back(2 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// ∫ f_r L cos θ dω over the cone of a sphere light that is wholly visible, by textbook formulas.
Rgb integrated(const Scene& scene, const Sphere& light) {
  const Ray& ray = scene.sensor.rays[0];
  ReferenceTracer tracer(scene, first_hit(scene, ray), -ray.direction, 1e-9);
  const Vec3 to_center = light.center - tracer.position(), axis = to_center.normalized();
  const Vec3 u = axis.cross(Vec3(0.3, 0.4, 0.9)).normalized(), v = axis.cross(u);
  const double s = light.radius / to_center.norm(), cap_height = s * s / (1 + std::sqrt(1 - s * s));
  static const Gauss kRule = gauss_legendre(96);
  constexpr int kAzimuths = 128;
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < kRule.x.size(); ++i) {
    // Uniform in cos α; the rim itself, where hits are a matter of rounding, is left out.
    const double cos_alpha = 1 - cap_height * (1 - 1e-9) * (kRule.x[i] + 1) / 2;
    const double sin_alpha = std::sqrt(1 - cos_alpha * cos_alpha);
    for (int j = 0; j < kAzimuths; ++j) {
      const double phi = 2 * kPi * (j + 0.5) / kAzimuths;
      const Vec3 wi = cos_alpha * axis + sin_alpha * (std::cos(phi) * u + std::sin(phi) * v);
      sum += tracer.direction_sample(wi).value * (kRule.w[i] * cap_height * kPi / kAzimuths);
    }
  }
  return sum;
}

TEST(Conductors, FresnelInEveryChannel) {
  const Rgb eta(0.143, 0.375, 1.44), k(3.98, 2.39, 1.6), tint(0.9, 0.6, 1);  // near gold's
  for (const double alpha : {0.1, 0.4, 1.0}) {
    for (const Vec3& eye : {Vec3(0.001, 0.002, 0.01), Vec3(0.02, -0.01, 0.005)}) {
      Bsdf metal = conductor(alpha, eta, k);
      metal.reflectance = tint;
      const Sphere ball = {{-1.5, 0.8, 1.6}, 0.7};
      const Primitive light = emitting(sphere(ball.center, ball.radius), Rgb(1, 2, 3));
      const Primitive floor = made_of(rectangle(Vec3::Zero(), 5 * Vec3::UnitX(), 5 * Vec3::UnitY()), metal);
      const Scene scene = scene_of({floor, light}, {looking(eye, Vec3::Zero())});
      const Rgb exact = integrated(scene, ball);
      const DirectLighting source = lighting(scene);
      for (const std::string estimator : {"light", "bsdf", "balance", "power", "hemisphere", "cosine"}) {
        const Request request = {.estimator = estimator, .sampler = "halton-owen", .rounds = 4096, .seed = 8};
        const auto f64 = estimate<double>(source, 0, request), f32 = estimate<float>(source, 0, request);
        for (int c = 0; c < 3; ++c) {
          const std::string what = estimator + " channel " + std::to_string(c) + " alpha " + std::to_string(alpha);
          expect_mean(f64[static_cast<std::size_t>(c)], exact[c], 1e-6, what);
          expect_mean(f32[static_cast<std::size_t>(c)], exact[c], 1e-5, what + " f32");
        }
      }
    }
  }
}

TEST(Conductors, UnderADomeReflectTheirAlbedo) {
  // α = 1, F = 1: f = 1/(2π (c_i + c_o)), so the albedo is 1 − c ln((1 + c)/c).
  const Primitive dome = emitting(sphere({0.4, 0.2, 0.1}, 20, true), grey(2));
  const Primitive floor = made_of(rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()), conductor(1));
  for (const double c : {0.1, 0.5, 0.95}) {
    const Scene scene = scene_of({floor, dome}, {looking({0, 0.1 * std::sqrt(1 - c * c), 0.1 * c}, Vec3::Zero())});
    const DirectLighting source = lighting(scene);
    for (const std::string estimator : {"light", "bsdf", "balance", "hemisphere", "cosine", "surface"}) {
      const Request request = {.estimator = estimator, .sampler = "halton-owen", .rounds = 4096, .seed = 8};
      const double exact = 2 * (1 - c * std::log((1 + c) / c));
      expect_mean(estimate<double>(source, 0, request)[0], exact, 1e-11, estimator);
      expect_mean(estimate<float>(source, 0, request)[0], exact, 4e-6, estimator + " f32");
    }
  }
}

}  // namespace
}  // namespace halfslope
