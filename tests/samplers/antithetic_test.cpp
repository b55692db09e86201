#include "samplers/antithetic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kLayout = {{2, 1, 2}};
constexpr std::uint64_t kOne = std::uint64_t{1} << 53;

TEST(Antithetic, PairsAddUpToOneExactlyAndNeitherIsAnEndOfTheInterval) {
  const auto sampler = make_antithetic();
  for (const int block : {256, 7}) {  // whole pairs, and pairs that two blocks share
    const Points points = points_of(*sampler, 3000, kLayout, 0, 7, kTestKey, 0, block);
    for (int dim = 0; dim < kLayout.dims(); ++dim) {
      for (std::uint64_t i = 0; i < points.count(); i += 2) {
        for (int lane = 0; lane < kLanes; ++lane) {
          const std::uint64_t a = points.at(dim, i, lane), b = points.at(dim, i + 1, lane);
          ASSERT_TRUE(0 < a && a < kOne && 0 < b && b < kOne);
          ASSERT_EQ(a + b, kOne);
          // As binary64 numbers too, and about the middle: odd functions cancel to the last bit.
          const double x = points(dim, i, lane), y = points(dim, i + 1, lane);
          ASSERT_EQ(x + y, 1.0);
          ASSERT_EQ(x - 0.5, -(y - 0.5));
        }
      }
    }
  }
}

TEST(Antithetic, InBinary32TheReflectionIsOneUnitInTheLastPlaceShort) {
  const Points points = points_of(*make_antithetic(), 3000, kLayout);
  for (std::uint64_t i = 0; i < points.count(); i += 2) {
    for (int lane = 0; lane < kLanes; ++lane)
      ASSERT_EQ((points.at(0, i, lane) >> 29) + (points.at(0, i + 1, lane) >> 29), (1u << 24) - 1);
  }
}

TEST(Antithetic, EvenFunctionsSeeEveryPointTwice) {
  // About the middle of the cube; so N points are worth N/2, and the error is √2 times that of independent ones.
  const Points points = points_of(*make_antithetic(), 1000, kLayout);
  const auto even = [&](std::uint64_t i, int lane) {
    return std::cos(points(0, i, lane) - 0.5) * (points(1, i, lane) - 0.5) * (points(2, i, lane) - 0.5);
  };
  for (std::uint64_t i = 0; i < points.count(); i += 2) {
    for (int lane = 0; lane < kLanes; ++lane) ASSERT_EQ(even(i, lane), even(i + 1, lane));
  }
}

TEST(Antithetic, OnlyEvenCountsAreLegal) {
  const auto sampler = make_antithetic();
  EXPECT_FALSE(sampler->illegal(2, kLayout));
  EXPECT_FALSE(sampler->illegal(998, kLayout));
  const auto odd = sampler->illegal(999, kLayout), one = sampler->illegal(1, kLayout);
  ASSERT_TRUE(odd && one);
  EXPECT_EQ(odd->below, 998u);
  EXPECT_EQ(odd->above, 1000u);
  EXPECT_EQ(one->below, std::nullopt);
  EXPECT_EQ(one->above, 2u);
}

}  // namespace
}  // namespace halfslope
