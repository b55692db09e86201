// Elementary intervals in base 2.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/samplers/points.h"

namespace halfslope {

/// Whether the first two dimensions of a lane's 2^m points are a (0, m, 2)-net: one point in each of the 2^a × 2^(m−a)
/// equal boxes, for every a.
inline bool is_net(const Points& points, int m, int lane) {
  if (points.count() != std::uint64_t{1} << m) return false;
  for (int a = 0; a <= m; ++a) {
    const std::uint64_t columns = std::uint64_t{1} << a, rows = std::uint64_t{1} << (m - a);
    std::vector<int> seen(points.count());
    for (std::uint64_t i = 0; i < points.count(); ++i) {
      if (seen[points.interval(0, i, lane, columns) * rows + points.interval(1, i, lane, rows)]++) return false;
    }
  }
  return true;
}

}  // namespace halfslope
