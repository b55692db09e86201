#include "samplers/sample_elimination.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace halfslope {
namespace {

double toroidal(TorusPoint a, TorusPoint b) {
  const auto along = [](std::uint32_t p, std::uint32_t q) {
    const double d = std::abs(p * 0x1p-32 - q * 0x1p-32);
    return std::min(d, 1 - d);
  };
  return std::hypot(along(a.x, b.x), along(a.y, b.y));
}

std::vector<TorusPoint> random_points(std::size_t count, std::mt19937& random) {
  std::vector<TorusPoint> points(count);
  for (TorusPoint& p : points) p = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())};
  return points;
}

/// The paper's algorithm 1 with its weight function, as it is written down: all pairs, every time.
std::vector<std::uint32_t> eliminated(const std::vector<TorusPoint>& points, std::uint32_t count) {
  const double r_max = std::sqrt(1 / (2 * std::sqrt(3.0) * count));
  const double r_min =
      r_max * (1 - std::pow(static_cast<double>(count) / static_cast<double>(points.size()), 1.5)) * 0.65;
  std::vector<std::uint32_t> left(points.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  while (left.size() > count) {
    double heaviest = -1;
    std::size_t at = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      double weight = 0;
      for (const std::uint32_t j : left) {
        if (j == left[i]) continue;
        const double d = std::clamp(toroidal(points[left[i]], points[j]), 2 * r_min, 2 * r_max);
        weight += std::pow(1 - d / (2 * r_max), 8);
      }
      if (weight > heaviest) heaviest = weight, at = i;
    }
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
  }
  return left;
}

TEST(SampleElimination, KeepsWhatThePapersAlgorithmKeeps) {
  std::mt19937 random(1);
  SampleElimination elimination;
  // Not down to one point, since of two the weights are equal.
  for (const std::uint32_t count : {2u, 3u, 7u, 8u, 16u, 60u, 9u}) {
    const std::vector<TorusPoint> points = random_points(5 * count, random);
    EXPECT_EQ(elimination.keep(points, count), eliminated(points, count)) << count;
    EXPECT_EQ(elimination.keep(points, 5 * count).size(), points.size());
  }
}

TEST(SampleElimination, DoesNotSeeWhereTheTorusIsCut) {
  std::mt19937 random(2);
  SampleElimination elimination;
  std::vector<TorusPoint> points = random_points(1000, random);
  const auto kept = elimination.keep(points, 200);
  for (TorusPoint& p : points) p = {p.x + 0x87654321u, p.y + 0x12345678u};
  EXPECT_EQ(elimination.keep(points, 200), kept);
}

}  // namespace
}  // namespace halfslope
