#include "samplers/nearest_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace halfslope {
namespace {

TEST(NearestGrid, AgreesWithAllDistances) {
  // Spread points, and points that crowd into a corner, which the grid is not made for.
  std::mt19937 generator(1);
  const auto random = [&] { return static_cast<std::uint32_t>(generator()); };
  NearestGrid grid;
  for (const int crowd : {0, 3, 12}) {
    grid.clear();
    std::vector<TorusPoint> points;
    for (int n = 0; n < 1500; ++n) {
      points.push_back({random() >> crowd, random() >> crowd});
      grid.add(points.back());
      ASSERT_EQ(grid.size(), points.size());
      for (int trial = 0; trial < 3; ++trial) {
        const TorusPoint from = {random(), random()};
        std::uint64_t nearest = ~std::uint64_t{0};
        for (const TorusPoint& p : points) nearest = std::min(nearest, squared_distance(p, from));
        for (const std::uint64_t bound :
             {std::uint64_t{0}, nearest / 2, nearest - 1, nearest, nearest + 1, 2 * nearest}) {
          std::uint64_t least = bound;
          ASSERT_EQ(grid.all_beyond(from, least), nearest > bound) << n;
          ASSERT_EQ(least, std::max(nearest, bound)) << n;
        }
      }
    }
  }
}

TEST(NearestGrid, DistancesAreExactAroundTheTorus) {
  const TorusPoint corner = {0, 0}, opposite = {1u << 31, 1u << 31};
  EXPECT_EQ(squared_distance(corner, opposite), 1ull << 63);
  EXPECT_EQ(squared_distance(opposite, corner), 1ull << 63);
  EXPECT_EQ(squared_distance({0xffffffffu, 5}, {2, 0xfffffffeu}), 9u + 49u);
}

}  // namespace
}  // namespace halfslope
