// White furnaces: under radiance L from everywhere a diffuse surface reflects albedo · L, whatever draws the
// directions.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/estimators/expect_radiance.h"

namespace halfslope {
namespace {

constexpr double kAlbedos[] = {0.1, 0.18, 0.5, 0.8, 0.99, 1};
constexpr double kRadiance = 1.7;

/// A grid of rays from above through the diffuse shape, in a sphere that shines inwards.
Scene furnace(const Primitive& shape, double albedo) {
  std::vector<Ray> rays;
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x) rays.push_back(looking({0.3, 0.1, 3}, {0.3 * (x - 2), 0.3 * (y - 2), 0.05}));
  }
  return scene_of({made_of(shape, diffuse(grey(albedo))), emitting(sphere({0.3, -0.2, 0.1}, 6, true), grey(kRadiance))},
                  rays);
}

struct Shape {
  const char* name;
  Primitive primitive;
};
std::vector<Shape> shapes() {
  return {{"sphere", sphere(Vec3::Zero(), 1)},
          {"plane", rectangle(Vec3::Zero(), 2 * Vec3::UnitX(), 2 * Vec3::UnitY())}};
}

TEST(Furnace, TheClosedFormIsAlbedoTimesRadiance) {
  for (const Shape& shape : shapes()) {
    for (const double albedo : kAlbedos) {
      const DirectLighting source = lighting(furnace(shape.primitive, albedo));
      for (int pixel = 0; pixel < source.pixels(); ++pixel) {
        ASSERT_TRUE(source.pixel(pixel).integral) << "the ray must meet the shape";
        const auto found = source.closed_form(pixel);
        ASSERT_TRUE(found) << shape.name;
        EXPECT_NEAR((*found)[0] / (albedo * kRadiance), 1, 2 * std::numeric_limits<double>::epsilon()) << shape.name;
      }
    }
  }
}

TEST(Furnace, SamplesByTheCosineAreExactEachByItself) {
  for (const Shape& shape : shapes()) {
    for (const double albedo : kAlbedos) {
      const DirectLighting source = lighting(furnace(shape.primitive, albedo));
      const double exact = albedo * kRadiance;
      for (int pixel = 0; pixel < source.pixels(); ++pixel) {
        for (const std::string estimator : {"bsdf", "cosine", "balance@bsdf+cosine", "maximum@bsdf*2+cosine"}) {
          for (std::uint64_t seed = 1; seed <= 4; ++seed) {  // one sample a replicate: nothing averages
            const Request request = {.estimator = estimator, .rounds = 1, .seed = seed};
            const Estimates f64 = estimate<double>(source, pixel, request),
                            f32 = estimate<float>(source, pixel, request);
            for (const double value : f64[0]) {
              ASSERT_NEAR(value / exact, 1, 1e-15) << shape.name << ' ' << estimator;
            }
            for (const double value : f32[0]) {
              ASSERT_NEAR(value / exact, 1, 2e-7) << shape.name << ' ' << estimator;
            }
          }
        }
      }
    }
  }
}

TEST(Furnace, EveryEstimatorAtEveryPixel) {
  // Estimates are linear in the albedo, so each pixel takes its turn with the albedos.
  for (const Shape& shape : shapes()) {
    for (std::size_t a = 0; a < std::size(kAlbedos); ++a) {
      const DirectLighting source = lighting(furnace(shape.primitive, kAlbedos[a]));
      for (int pixel = static_cast<int>(a); pixel < source.pixels(); pixel += static_cast<int>(std::size(kAlbedos))) {
        expect_radiance(source, pixel, grey(kAlbedos[a] * kRadiance),
                        std::string(shape.name) + " pixel " + std::to_string(pixel), 64, 1e-11, 4e-6);
      }
    }
  }
}

TEST(Furnace, DensitiesThatTieEverywhereAreWithoutBias) {
  // About the middle of a dome, `light` has half the density of `hemisphere` in every direction; and on the inside of a
  // sphere that of `cosine`. Which is the larger, or above a cutoff, is then rounding's word at every single sample.
  const Primitive dome = emitting(sphere(Vec3::Zero(), 0.7, true), grey(kRadiance));
  const Scene middle = moved(floor_under({dome}, diffuse(grey(0.5))), some_turn(), 1.3, {0.1, 0.2, 0.3});
  const Scene wall = scene_of({made_of(dome, diffuse(grey(0.5)))}, {{Vec3(0.1, 0.2, 0.3), Vec3(1, 2, 3).normalized()}});
  const auto expect_unbiased = [](const Scene& scene, const std::string& estimator) {
    const Request request = {.estimator = estimator, .sampler = "halton-owen", .rounds = 2048};
    const DirectLighting source = lighting(scene);
    expect_mean(estimate<double>(source, 0, request)[0], 0.5 * kRadiance, 1e-11, estimator);
    expect_mean(estimate<float>(source, 0, request)[0], 0.5 * kRadiance, 4e-6, estimator + " f32");
  };
  for (const std::string estimator : {"maximum@light*2+hemisphere", "cutoff:0.5@light+hemisphere",
                                      "cutoff:1@light*2+hemisphere", "cutoff:0.25@light+hemisphere*2"}) {
    expect_unbiased(middle, estimator);
  }
  for (const std::string estimator :
       {"maximum", "maximum@light+cosine", "maximum@cosine+surface", "cutoff:0.5@light+cosine*2", "cutoff:1"}) {
    expect_unbiased(wall, estimator);
    expect_unbiased(moved(wall, some_turn(), 3, {5, -4, 3}), estimator);
  }
}

/// A box that shines inwards from all of its six walls, and reflects.
Scene box(double albedo, std::vector<Ray> rays) {
  const Vec3 half(1.5, 1, 0.8);
  std::vector<Primitive> walls;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const int i = (axis + 1) % 3, j = (axis + 2) % 3;
      const Vec3 u = half[i] * Vec3::Unit(i), v = -side * half[j] * Vec3::Unit(j);
      walls.push_back(
          emitting(made_of(rectangle(side * half[axis] * Vec3::Unit(axis), u, v), diffuse(grey(albedo))), grey(1)));
    }
  }
  return scene_of(walls, std::move(rays));
}

TEST(Furnace, AClosedBoxThatEmitsHasOneBounce) {
  std::vector<Ray> rays;
  for (int i = 0; i < 40; ++i) {
    rays.push_back({Vec3(0.2, -0.1, 0.1), Vec3(std::sin(3.1 * i), std::cos(1.7 * i), std::sin(0.9 * i)).normalized()});
  }
  for (const auto& [albedo, radiance] : {std::pair(0.5, 1.5), std::pair(0.8, 1.8)}) {
    const DirectLighting source = lighting(moved(box(albedo, rays), some_turn(), 2.5, {3, 2, 1}));
    for (int pixel = 0; pixel < source.pixels(); ++pixel) {
      const auto found = source.closed_form(pixel);
      ASSERT_TRUE(found);
      EXPECT_NEAR((*found)[0], radiance, 1e-13) << pixel;
    }
    for (int pixel = 0; pixel < source.pixels(); pixel += 13) {
      EXPECT_EQ(source.pixel(pixel).constant[0], 1);
      // A ray between two walls that meet may miss both by rounding: 1e-6 of them do in binary32.
      expect_radiance(source, pixel, grey(radiance - 1), "box pixel " + std::to_string(pixel), 512, 1e-11, 1e-5);
    }
  }
}

}  // namespace
}  // namespace halfslope
