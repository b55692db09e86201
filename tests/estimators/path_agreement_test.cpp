// Every way to estimate one integral over paths comes to the same mean.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "scenes/catalogue.h"
#include "tests/estimators/estimates.h"
#include "tests/estimators/path_scenes.h"

namespace halfslope {
namespace {

/// Of a paired t-test that two estimators have one mean; 1 where they are alike to rounding, a share of their size.
double p_value(const std::vector<double>& a, const std::vector<double>& b, double rounding = 1e-9) {
  std::vector<double> difference(a.size());
  double size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference[i] = a[i] - b[i];
    size = std::max({size, std::fabs(a[i]), std::fabs(b[i])});
  }
  const MeanAndError found = mean_of(difference);
  if (std::fabs(found.mean) <= rounding * size) return 1;
  if (found.standard_error == 0) return 0;
  const boost::math::students_t law(static_cast<double>(a.size() - 1));
  return 2 * boost::math::cdf(boost::math::complement(law, std::fabs(found.mean) / found.standard_error));
}

struct Claim {
  std::string what;
  double p;
};

/// Holm's step-down test at a family-wise level of 1e-6.
std::vector<Claim> rejected(std::vector<Claim> claims) {
  std::ranges::sort(claims, {}, &Claim::p);
  std::vector<Claim> out;
  for (std::size_t k = 0; k < claims.size(); ++k) {
    if (claims[k].p > 1e-6 / static_cast<double>(claims.size() - k)) break;
    out.push_back(claims[k]);
  }
  return out;
}

void compare(const std::string& name, const IntegralSource& source, int pixel, std::uint64_t paths,
             std::vector<Claim>& claims) {
  std::vector<Estimates> base;
  for (const std::string& light : light_techniques()) {
    const auto names = path_estimators(light);
    const auto found =
        estimate_together<double>(source, pixel, names, {.estimator = "", .rounds = paths, .replicates = 128});
    if (base.empty()) base = {found[2]};  // path-balance@light+bsdf
    for (std::size_t k = 0; k < names.size(); ++k) {
      for (std::size_t c = 0; c < found[k].size(); ++c) {
        claims.push_back(
            {fmt::format("{} pixel {} {} channel {}", name, pixel, names[k], c), p_value(found[k][c], base[0][c])});
      }
    }
  }
}

TEST(PathAgreement, OfEveryEstimatorOnShippedScenes) {
  std::vector<Claim> claims;
  for (const SceneEntry& entry : rendered_scenes()) {
    Scene scene = load_catalogue_scene(entry.name);
    const bool rays = scene.sensor.kind == Sensor::Kind::kRays;
    const int width = rays ? scene.sensor.width : 12, height = rays ? 1 : 9;
    const PathTransport source(std::move(scene), width, height, {4, 3});
    for (const int pixel : {31, 57, 80}) {
      // Small lights in the smoothest plate are found by so few samples on lights that no mean of theirs is normal.
      if (entry.name.starts_with("veach-mis") && pixel == 57) continue;
      if (pixel < source.pixels()) compare(entry.name, source, pixel, 128, claims);
    }
  }
  for (const Claim& claim : rejected(claims)) ADD_FAILURE() << claim.what << ": p = " << claim.p;
}

// At depth 2 paths carry what the eye sees and what is scattered once: direct lighting, which has kernels of its own.
TEST(PathAgreement, WithDirectLightingAtDepthTwo) {
  std::vector<Claim> claims;
  for (const char* name : {"veach-mis", "diffuse-sphere", "glossy-reflection", "cornell-box"}) {
    Scene scene = load_catalogue_scene(name);
    const DirectLighting direct(scene, 12, 9);
    for (const int pixel : {31, 57, 80}) {
      Scene alone = scene;
      alone.sensor = one_ray(Vec3::Zero(), Vec3::UnitZ());
      alone.sensor.rays = {scene.sensor.ray(pixel % 12, pixel / 12, 12, 9)};
      const PathTransport paths(alone, 1, 1, {2, 0});
      const PixelIntegral at = direct.pixel(pixel);
      auto expected =
          estimate<double>(direct, pixel, {.estimator = "power", .rounds = 512, .replicates = 64, .seed = 3});
      const auto found = estimate<double>(paths, 0, {.estimator = "path-power", .rounds = 512, .replicates = 64});
      for (std::size_t c = 0; c < found.size(); ++c) {
        for (double& v : expected[c]) v += at.constant[c];
        claims.push_back({fmt::format("{} pixel {} channel {}", name, pixel, c), p_value(found[c], expected[c])});
      }
    }
  }
  for (const Claim& claim : rejected(claims)) ADD_FAILURE() << claim.what << ": p = " << claim.p;
}

// The same room by our own shapes and by Embree, which more than a handful of pieces asks for: far below the floor lie
// enough of them that nobody sees.
TEST(PathAgreement, OfEmbreeWithOurOwnShapes) {
  std::vector<Claim> claims;
  const Scene own = load_catalogue_scene("cornell-box");
  Scene many = own;
  for (int i = 0; i < 80; ++i) {
    many.primitives.push_back(diffuse(sphere(Vec3(10.0 * i, -500, 300), 2), grey(0.5)));
    many.primitives.back().id = "far" + std::to_string(i);
  }
  const PathTransport by_own(own, 12, 9, {5, 0}), by_embree(many, 12, 9, {5, 0});
  ASSERT_NE(by_own.skips()[0], by_embree.skips()[0]);
  for (const int pixel : {31, 57, 68, 80}) {
    for (const char* estimator : {"path-light", "path-balance", "path-balance@light-solid-angle+bsdf"}) {
      const auto a = estimate<float>(by_own, pixel, {.estimator = estimator, .rounds = 512});
      const auto b = estimate<float>(by_embree, pixel, {.estimator = estimator, .rounds = 512});
      for (std::size_t c = 0; c < a.size(); ++c) {
        claims.push_back({fmt::format("{} pixel {} channel {}", estimator, pixel, c), p_value(a[c], b[c], 1e-5)});
      }
    }
  }
  for (const Claim& claim : rejected(claims)) ADD_FAILURE() << claim.what << ": p = " << claim.p;
}

}  // namespace
}  // namespace halfslope
