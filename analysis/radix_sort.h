// Sorting points by a coordinate.
#pragma once

#include <cstdint>
#include <vector>

namespace halfslope {

struct KeyedPoint {
  std::uint64_t key;
  std::uint64_t load;  ///< goes along
};

/// Ascending by key; of equal keys the earlier stays first. O(N): a radix sort by the keys' high bits, then insertions,
/// or by all bits where many keys share the high ones.
void radix_sort(std::vector<KeyedPoint>& points);

}  // namespace halfslope
