#include "analysis/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace halfslope {
namespace {

// Keys spread out, few, all but equal, in order already, and with high bits in common so that insertions give up.
TEST(RadixSort, IsAStableSort) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {0, 1, 2, 100, 1023, 1024, 1025, 5000, 100000}) {
    for (int kind = 0; kind < 6; ++kind) {
      std::vector<KeyedPoint> points(count);
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t word = random();
        const std::uint64_t keys[] = {
            word >> 2, word % 5, 7, i, (std::uint64_t{1} << 61) + word % 1000, word % 10 == 0 ? word >> 2 : word >> 40};
        points[i] = {keys[kind], i};
      }
      std::vector<KeyedPoint> expected = points;
      std::stable_sort(expected.begin(), expected.end(),
                       [](const KeyedPoint& a, const KeyedPoint& b) { return a.key < b.key; });
      radix_sort(points);
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(points[i].key, expected[i].key) << count << " kind " << kind << " at " << i;
        ASSERT_EQ(points[i].load, expected[i].load) << count << " kind " << kind << " at " << i;
      }
    }
  }
}

}  // namespace
}  // namespace halfslope
