// Sixteen rays in Embree: against our own double-precision code, at edges, and what is wrong with them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/error.h"
#include "scenes/embree_scene.h"
#include "scenes/intersector.h"
#include "tests/scenes/embree_helpers.h"

namespace halfslope {
namespace {

TEST(Embree, MeetsWhatDoublePrecisionMeets) {
  const Scene scene = mixed_scene();
  const EmbreeScene embree(scene);
  const Intersector own(scene);
  ASSERT_FALSE(own.uses_embree());
  int rays = 0, hits = 0, differ = 0;
  std::vector<int> seen(scene.primitives.size());
  for (RayPacket packet : random_rays(4000, 8)) {
    const RayPacket before = packet;
    embree.first(packet);
    for (int i = 0; i < 16; ++i, ++rays) {
      const SurfaceHit hit = own.first(ray_of(before, i));
      if (hit.primitive != packet.primitive[i] || hit.triangle != packet.triangle[i]) {
        ++differ;
        continue;
      }
      if (hit.primitive < 0) {
        EXPECT_EQ(packet.tfar[i], kInfinity);
        continue;
      }
      ++hits;
      ++seen[static_cast<std::size_t>(hit.primitive)];
      EXPECT_NEAR(static_cast<double>(packet.tfar[i]), hit.distance, 1e-5 * hit.distance);
      if (hit.primitive != 0) continue;
      const auto& mesh = *std::get<std::shared_ptr<const Mesh>>(scene.primitives[0].shape);
      const auto& triangle = mesh.triangles[static_cast<std::size_t>(packet.triangle[i])];
      const auto at = [&](std::size_t k) {
        return Eigen::Vector3f(mesh.positions[triangle[k]].data()).cast<double>().eval();
      };
      const double u = static_cast<double>(packet.u[i]), v = static_cast<double>(packet.v[i]);
      EXPECT_LT(((1 - u - v) * at(0) + u * at(1) + v * at(2) - hit.position).norm(), 1e-5);
    }
  }
  EXPECT_LE(differ, rays / 10000);  // rays that binary32 takes past an edge
  EXPECT_GT(hits, rays / 4);
  for (const int count : seen) EXPECT_GT(count, 100);
}

TEST(Embree, OccludedIsAHitOnTheWay) {
  const Scene scene = mixed_scene();
  const EmbreeScene embree(scene);
  int blocked = 0;
  for (RayPacket packet : random_rays(1000, 8)) {
    RayPacket shadow = packet, whole = packet;
    embree.first(whole);
    for (int i = 0; i < 16; ++i) shadow.tfar[i] = 7.5F;
    const RayPacket before = shadow;
    embree.occluded(shadow);
    for (int i = 0; i < 16; ++i) {
      const bool expected = whole.primitive[i] >= 0 && whole.tfar[i] < 7.5F;
      blocked += expected;
      // A distance to the bit is Embree's own in occluded(), ours in first().
      if (std::abs(whole.tfar[i] - 7.5F) < 1e-5F) continue;
      EXPECT_EQ(shadow.tfar[i], expected ? -kInfinity : 7.5F);
      EXPECT_EQ(shadow.ox[i], before.ox[i]);
    }
  }
  EXPECT_GT(blocked, 1000);
}

TEST(Embree, InactiveLanesAndTheIntervalAreKept) {
  Scene scene;
  add(scene, Sphere{{0, 0, 0}, 1});
  const EmbreeScene embree(scene);
  RayPacket packet = {};
  for (int i = 0; i < 16; ++i) {
    packet.oz[i] = -3;
    packet.dz[i] = 2;  // distances are counted in lengths of the direction: 1 and 2
    packet.tfar[i] = i == 3 ? 0.5F : kInfinity;
    packet.tnear[i] = i == 4 ? 1.5F : i == 5 ? 2.5F : 0;
    packet.active[i] = i % 2 || i == 4 ? -1 : 0;
  }
  packet.ox[6] = std::numeric_limits<float>::quiet_NaN();
  embree.first(packet);
  for (int i = 0; i < 16; ++i) {
    const bool hit = packet.active[i] && i != 3 && i != 5;
    EXPECT_EQ(packet.primitive[i], hit ? 0 : -1) << i;
    EXPECT_EQ(packet.tfar[i], !hit ? (i == 3 ? 0.5F : kInfinity) : i == 4 ? 2.0F : 1.0F) << i;
  }
}

TEST(Embree, RaysThatAreNotFiniteMeetNothing) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, 1e30F}) {
    const EmbreeScene embree(mixed_scene());
    for (const auto field : {&RayPacket::ox, &RayPacket::oy, &RayPacket::oz, &RayPacket::dx, &RayPacket::dy,
                             &RayPacket::dz, &RayPacket::tnear, &RayPacket::tfar}) {
      RayPacket packet = random_rays(1, 8)[0], whole = packet;
      (packet.*field)[5] = bad;
      RayPacket shadow = packet;
      embree.first(packet);
      embree.first(whole);
      embree.occluded(shadow);
      const bool is_distance = field == &RayPacket::tfar && !std::isnan(bad);
      for (int i = 0; i < 16; ++i) {
        if (i == 5 && !is_distance) {
          EXPECT_EQ(packet.primitive[i], -1);
          EXPECT_NE(shadow.tfar[i], -kInfinity);
        } else {
          EXPECT_TRUE(same_bits(packet, i, whole, i));
        }
      }
    }
  }
}

/// How many rays from an origin inside the closed round_mesh(24), towards each of the targets, meet nothing.
int count_leaks(const Vec3& origin, const std::vector<Vec3>& targets) {
  static const EmbreeScene embree(round_scene(24));
  int leaks = 0;
  for (std::size_t first = 0; first + 16 <= targets.size(); first += 16) {
    RayPacket packet = {};
    for (int i = 0; i < 16; ++i) {
      const Vec3 direction = targets[first + static_cast<std::size_t>(i)] - origin;
      packet.ox[i] = static_cast<float>(origin.x());
      packet.oy[i] = static_cast<float>(origin.y());
      packet.oz[i] = static_cast<float>(origin.z());
      packet.dx[i] = static_cast<float>(direction.x());
      packet.dy[i] = static_cast<float>(direction.y());
      packet.dz[i] = static_cast<float>(direction.z());
      packet.tfar[i] = kInfinity;
      packet.active[i] = -1;
    }
    embree.first(packet);
    for (int i = 0; i < 16; ++i) leaks += packet.primitive[i] != 0;
  }
  return leaks;
}

TEST(Embree, NoRayLeavesAClosedMesh) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<Vec3> around(200000);
  for (Vec3& target : around) target = Vec3(normal(random), normal(random), normal(random)).normalized();
  for (const Vec3& origin : {Vec3(0.3, -0.2, 0.1), Vec3(0, 0.9, 0)}) EXPECT_EQ(count_leaks(origin, around), 0);
}

TEST(Embree, HardlyAnyOfThoseAimedAtCornersAndEdgesDoes) {
  const Mesh mesh = round_mesh(24);
  std::vector<Vec3> targets;
  for (const auto& triangle : mesh.triangles) {
    const auto at = [&](std::size_t k) {
      return Eigen::Vector3f(mesh.positions[triangle[k]].data()).cast<double>().eval();
    };
    for (std::size_t k = 0; k < 3; ++k) {
      targets.push_back(at(k));
      targets.push_back((at(k) + at((k + 1) % 3)) / 2);
    }
  }
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(0.3, -0.2, 0.1), Vec3(0, 0.9, 0)})
    EXPECT_LE(count_leaks(origin, targets), static_cast<int>(targets.size() / 100));
}

TEST(Embree, FarAndTinyShapesAreNotLost) {
  Scene scene;
  add(scene, Sphere{{1e6, 0, 0}, 1e-3});
  add(scene, Flat{{0, 1e9, 0}, {1e-2, 0, 0}, {0, 0, 1e-2}, {0, -1, 0}});
  add(scene, Cylinder{{0, 0, -1e5}, {1e-4, 0, -1e5}, 1e-4});
  const EmbreeScene embree(scene);
  for (int axis = 0; axis < 3; ++axis) {
    RayPacket packet = {};
    packet.active[0] = -1;
    packet.tfar[0] = kInfinity;
    packet.ox[0] = axis == 2 ? 5e-5F : 0;
    (axis == 0 ? packet.dx : axis == 1 ? packet.dy : packet.dz)[0] = axis == 2 ? -1.0F : 1.0F;
    embree.first(packet);
    EXPECT_EQ(packet.primitive[0], axis);
  }
}

TEST(Embree, RefusesWhatItWouldLeaveOut) {
  Scene scene;
  add(scene, Sphere{{1e19, 0, 0}, 1});
  try {
    const EmbreeScene embree(scene);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_STREQ(error.what(), "shape 'shape1' reaches 1e+19 from the origin, allowed: less than 1e+18");
  }
}

TEST(Embree, OneRayMeetsWhatAPacketMeets) {
  const Scene scene = mixed_scene();
  const EmbreeScene embree(scene);
  for (RayPacket packet : random_rays(200, 8)) {
    const RayPacket before = packet;
    embree.first(packet);
    for (int i = 0; i < 16; ++i) {
      const Ray ray{{before.ox[i], before.oy[i], before.oz[i]}, {before.dx[i], before.dy[i], before.dz[i]}};
      const auto found = embree.first(ray);
      EXPECT_EQ(found.primitive, packet.primitive[i]);
      if (found.primitive < 0) continue;
      EXPECT_NEAR(found.distance, static_cast<double>(packet.tfar[i]), 1e-4);
    }
  }
}

TEST(Embree, KernelsCallItThroughPointers) {
  Scene scene;
  add(scene, Sphere{{0, 0, 0}, 1});
  const EmbreeScene embree(scene);
  const TracePacket first = EmbreeScene::first_of, occluded = EmbreeScene::occluded_of;
  RayPacket packet = {};
  packet.oz[2] = -3;
  packet.dz[2] = 1;
  packet.tfar[2] = 10;
  packet.active[2] = -1;
  RayPacket shadow = packet;
  first(&embree, &packet);
  occluded(&embree, &shadow);
  EXPECT_EQ(packet.tfar[2], 2);
  EXPECT_EQ(shadow.tfar[2], -kInfinity);
}

}  // namespace
}  // namespace halfslope
