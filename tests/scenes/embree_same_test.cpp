// What sixteen rays meet in Embree is the same whatever their neighbours, the instruction set and the threads are.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "core/kernel_library.h"
#include "scenes/embree_scene.h"
#include "tests/scenes/embree_helpers.h"

namespace halfslope {
namespace {

TEST(EmbreeSame, ARayMeetsTheSameWhateverItsNeighboursAre) {
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

TEST(EmbreeSame, EachInstructionSetOfAClassMeetsTheSame) {
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

TEST(EmbreeSame, AnyNumberOfThreadsBuildsTheSame) {
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

TEST(EmbreeSame, LeavesTheProcessItsThreads) {
  const auto threads = [] { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); };
  const std::size_t before = threads();
  const EmbreeScene embree(mixed_scene());
  EXPECT_EQ(threads(), before);
}

}  // namespace
}  // namespace halfslope
