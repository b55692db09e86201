// Elementary intervals.
#pragma once

#include <algorithm>
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

/// Whether each elementary interval of b^−(k_0 + … + k_(dims−1)), k_0 + … = digits, holds as many of the points as each
/// other; `widths` are the b^k of the dimensions before `dim`.
inline bool is_even(const Points& points, int dims, std::uint64_t base, int digits, int lane,
                    std::vector<std::uint64_t> widths = {}) {
  if (static_cast<int>(widths.size()) + 1 < dims) {
    std::uint64_t width = 1;
    for (int k = 0; k <= digits; ++k, width *= base) {
      auto longer = widths;
      longer.push_back(width);
      if (!is_even(points, dims, base, digits - k, lane, longer)) return false;
    }
    return true;
  }
  std::uint64_t last = 1, boxes = 1;
  for (int k = 0; k < digits; ++k) last *= base;
  widths.push_back(last);
  for (const std::uint64_t width : widths) boxes *= width;
  std::vector<std::uint64_t> counts(boxes);
  for (std::uint64_t i = 0; i < points.count(); ++i) {
    std::uint64_t box = 0;
    for (int d = 0; d < dims; ++d) {
      const std::uint64_t width = widths[static_cast<std::size_t>(d)];
      box = box * width + points.interval(d, i, lane, width);
    }
    ++counts[box];
  }
  return std::all_of(counts.begin(), counts.end(), [&](std::uint64_t n) { return n * boxes == points.count(); });
}

/// The least t for which the base^m points are a (t, m, dims)-net, by counting.
inline int counted_t(const Points& points, int dims, std::uint64_t base, int m, int lane) {
  int digits = 0;
  while (digits < m && is_even(points, dims, base, digits + 1, lane)) ++digits;
  return m - digits;
}

}  // namespace halfslope
