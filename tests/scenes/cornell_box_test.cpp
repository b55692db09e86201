// The Cornell box against the corners that were measured and published.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "scenes/catalogue.h"
#include "scenes/intersector.h"

namespace halfslope {
namespace {

const Flat& side(const Scene& scene, const std::string& id) {
  for (const Primitive& primitive : scene.primitives) {
    if (primitive.id == id) return std::get<Flat>(primitive.shape);
  }
  throw std::runtime_error("no " + id);
}

struct Side {
  const char* id;
  std::array<Vec3, 4> corners;
};

const std::array<Side, 8> kSides = {{
    {"floor", {Vec3(552.8, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 559.2), Vec3(549.6, 0, 559.2)}},
    {"lamp", {Vec3(343, 548.8, 227), Vec3(343, 548.8, 332), Vec3(213, 548.8, 332), Vec3(213, 548.8, 227)}},
    {"ceiling", {Vec3(556, 548.8, 0), Vec3(556, 548.8, 559.2), Vec3(0, 548.8, 559.2), Vec3(0, 548.8, 0)}},
    {"back", {Vec3(549.6, 0, 559.2), Vec3(0, 0, 559.2), Vec3(0, 548.8, 559.2), Vec3(556, 548.8, 559.2)}},
    {"right", {Vec3(0, 0, 559.2), Vec3(0, 0, 0), Vec3(0, 548.8, 0), Vec3(0, 548.8, 559.2)}},
    {"left", {Vec3(552.8, 0, 0), Vec3(549.6, 0, 559.2), Vec3(556, 548.8, 559.2), Vec3(556, 548.8, 0)}},
    {"short-top", {Vec3(130, 165, 65), Vec3(82, 165, 225), Vec3(240, 165, 272), Vec3(290, 165, 114)}},
    {"tall-top", {Vec3(423, 330, 247), Vec3(265, 330, 296), Vec3(314, 330, 456), Vec3(472, 330, 406)}},
}};

TEST(CornellBox, EveryCornerIsWhereItWasMeasured) {
  const Scene scene = load_catalogue_scene("cornell-box");
  for (const Side& measured : kSides) {
    const Flat& flat = side(scene, measured.id);
    for (const Vec3& corner : measured.corners) {
      double nearest = INFINITY;
      for (const double a : {-1.0, 1.0}) {
        for (const double b : {-1.0, 1.0}) {
          nearest = std::min(nearest, (flat.center + a * flat.half_u + b * flat.half_v - corner).norm());
        }
      }
      EXPECT_LE(nearest, 3.3) << measured.id << " at " << corner.transpose();
    }
  }
}

TEST(CornellBox, TheBlocksAreClosedAndFaceOutwards) {
  const Scene scene = load_catalogue_scene("cornell-box");
  for (const auto& [block, height] : {std::pair("short", 165.0), std::pair("tall", 330.0)}) {
    const Flat& top = side(scene, block + std::string("-top"));
    for (int i = 1; i <= 4; ++i) {
      const Flat& wall = side(scene, block + std::string("-") + std::to_string(i));
      EXPECT_GT(wall.normal.dot(wall.center - top.center), 0);
      EXPECT_NEAR(wall.half_v.norm(), height / 2, 1e-9);
      EXPECT_NEAR(wall.center.y(), height / 2, 1e-9);
      // It ends at an edge of the top.
      const Vec3 out = wall.center + wall.half_v - top.center;
      const double u = out.dot(top.half_u) / top.half_u.squaredNorm(),
                   v = out.dot(top.half_v) / top.half_v.squaredNorm();
      EXPECT_NEAR(std::max(std::abs(u), std::abs(v)), 1, 1e-5);
      EXPECT_NEAR(std::min(std::abs(u), std::abs(v)), 0, 1e-5);
    }
  }
}

TEST(CornellBox, TheCameraSeesRedOnTheLeftAndTheBackBetweenTheBlocks) {
  const Scene scene = load_catalogue_scene("cornell-box");
  const Intersector intersector(scene);
  const auto seen = [&](int x, int y) {
    const SurfaceHit hit = intersector.first(scene.sensor.ray(x, y, 256, 256));
    EXPECT_TRUE(hit.front);
    return hit.primitive < 0 ? "nothing" : scene.primitives[static_cast<std::size_t>(hit.primitive)].id;
  };
  EXPECT_EQ(seen(10, 128), "left");
  EXPECT_EQ(seen(245, 128), "right");
  EXPECT_EQ(seen(128, 60), "back");
  EXPECT_EQ(seen(128, 245), "floor");  // down to 128 (1 + 273/800 · 35/12.5) = 250
  EXPECT_EQ(seen(128, 36), "lamp");    // 128 (1 − 275.7/1079.5 · 35/12.5) = 36
  EXPECT_EQ(seen(128, 5), "ceiling");
}

TEST(GlossyIndirect, TheLampFacesTheCeilingAndTheFloorSeesItsBackOnly) {
  const Scene scene = load_catalogue_scene("glossy-indirect");
  EXPECT_TRUE(is_plain(scene));
  EXPECT_TRUE(is_grey(scene));
  EXPECT_EQ(scene.max_depth, 8);
  const Flat& lamp = side(scene, "lamp");
  EXPECT_EQ(lamp.normal, Vec3::UnitY());
  for (const char* id : {"floor", "left", "right", "back", "ceiling"}) {
    const Flat& wall = side(scene, id);
    EXPECT_GT(wall.normal.dot(Vec3(0, 1.5, 0) - wall.center), 0) << id;  // fronts look into the room
  }
  EXPECT_LT(lamp.normal.dot(side(scene, "floor").center - lamp.center), 0);
}

}  // namespace
}  // namespace halfslope
