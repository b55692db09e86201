// poisson-disk and best-candidate: how far their points keep from each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "samplers/best_candidate.h"
#include "samplers/poisson_disk.h"
#include "samplers/torus.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kPair = {{2}};

TorusPoint torus_point(const Points& points, std::uint64_t i, int lane, int dim = 0) {
  return {static_cast<std::uint32_t>(points.at(dim, i, lane) >> 21),
          static_cast<std::uint32_t>(points.at(dim + 1, i, lane) >> 21)};
}

double distance(TorusPoint a, TorusPoint b) { return std::sqrt(static_cast<double>(squared_distance(a, b))) * 0x1p-32; }

/// The least distance of two points over that of the densest packing, √(2/(√3 N)), which no set can exceed by more than
/// rounding.
double relative_radius(const Points& points, std::uint64_t count, int lane, int dim = 0) {
  double least = 1;
  for (std::uint64_t i = 0; i < count; ++i) {
    for (std::uint64_t j = 0; j < i; ++j) {
      least = std::min(least, distance(torus_point(points, i, lane, dim), torus_point(points, j, lane, dim)));
    }
  }
  return least / std::sqrt(2 / (std::sqrt(3.0) * static_cast<double>(count)));
}

// Of N uniform points N(N − 1)/2 · πr² = (N − 1)πρ²/√3 pairs are expected within the relative radius ρ. For N ≥ 64
// these are more than 10 for ρ = 0.3, and more than 48 for ρ = 0.65, where a Poisson disk set begins (A. Lagae & P.
// Dutré, "A comparison of methods for generating Poisson disk distributions", 2008). A set that has none is no
// accident.
TEST(PoissonDisk, PointsKeepTheirDistanceOnTheTorus) {
  const auto sampler = sampler_named("poisson-disk");
  for (const std::uint64_t count : {64u, 100u, 257u, 1024u}) {
    const Points points = points_of(*sampler, count, {{2, 2}});
    for (int lane = 0; lane < kLanes; ++lane) {
      for (const int dim : {0, 2}) {
        const double radius = relative_radius(points, count, lane, dim);
        EXPECT_GT(radius, 0.65) << count << " lane " << lane;
        EXPECT_LE(radius, 1) << count << " lane " << lane;
      }
    }
  }
}

TEST(BestCandidate, PrefixesKeepTheirDistanceOnTheTorus) {
  const auto sampler = sampler_named("best-candidate");
  const Points points = points_of(*sampler, 1024, {{2, 2}});
  for (const std::uint64_t count : {64u, 100u, 257u, 1024u}) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const double radius = relative_radius(points, count, lane);
      EXPECT_GT(radius, 0.3) << count << " lane " << lane;
      EXPECT_LE(radius, 1) << count << " lane " << lane;
    }
  }
  // The second pair is shuffled within octaves, so its prefixes of powers of two are such sets too.
  for (int lane = 0; lane < kLanes; ++lane) EXPECT_GT(relative_radius(points, 256, lane, 2), 0.3) << lane;
}

// The part A of the torus that is farther from n points than the next point is: that point was the farthest of n
// uniform candidates, so A is the least of n uniform numbers, with mean 1/(n + 1) and variance n/((n + 1)²(n + 2)).
// Each of 4096 replicates measures its A by 200 random places, which adds a variance E[A(1 − A)]/200; false alarm 4e-8
// for each.
TEST(BestCandidate, EachPointIsTheFarthestOfAsManyCandidatesAsThereArePoints) {
  constexpr int kPlaces = 200, kGroups = 256;
  const auto sampler = sampler_named("best-candidate");
  std::mt19937 generator(3);
  const auto random = [&] { return static_cast<std::uint32_t>(generator()); };
  for (const std::uint64_t n : {1u, 2u, 7u, 30u}) {
    double sum = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, n + 1, kPair, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto nearest = [&](TorusPoint from) {
          std::uint64_t least = ~std::uint64_t{0};
          for (std::uint64_t i = 0; i < n; ++i)
            least = std::min(least, squared_distance(torus_point(points, i, lane), from));
          return least;
        };
        const std::uint64_t taken = nearest(torus_point(points, n, lane));
        for (int place = 0; place < kPlaces; ++place) sum += nearest({random(), random()}) > taken;
      }
    }
    const double m = static_cast<double>(n), mean = 1 / (m + 1), variance = m / ((m + 1) * (m + 1) * (m + 2));
    const double replicates = kGroups * kLanes;
    const double se = std::sqrt((variance + (mean - variance - mean * mean) / kPlaces) / replicates);
    EXPECT_LT(std::abs(sum / kPlaces / replicates - mean) / se, 5.5) << n;
  }
}

TEST(BlueNoise, NoPlaceOfTheTorusIsPreferred) {
  // All points of a set together, in 16 × 16 cells, against a uniform spread: no place of the torus is preferred.
  // Points that keep their distance fall into cells more evenly than independent ones, so χ² is smaller, never larger,
  // than with 255 degrees of freedom. False alarm below 1e-7.
  for (const char* name : {"poisson-disk", "best-candidate"}) {
    const auto sampler = sampler_named(name);
    std::array<std::uint32_t, 256> cells = {};
    for (std::uint32_t group = 0; group < 16; ++group) {
      const Points points = points_of(*sampler, 128, kPair, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        for (std::uint64_t i = 0; i < 128; ++i) {
          ++cells[points.interval(0, i, lane, 16) * 16 + points.interval(1, i, lane, 16)];
        }
      }
    }
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(cells)), chi_squared_upper(255, 1e-7)) << name;
  }
}

TEST(BlueNoise, ACoordinateAloneIsNotStratified) {
  // Of the mean of x over N = 64 points: 1/(12N) if they were independent, 1/(12N³) if x were stratified. Blue noise
  // stays within the first's order of magnitude or so. 2048 estimates, nearly normal: the bounds are a factor of two
  // and more away from 5.5 of their spread.
  for (const char* name : {"poisson-disk", "best-candidate"}) {
    const auto sampler = sampler_named(name);
    double squares = 0;
    for (std::uint32_t group = 0; group < 128; ++group) {
      const Points points = points_of(*sampler, 64, {{1}}, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        double error = 0;
        for (std::uint64_t i = 0; i < 64; ++i) error += (points(0, i, lane) - 0.5) / 64;
        squares += error * error;
      }
    }
    const double variance = squares / (128 * kLanes);
    EXPECT_LT(variance, 0.5 / (12 * 64.0)) << name;
    EXPECT_GT(variance, 20 / (12 * 64.0 * 64 * 64)) << name;
  }
}

TEST(BlueNoise, CountsAreBounded) {
  const Layout five = {{1, 2, 2, 1, 2}};
  EXPECT_EQ(sampler_named("poisson-disk")->illegal((1u << 16) + 1, kPair)->below, 1u << 16);
  EXPECT_EQ(sampler_named("poisson-disk")->illegal(60000, five)->below, (1u << 18) / 5);
  EXPECT_EQ(sampler_named("best-candidate")->illegal((1u << 14) + 1, kPair)->below, 1u << 14);
  EXPECT_FALSE(sampler_named("best-candidate")->illegal(16000, kPair));
}

}  // namespace
}  // namespace halfslope
