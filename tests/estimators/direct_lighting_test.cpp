#include "estimators/direct_lighting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "estimators/skip_worth.h"
#include "scenes/catalogue.h"
#include "tests/estimators/scene_builder.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const Vec3 kOrigin = Vec3::Zero();

Primitive floor_tile() {
  return named(made_of(rectangle(kOrigin, Vec3::UnitX(), Vec3::UnitY()), diffuse(grey(0.5))), "floor");
}

TEST(DirectLighting, ASceneMustEmit) {
  Scene dark = scene_of({floor_tile()}, {looking({0, 0, 1}, kOrigin)});
  dark.name = "cellar";
  try {
    lighting(dark);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_STREQ(error.what(),
                 "cellar: nothing in the scene emits; give a shape an <emitter type=\"area\">, or the "
                 "scene an emitter");
  }
}

TEST(DirectLighting, ConstantPixelsAreNotSampled) {
  const Primitive light = named(emitting(sphere({0, 0, 2}, 0.5), Rgb(1, 2, 3)), "lamp");
  const Primitive shiny_light = made_of(emitting(sphere({5, 0, 2}, 0.5), grey(4)), diffuse(grey(0.1)));
  const Primitive sign = emitting(rectangle({-5, 0, 2}, Vec3::UnitX(), Vec3::UnitY()), grey(7));  // its front is up
  const DirectLighting source = lighting(
      scene_of({floor_tile(), light, shiny_light, sign}, {
                                                             looking({0.5, 0.5, 1}, {0.5, 0.5, 0}),   // the floor
                                                             looking({0.5, 0.5, -1}, {0.5, 0.5, 0}),  // its back
                                                             looking({3, 3, 3}, {3, 3, 9}),           // nothing
                                                             looking({0, 0, 9}, {0, 0, 2}),           // the lamp
                                                             looking({5, 0, 9}, {5, 0, 2}),    // the lamp that reflects
                                                             looking({-5, 0, 9}, {-5, 0, 2}),  // the sign
                                                             looking({-5, 0, -9}, {-5, 0, 2}),  // its back
                                                         }));
  ASSERT_EQ(source.channels(), 3);
  const auto constant = [&](int pixel) { return source.pixel(pixel).constant; };
  const auto sampled = [&](int pixel) { return source.pixel(pixel).integral != nullptr; };
  EXPECT_THAT(constant(0), ElementsAre(0, 0, 0));
  EXPECT_TRUE(sampled(0));
  EXPECT_THAT(constant(1), ElementsAre(0, 0, 0));
  EXPECT_FALSE(sampled(1));
  EXPECT_THAT(constant(2), ElementsAre(0, 0, 0));
  EXPECT_FALSE(sampled(2));
  EXPECT_THAT(constant(3), ElementsAre(1, 2, 3));
  EXPECT_FALSE(sampled(3));
  EXPECT_THAT(constant(4), ElementsAre(4, 4, 4));
  EXPECT_TRUE(sampled(4));
  EXPECT_THAT(constant(5), ElementsAre(7, 7, 7));
  EXPECT_FALSE(sampled(5));
  EXPECT_THAT(constant(6), ElementsAre(0, 0, 0));
  EXPECT_FALSE(sampled(6));
}

TEST(DirectLighting, TheLightChoiceTakesADimensionOnlyWhereThereIsAChoice) {
  const Primitive light = emitting(sphere({0, 0, 2}, 0.5), grey(1)), other = emitting(sphere({1, 0, 2}, 0.2), grey(1));
  const std::vector<Ray> rays = {looking({0, 0, 1}, kOrigin)};
  const auto layouts = [&](std::vector<Primitive> primitives) {
    const DirectLighting source = lighting(scene_of(std::move(primitives), rays));
    EXPECT_EQ(source.techniques()[0].name, "light");
    EXPECT_EQ(source.techniques()[1].name, "bsdf");
    EXPECT_THAT(source.techniques()[1].layout.groups, ElementsAre(2));
    return source.techniques()[0].layout.groups;
  };
  EXPECT_THAT(layouts({floor_tile(), light}), ElementsAre(2));
  EXPECT_THAT(layouts({floor_tile(), light, other}), ElementsAre(1, 2));
}

TEST(DirectLighting, TheSurfaceChoiceTakesADimensionWhereThereAreTwoSurfaces) {
  const Primitive light = emitting(sphere({0, 0, 2}, 0.5), grey(1));
  const DirectLighting several = lighting(scene_of({floor_tile(), light}, {looking({0, 0, 1}, kOrigin)}));
  std::vector<std::string> names;
  for (const Technique& technique : several.techniques()) names.push_back(technique.name);
  EXPECT_THAT(names, ElementsAre("light", "bsdf", "hemisphere", "cosine", "surface", "light-power", "light-bvh",
                                 "light-solid-angle", "light-power-solid-angle", "light-bvh-solid-angle"));
  EXPECT_THAT(several.techniques()[2].layout.groups, ElementsAre(2));
  EXPECT_THAT(several.techniques()[3].layout.groups, ElementsAre(2));
  EXPECT_THAT(several.techniques()[4].layout.groups, ElementsAre(1, 2));
  // One surface alone: the inside of a sphere, which lights itself.
  const Primitive shell = made_of(emitting(sphere(kOrigin, 1, true), grey(1)), diffuse(grey(0.5)));
  const DirectLighting one = lighting(scene_of({shell}, {looking(kOrigin, {0, 0, 1})}));
  EXPECT_THAT(one.techniques()[4].layout.groups, ElementsAre(2));
}

TEST(DirectLighting, SkipsSayWhatIsNotDoneAndWhy) {
  const Primitive light = emitting(sphere({0, 0, 2}, 0.5), grey(1));
  const Ray at_floor = looking({0.5, 0.5, 1}, {0.5, 0.5, 0}), at_nothing = looking({3, 3, 3}, {3, 3, 9});
  EXPECT_THAT(
      lighting(scene_of({floor_tile(), light}, {at_floor, at_nothing, at_nothing})).skips(),
      ElementsAre("recognised: diffuse receivers under unoccluded polygon, disk or sphere lights, in closed form",
                  "2 of 3 pixels see only background, what does not reflect or what no light reaches: constant, "
                  "not sampled",
                  "1 of 1 sampled pixels have nothing that could come between them and a light: no shadow rays there" +
                      worth(kWorthNoShadowRay),
                  "one light: no light choice, and no dimension for it" + worth(kWorthNoLightChoice),
                  "grey scene: one channel" + worth(kWorthOneChannel)));
  const Primitive ball = sphere({0.25, 0.25, 1}, 0.2);  // between the point and the light
  const Primitive red = emitting(sphere({0, 0, 4}, 0.1), Rgb(1, 0, 0));
  EXPECT_THAT(lighting(scene_of({floor_tile(), light, red, ball}, {at_floor})).skips(), IsEmpty());
  EXPECT_THAT(lighting(scene_of({floor_tile(), light, red}, {at_floor})).skips(), IsEmpty())
      << "a light may hide another";
}

TEST(DirectLighting, RegionsAreWhatIsSeenAndTheLightMirroredThere) {
  const Primitive left = named(emitting(sphere({-2, 0, 2}, 0.1), grey(1)), "left");
  const Primitive right = named(emitting(sphere({2, 0, 2}, 0.1), grey(1)), "right");
  const DirectLighting source =
      lighting(scene_of({floor_tile(), left, right}, {
                                                         looking({1, 0, 1}, kOrigin),    // mirrors the left one
                                                         looking({-1, 0, 1}, kOrigin),   // the right one
                                                         looking({9, 9, 9}, {99, 9, 9})  // nothing
                                                     }));
  EXPECT_THAT(source.regions(), ElementsAre("background", "floor/left", "floor/right", "left/left", "left/right",
                                            "right/left", "right/right"));
  const auto region = [&](int pixel) { return source.regions()[static_cast<std::size_t>(source.region(pixel))]; };
  EXPECT_EQ(region(0), "floor/left");
  EXPECT_EQ(region(1), "floor/right");
  EXPECT_EQ(region(2), "background");
}

TEST(DirectLighting, ThePlatesOfTheShippedSceneMirrorEveryLight) {
  const Scene scene = load_catalogue_scene("veach-mis");
  const DirectLighting source(scene, 96, 64);
  const auto names = source.regions();
  std::set<std::string> seen;
  for (int pixel = 0; pixel < source.pixels(); ++pixel) {
    const Hit hit = first_hit(scene, scene.sensor.ray(pixel % 96, pixel / 96, 96, 64));
    const std::string region = names.at(static_cast<std::size_t>(source.region(pixel)));
    const std::string shape = hit.primitive < 0 ? region : scene.primitives[static_cast<std::size_t>(hit.primitive)].id;
    EXPECT_EQ(region.substr(0, region.find('/')), shape);
    seen.insert(region);
  }
  for (int plate = 1; plate <= 4; ++plate) {
    for (int light = 1; light <= 4; ++light) {
      EXPECT_EQ(seen.count("plate" + std::to_string(plate) + "/light" + std::to_string(light)), 1u) << plate << light;
    }
  }
  EXPECT_EQ(source.channels(), 1);
}

TEST(DirectLighting, TheFingerprintKnowsAllThatAnIntegralDependsOn) {
  const auto base = [] {
    return scene_of({floor_tile(), emitting(sphere({0, 0, 2}, 0.5), grey(1))}, {looking({0.5, 0.5, 1}, kOrigin)});
  };
  std::vector<Scene> scenes = {base()};
  const auto change = [&](auto&& how) {
    scenes.push_back(base());
    how(scenes.back());
  };
  change([](Scene& s) { std::get<Flat>(s.primitives[0].shape).center.x() += 1e-15; });
  change([](Scene& s) { std::get<Flat>(s.primitives[0].shape).half_u *= 2; });
  change([](Scene& s) { std::get<Flat>(s.primitives[0].shape).half_v *= 2; });
  change([](Scene& s) { std::get<Flat>(s.primitives[0].shape).normal *= -1; });
  change([](Scene& s) { std::get<Sphere>(s.primitives[1].shape).radius = 0.25; });
  change([](Scene& s) { std::get<Sphere>(s.primitives[1].shape).center.y() = 1; });
  change([](Scene& s) { std::get<Sphere>(s.primitives[1].shape).flip_normals = true; });
  change([](Scene& s) { s.primitives[1].radiance[2] = 2; });
  change([](Scene& s) { s.primitives[0] = emitting(s.primitives[0], grey(0)); });
  change([](Scene& s) { s.primitives[0].bsdf.reflectance[1] = 0.25; });
  change([](Scene& s) { s.primitives[0].bsdf = conductor(0.5); });
  change([](Scene& s) { s.primitives[0].bsdf = conductor(0.25); });
  change([](Scene& s) { s.primitives[0].bsdf = conductor(0.5, grey(1), grey(2)); });
  change([](Scene& s) { s.primitives[0].bsdf = conductor(0.5, grey(1), grey(3)); });
  change([](Scene& s) { s.primitives[0].bsdf = conductor(0.5, grey(2), grey(2)); });
  change([](Scene& s) { std::get<Flat>(s.primitives[0].shape).outline = Flat::Outline::kDisk; });
  change([](Scene& s) { s.primitives[0].bsdf = phong(grey(0.5), grey(0.25), 10); });
  change([](Scene& s) { s.primitives[0].bsdf = phong(grey(0.25), grey(0.25), 10); });
  change([](Scene& s) { s.primitives[0].bsdf = phong(grey(0.5), grey(0.5), 10); });
  change([](Scene& s) { s.primitives[0].bsdf = phong(grey(0.5), grey(0.25), 11); });
  change([](Scene& s) { s.sensor.rays[0] = looking({0.5, 0.5, 2}, kOrigin); });
  change([](Scene& s) { s.sensor.rays.push_back(s.sensor.rays[0]); });
  change([](Scene& s) { s.primitives.push_back(sphere({9, 9, 9}, 1)); });
  std::set<std::string> fingerprints;
  for (const Scene& scene : scenes) fingerprints.insert(lighting(scene).fingerprint());
  EXPECT_EQ(fingerprints.size(), scenes.size());
  EXPECT_EQ(lighting(base()).fingerprint(), lighting(base()).fingerprint());

  const auto camera = [](auto&& how) {
    Scene scene = load_catalogue_scene("veach-mis");
    how(scene.sensor);
    return DirectLighting(scene, 96, 64).fingerprint();
  };
  const std::set<std::string> cameras = {camera([](Sensor&) {}),
                                         camera([](Sensor& s) { s.fov_degrees = 29; }),
                                         camera([](Sensor& s) { s.fov_axis = Sensor::FovAxis::kX; }),
                                         camera([](Sensor& s) { s.origin.x() = 0.5; }),
                                         camera([](Sensor& s) { s.left *= -1, s.up *= -1; }),
                                         DirectLighting(load_catalogue_scene("veach-mis"), 48, 32).fingerprint()};
  EXPECT_EQ(cameras.size(), 6u);
}

}  // namespace
}  // namespace halfslope
