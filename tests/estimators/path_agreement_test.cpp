// Every way to estimate one integral over paths comes to the same mean.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "scenes/catalogue.h"
#include "tests/estimators/estimates.h"
#include "tests/estimators/path_scenes.h"
#include "tests/estimators/planted_error.h"

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
    auto names = path_estimators(light);
    if (light == "light") names.push_back("path-bsdf");
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

/// A floor of one material in light from all around, where directions from the BSDF and directions towards the light
/// both serve well.
Scene open_floor(const Bsdf& bsdf) {
  Scene scene;
  scene.primitives = {made_of(rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()), bsdf)};
  Environment sky;
  sky.radiance = grey(1);
  scene.environment = sky;
  scene.sensor = one_ray(Vec3(0, -1, 1), Vec3(0, 1, -1));
  return scene;
}

std::vector<std::pair<std::string, Bsdf>> spread_bsdfs() {
  std::vector<std::pair<std::string, Bsdf>> all = {{"diffuse", diffuse(grey(0.8))},
                                                   {"phong", phong(grey(0.4), grey(0.5), 8)}};
  for (const auto distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
    const char* which = distribution == Distribution::kGgx ? "ggx" : "beckmann";
    for (const auto kind : {BsdfKind::kRoughConductor, BsdfKind::kRoughPlastic, BsdfKind::kRoughDielectric}) {
      Bsdf bsdf = conductor(0.5);
      bsdf.kind = kind;
      bsdf.distribution = distribution;
      bsdf.specular = bsdf.transmittance = Rgb::Ones();
      bsdf.reflectance = grey(kind == BsdfKind::kRoughConductor ? 1 : 0.5);
      bsdf.ior = 1.5;
      all.emplace_back(fmt::format("{} {}", which, static_cast<int>(kind)), bsdf);
    }
  }
  return all;
}

/// Claims that all estimators have the mean of path-light, whose samples know nothing of the BSDF's density, and of
/// path-bsdf.
std::vector<Claim> close_claims(const std::string& name, const IntegralSource& source) {
  const std::vector<std::string> names = {"path-light", "path-bsdf",   "path-average", "path-balance",
                                          "path-power", "path-cutoff", "path-maximum"};
  const auto found = estimate_together<float>(source, 0, names, {.estimator = "", .rounds = 32768, .replicates = 128});
  std::vector<Claim> claims;
  for (std::size_t base : {0u, 1u}) {
    for (std::size_t k = base + 1; k < names.size(); ++k) {
      const double p = p_value(found[k][0], found[base][0], 1e-5);
      claims.push_back({fmt::format("{}: {} and {}", name, names[base], names[k]), p});
    }
  }
  return claims;
}

// And it would be seen if they did not: a density that is 1 % off where a BSDF draws by it fails this very test.
TEST(PathAgreement, OfEveryBsdfToWellBelowOnePercent) {
  std::vector<Claim> claims;
  for (const auto& [name, bsdf] : spread_bsdfs()) {
    const PathTransport right(open_floor(bsdf), 1, 1, {2, 0});
    const auto own = close_claims(name, right);
    claims.insert(claims.end(), own.begin(), own.end());
    const PlantedError wrong(right, WrongPdf::kSampled, 1.01);
    EXPECT_FALSE(rejected(close_claims(name, wrong)).empty()) << name << " drawn by a density 1 % off";
  }
  for (const Claim& claim : rejected(claims)) ADD_FAILURE() << claim.what << ": p = " << claim.p;
}

// Where a density only weighs samples, an error in it takes as much from one technique as it gives to the other, but
// for what lies between f's two halves: less than a quarter of it.
TEST(PathAgreement, FindsAWrongDensityInWeightsAlone) {
  const PathTransport right(open_floor(diffuse(grey(0.8))), 1, 1, {2, 0});
  EXPECT_TRUE(rejected(close_claims("diffuse", PlantedError(right, WrongPdf::kNowhere, 1))).empty());
  EXPECT_FALSE(rejected(close_claims("diffuse", PlantedError(right, WrongPdf::kEvaluated, 1.02))).empty());
}

// What MIS compensation leaves of the sky to the BSDF, path-light takes from there; an average would lose half of it.
TEST(PathAgreement, UnderACompensatedSky) {
  const PathTransport plain(load_catalogue_scene("environment-mesh"), 12, 9, {3, 0});
  const PathTransport compensated(load_catalogue_scene("environment-mesh:mis_compensation=true"), 12, 9, {3, 0});
  const auto base = estimate<float>(plain, 90, {.estimator = "path-balance", .rounds = 8192, .replicates = 128});
  std::vector<Claim> claims;
  for (const char* name : {"path-light", "path-bsdf", "path-balance", "path-power", "path-maximum"}) {
    const auto found =
        estimate<float>(compensated, 90, {.estimator = name, .rounds = 8192, .replicates = 128, .seed = 2});
    for (std::size_t c = 0; c < 3; ++c) claims.push_back({name, p_value(found[c], base[c], 1e-5)});
  }
  for (const Claim& claim : rejected(claims)) ADD_FAILURE() << claim.what << ": p = " << claim.p;
  const auto refused = [](const std::string& name, const IntegralSource& source) -> std::string {
    try {
      EstimatorCatalogue::built_in().parse(name, source);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refused("path-average", compensated), testing::HasSubstr("'path-average' would be biased: light misses"));
  EXPECT_EQ(refused("path-average", plain), "");
  const DirectLighting direct(load_catalogue_scene("environment-mesh:mis_compensation=true"), 12, 9);
  EXPECT_THAT(refused("light-bvh", direct), testing::HasSubstr("balance@light-bvh+bsdf"));
  EXPECT_THAT(refused("balance@light+light-power", direct), testing::HasSubstr("would be biased"));
  EXPECT_EQ(refused("balance@light+cosine", direct), "");
  EXPECT_EQ(refused("bsdf", direct), "");
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
