// The tree of lights: probabilities that sum to 1 for every receiver, are what is drawn (chi-squared) and the same bits
// both ways, are positive wherever a light can contribute, and favour what is near, bright and facing.
#include "scenes/light_bvh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/scenes/chi_squared.h"

namespace halfslope {
namespace {

using Vec3 = Eigen::Vector3d;

/// A one-sided flat light, of whose corners the box is made.
struct FlatLight {
  Vec3 corner, edge_1, edge_2;

  Vec3 normal() const { return edge_1.cross(edge_2).normalized(); }
  Vec3 at(double a, double b) const { return corner + a * edge_1 + b * edge_2; }
  LightLeaf leaf(double power) const {
    LightLeaf leaf;
    for (int k = 0; k < 3; ++k) {
      leaf.lower[k] = std::min({at(0, 0)[k], at(1, 0)[k], at(0, 1)[k], at(1, 1)[k]});
      leaf.upper[k] = std::max({at(0, 0)[k], at(1, 0)[k], at(0, 1)[k], at(1, 1)[k]});
      leaf.axis[k] = normal()[k];
    }
    leaf.cos_normals = 1, leaf.cos_emission = 0, leaf.power = power;
    return leaf;
  }
};

struct Lights {
  std::vector<FlatLight> flats;
  std::vector<LightLeaf> leaves;
};

Lights random_lights(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vec = [&](double size) { return Vec3(size * Vec3(unit(random), unit(random), unit(random))); };
  Lights lights;
  for (int i = 0; i < count; ++i) {
    lights.flats.push_back({vec(1), vec(0.1), vec(0.1)});
    lights.leaves.push_back(lights.flats.back().leaf(std::exp(2 * unit(random))));
  }
  return lights;
}

template <class T>
struct Receiver {
  T position[3], normal[3];
};

template <class T>
Receiver<T> receiver(std::mt19937_64& random, double reach, bool with_normal) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Receiver<T> r;
  Vec3 normal(unit(random), unit(random), unit(random));
  normal.normalize();
  for (int k = 0; k < 3; ++k) {
    r.position[k] = static_cast<T>(reach * unit(random));
    r.normal[k] = with_normal ? static_cast<T>(normal[k]) : T(0);
  }
  return r;
}

template <class T>
std::vector<double> probabilities(const LightBvh<T>& bvh, const Receiver<T>& r, bool one_sided = false) {
  std::vector<double> out;
  for (std::int32_t i = 0; i < bvh.data().leaf_count; ++i) {
    out.push_back(light_leaf_probability(bvh.data(), i, r.position, r.normal, one_sided));
  }
  return out;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

template <class T>
class LightBvhOf : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(LightBvhOf, Numbers);

TYPED_TEST(LightBvhOf, ProbabilitiesSumToOneForEveryReceiver) {
  using T = TypeParam;
  std::mt19937_64 random(1);
  for (const int count : {1, 2, 3, 17, 300}) {
    std::vector<LightLeaf> leaves = random_lights(count, 3).leaves;
    if (count == 17) {
      for (int i : {2, 9}) leaves[static_cast<std::size_t>(i)].everywhere = true;
    }
    const LightBvh<T> bvh(leaves);
    for (int k = 0; k < 200; ++k) {
      const double reach = std::pow(10.0, k % 5 - 1);
      const Receiver<T> r = receiver<T>(random, reach, k % 2);
      EXPECT_NEAR(sum_of(probabilities(bvh, r, k % 4 == 1)), 1, 64 * std::numeric_limits<T>::epsilon()) << count;
    }
  }
}

TYPED_TEST(LightBvhOf, LeavesAreDrawnAsOftenAsTheirProbability) {
  using T = TypeParam;
  std::vector<LightLeaf> leaves = random_lights(40, 5).leaves;
  leaves[7].everywhere = leaves[20].everywhere = leaves[21].everywhere = true;
  const LightBvh<T> bvh(leaves);
  std::mt19937_64 random(11);
  constexpr int kReceivers = 24;
  for (int k = 0; k < kReceivers; ++k) {
    const Receiver<T> r = receiver<T>(random, k % 3 == 0 ? 10 : 1, k % 2);
    std::vector<double> counts(leaves.size());
    for (int s = 0; s < 20000; ++s) {
      const auto chosen =
          choose_light_leaf(bvh.data(), r.position, r.normal, static_cast<std::uint32_t>(random() >> 32), k % 4 == 1);
      counts[static_cast<std::size_t>(chosen.leaf)] += 1;
    }
    expect_distribution(counts, probabilities(bvh, r, k % 4 == 1), 1e-6 / kReceivers, "receiver " + std::to_string(k));
  }
}

TYPED_TEST(LightBvhOf, ChoosingAndAskingGiveTheSameBits) {
  using T = TypeParam;
  std::vector<LightLeaf> leaves = random_lights(200, 7).leaves;
  leaves[3].everywhere = true;
  const LightBvh<T> bvh(leaves);
  std::mt19937_64 random(13);
  for (int k = 0; k < 20000; ++k) {
    const Receiver<T> r = receiver<T>(random, k % 3 == 0 ? 10 : 1, k % 2);
    const std::uint32_t word = k == 0 ? 0 : k == 1 ? 0xffffffffu : static_cast<std::uint32_t>(random() >> 32);
    const auto chosen = choose_light_leaf(bvh.data(), r.position, r.normal, word, k % 4 == 1);
    const T asked = light_leaf_probability(bvh.data(), chosen.leaf, r.position, r.normal, k % 4 == 1);
    ASSERT_EQ(std::memcmp(&asked, &chosen.probability, sizeof(T)), 0);
    ASSERT_GT(asked, 0);
  }
}

// Of each light some points are tried: where one faces the receiver, above its horizon if that matters, the light may
// contribute, and must be found.
TYPED_TEST(LightBvhOf, EachLightThatCanContributeCanBeChosen) {
  using T = TypeParam;
  const Lights lights = random_lights(150, 17);
  const LightBvh<T> bvh(lights.leaves);
  std::mt19937_64 random(19);
  int contributing = 0, impossible = 0;
  for (int k = 0; k < 300; ++k) {
    const bool one_sided = k % 2;
    const Receiver<T> r = receiver<T>(random, k % 3 == 0 ? 0.2 : 2, true);
    const Vec3 position(r.position[0], r.position[1], r.position[2]), normal(r.normal[0], r.normal[1], r.normal[2]);
    const std::vector<double> p = probabilities(bvh, r, one_sided);
    for (std::size_t i = 0; i < p.size(); ++i) {
      const FlatLight& light = lights.flats[i];
      bool contributes = false;
      for (double a = 0; a <= 1; a += 0.25) {
        for (double b = 0; b <= 1; b += 0.25) {
          const Vec3 way = light.at(a, b) - position;
          contributes = contributes || (-way.dot(light.normal()) > 0 && (!one_sided || way.dot(normal) > 0));
        }
      }
      if (contributes) {
        EXPECT_GT(p[i], 0);
        ++contributing;
      } else {
        impossible += p[i] == 0;
      }
    }
  }
  EXPECT_GT(contributing, 10000);
  EXPECT_GT(impossible, 10000);  // and those that face away are mostly left out
}

TYPED_TEST(LightBvhOf, WhatSendsMoreIsChosenMoreOften) {
  using T = TypeParam;
  const auto square = [](const Vec3& center, bool down) {
    const Vec3 u = 0.1 * Vec3::UnitX(), v = (down ? -0.1 : 0.1) * Vec3::UnitY();
    return FlatLight{center - 0.5 * (u + v), u, v};
  };
  // Twice as near: four times the light, in the limit of small lights; three times the power: three times the light.
  const std::vector<LightLeaf> leaves = {square({-100, 0, 100}, true).leaf(1), square({50, 0, 50}, true).leaf(1),
                                         square({-100, 1, 100}, true).leaf(3), square({50, 1, 50}, false).leaf(1)};
  const LightBvh<T> bvh(leaves);
  const Receiver<T> r = {{T(0), T(0), T(0)}, {T(0), T(0), T(1)}};
  const std::vector<double> p = probabilities(bvh, r);
  EXPECT_NEAR(p[2] / p[0], 3, 0.05);
  EXPECT_EQ(p[3], 0);  // faces away
  // Two nodes at first: of power 4, twice as far, seen under 45°; and of power 2, whose normals bound no angle.
  EXPECT_NEAR((p[0] + p[2]) / p[1], 4.0 / 4 * std::sqrt(0.5) / 2, 0.01);

  const LightBvh<T> pair(std::vector<LightLeaf>{leaves[0], leaves[1]});
  const std::vector<double> q = probabilities(pair, r);
  EXPECT_NEAR(q[1] / q[0], 4, 0.05);
}

TYPED_TEST(LightBvhOf, LightsWithoutAPlaceCountAsMuchAsTheTree) {
  using T = TypeParam;
  std::vector<LightLeaf> leaves = random_lights(5, 23).leaves;
  leaves[1].everywhere = leaves[4].everywhere = true;
  const Receiver<T> r = {{T(0.5), T(0), T(0)}, {T(0), T(0), T(0)}};
  const std::vector<double> p = probabilities(LightBvh<T>(leaves), r);
  EXPECT_NEAR(p[1], 1.0 / 3, 1e-7);
  EXPECT_NEAR(p[4], 1.0 / 3, 1e-7);
  leaves.resize(2), leaves[0].everywhere = true;
  const LightBvh<T> none(leaves);
  EXPECT_EQ(probabilities(none, r), (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(choose_light_leaf(none.data(), r.position, r.normal, 0).leaf, 0);
  EXPECT_EQ(choose_light_leaf(none.data(), r.position, r.normal, 0xffffffffu).leaf, 1);
}

// All at one place, without power, in a row of ever larger distances, a point at the receiver: the tree stays shallow
// and every choice a choice.
TYPED_TEST(LightBvhOf, HostileLightsAreChosenToo) {
  using T = TypeParam;
  LightLeaf point;
  for (int k = 0; k < 3; ++k) point.lower[k] = point.upper[k] = 0.25;
  point.power = 1;
  std::vector<LightLeaf> together(1000, point), dark(100, point), row(100, point);
  for (std::size_t i = 0; i < row.size(); ++i) {
    dark[i].power = 0;
    row[i].lower[0] = row[i].upper[0] = std::ldexp(1.0, static_cast<int>(i) - 60);
    row[i].power = std::ldexp(1.0, static_cast<int>(i));
  }
  const Receiver<T> at_light = {{T(0.25), T(0.25), T(0.25)}, {T(0), T(1), T(0)}};
  for (const auto& leaves : {together, dark, row}) {
    const LightBvh<T> bvh(leaves);
    EXPECT_LE(bvh.depth(), 63);
    EXPECT_NEAR(sum_of(probabilities(bvh, at_light)), 1, 1e-4);
    for (const std::uint32_t word : {0u, 0x80000000u, 0xffffffffu}) {
      EXPECT_GT(choose_light_leaf(bvh.data(), at_light.position, at_light.normal, word).probability, 0);
    }
  }
}

TEST(LightBvh, FiftyThousandLightsAreBuiltAtOnce) {
  const Lights lights = random_lights(50000, 29);
  const auto start = std::chrono::steady_clock::now();
  const LightBvh<float> bvh(lights.leaves);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  EXPECT_LE(bvh.depth(), 40);
}

}  // namespace
}  // namespace halfslope
