// Sixteen rays in Embree: against our own double-precision code, against each other, and at edges.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/error.h"
#include "core/kernel_library.h"
#include "scenes/embree_scene.h"
#include "scenes/intersector.h"
#include "scenes/mesh_reader.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class Shape>
void add(Scene& scene, Shape shape) {
  Primitive primitive;
  primitive.shape = std::move(shape);
  primitive.id = "shape" + std::to_string(scene.primitives.size() + 1);
  scene.primitives.push_back(std::move(primitive));
}

/// One of each shape, apart from each other.
Scene mixed_scene() {
  Scene scene;
  Eigen::Affine3d move = Eigen::Translation3d(2, 2, 0) * Eigen::AngleAxisd(0.7, Vec3(2, 1, 2) / 3);
  add(scene, std::make_shared<const Mesh>(transformed(make_cube(), move.matrix(), false, false)));
  add(scene, Sphere{{-2, 2, 0}, 1.2});
  add(scene, Flat{{-2, -2, 0}, {1, 0, 0.3}, {0, 1.5, 0}, Vec3(-0.3, 0, 1).normalized()});
  add(scene, Flat{{0, 0, -2.5}, {1, 1, 0}, {-2, 2, 0}, {0, 0, 1}, Flat::Outline::kDisk});
  add(scene, Cylinder{{2, -3, -1}, {2.5, -1, 1}, 0.8});
  return scene;
}

/// A closed mesh: an octahedron's faces cut into n² each and moved onto the unit sphere.
Mesh round_mesh(int n) {
  Mesh mesh;
  for (int face = 0; face < 8; ++face) {
    const double sx = face & 1 ? -1 : 1, sy = face & 2 ? -1 : 1, sz = face & 4 ? -1 : 1;
    const auto at = [&](int i, int j) {
      const Vec3 p = Vec3(sx * i, sy * j, sz * (n - i - j)).normalized();
      mesh.positions.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
      return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (sx * sy * sz < 0) std::swap(b, c);
      mesh.triangles.push_back({a, b, c});
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        triangle(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  return mesh;
}

Scene round_scene(int n) {
  Scene scene;
  add(scene, std::make_shared<const Mesh>(round_mesh(n)));
  return scene;
}

/// Rays from around towards the middle of the scene; one in four of the packets goes much the same way.
std::vector<RayPacket> random_rays(int packets, double around) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<RayPacket> rays(static_cast<std::size_t>(packets));
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    const Vec3 shared_origin = around * vector().normalized(), shared_target = vector();
    for (int i = 0; i < 16; ++i) {
      const Vec3 origin = p % 4 ? Vec3(around * vector().normalized()) : shared_origin;
      const Vec3 target = p % 4 ? vector() : Vec3(shared_target + 0.01 * vector());
      const Vec3 direction = (target - origin).normalized();
      rays[p].ox[i] = static_cast<float>(origin.x());
      rays[p].oy[i] = static_cast<float>(origin.y());
      rays[p].oz[i] = static_cast<float>(origin.z());
      rays[p].dx[i] = static_cast<float>(direction.x());
      rays[p].dy[i] = static_cast<float>(direction.y());
      rays[p].dz[i] = static_cast<float>(direction.z());
      rays[p].tnear[i] = 0;
      rays[p].tfar[i] = kInfinity;
      rays[p].active[i] = -1;
    }
  }
  return rays;
}

Ray ray_of(const RayPacket& packet, int i) {
  return {{packet.ox[i], packet.oy[i], packet.oz[i]}, Vec3(packet.dx[i], packet.dy[i], packet.dz[i]).normalized()};
}

void copy_ray(const RayPacket& from, int i, RayPacket& to, int j) {
  for (const auto field : {&RayPacket::ox, &RayPacket::oy, &RayPacket::oz, &RayPacket::dx, &RayPacket::dy,
                           &RayPacket::dz, &RayPacket::tnear, &RayPacket::tfar})
    (to.*field)[j] = (from.*field)[i];
  to.active[j] = from.active[i];
}

bool same_bits(const RayPacket& a, int i, const RayPacket& b, int j) {
  return a.primitive[i] == b.primitive[j] && a.triangle[i] == b.triangle[j] &&
         std::bit_cast<std::uint32_t>(a.tfar[i]) == std::bit_cast<std::uint32_t>(b.tfar[j]) &&
         std::bit_cast<std::uint32_t>(a.u[i]) == std::bit_cast<std::uint32_t>(b.u[j]) &&
         std::bit_cast<std::uint32_t>(a.v[i]) == std::bit_cast<std::uint32_t>(b.v[j]);
}

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

TEST(Embree, ARayMeetsTheSameWhateverItsNeighboursAre) {
  const EmbreeScene embree(round_scene(40));
  std::vector<RayPacket> rays = random_rays(500, 3), alone = rays, mixed = rays;
  // Every lane goes to another packet and place.
  std::vector<std::size_t> order(rays.size() * 16);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  for (std::size_t i = 0; i < order.size(); ++i)
    copy_ray(rays[i / 16], static_cast<int>(i % 16), mixed[order[i] / 16], static_cast<int>(order[i] % 16));
  for (RayPacket& packet : rays) embree.first(packet);
  for (RayPacket& packet : mixed) embree.first(packet);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto lane = static_cast<int>(i % 16);
    ASSERT_TRUE(same_bits(rays[i / 16], lane, mixed[order[i] / 16], static_cast<int>(order[i] % 16))) << i;
    if (i % 7) continue;
    RayPacket one = {};
    copy_ray(alone[i / 16], lane, one, lane);
    embree.first(one);
    ASSERT_TRUE(same_bits(rays[i / 16], lane, one, lane)) << i;
  }
}

TEST(Embree, EachInstructionSetOfAClassMeetsTheSame) {
  std::vector<RayPacket> rays = random_rays(500, 3);
  const char* asked = std::getenv("HALFSLOPE_ISA");
  const std::string before = asked ? asked : "";
  std::vector<std::vector<RayPacket>> results;
  for (const Isa isa : supported_isas()) {
    if (isa_class(isa) != "fma") continue;
    setenv("HALFSLOPE_ISA", to_string(isa).c_str(), 1);
    const EmbreeScene embree(round_scene(40));
    results.push_back(rays);
    for (RayPacket& packet : results.back()) embree.first(packet);
  }
  asked ? setenv("HALFSLOPE_ISA", before.c_str(), 1) : unsetenv("HALFSLOPE_ISA");
  if (results.size() < 2) GTEST_SKIP() << "this processor has one instruction set of the class";
  for (std::size_t p = 0; p < rays.size(); ++p) {
    for (int i = 0; i < 16; ++i) ASSERT_TRUE(same_bits(results[0][p], i, results[1][p], i));
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

/// Each triangle several times, in random order: which copy is met depends on the hierarchy alone.
Scene scene_of_ties() {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> uniform(-1, 1);
  auto mesh = std::make_shared<Mesh>();
  for (int i = 0; i < 10000; ++i) {
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    const auto first = static_cast<std::uint32_t>(mesh->positions.size());
    for (int k = 0; k < 3; ++k)
      mesh->positions.push_back({x + 0.1F * uniform(random), y + 0.1F * uniform(random), z + 0.1F * uniform(random)});
    mesh->triangles.insert(mesh->triangles.end(), 4, {first, first + 1, first + 2});
  }
  std::shuffle(mesh->triangles.begin(), mesh->triangles.end(), random);
  Scene scene;
  add(scene, std::shared_ptr<const Mesh>(mesh));
  return scene;
}

TEST(Embree, AnyNumberOfThreadsBuildsTheSame) {
  const Scene scene = scene_of_ties();
  std::vector<std::vector<RayPacket>> results;
  for (const int threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    std::vector<RayPacket>& rays = results.emplace_back(random_rays(1000, 3));
    tbb::task_arena(threads).execute([&] {
      const EmbreeScene embree(scene);
      for (RayPacket& packet : rays) embree.first(packet);
    });
  }
  for (std::size_t p = 0; p < results[0].size(); ++p) {
    for (int i = 0; i < 16; ++i) {
      ASSERT_TRUE(same_bits(results[0][p], i, results[1][p], i));
      ASSERT_TRUE(same_bits(results[0][p], i, results[2][p], i));
    }
  }
}

TEST(Embree, LeavesTheProcessItsThreads) {
  const auto threads = [] { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); };
  const std::size_t before = threads();
  const EmbreeScene embree(mixed_scene());
  EXPECT_EQ(threads(), before);
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
