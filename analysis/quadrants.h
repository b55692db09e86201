// For each of many points of the plane, a sum over the points to its lower left.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/wide_integer.h"

namespace halfslope {

/// A point, in an array that is in the order of x. `rank` is its place in the order of y, all different, 0 … N − 1;
/// `place` its own in the order of x.
struct QuadrantPoint {
  Int128 sum;
  std::int64_t y;  ///< |y| < 2⁶²
  std::uint32_t rank, place;
};

/// Adds 2 Σ (y − y') over the points before it of smaller rank to each point's sum, and calls visit(point) for each in
/// the order of ranks. Leaves `points` in no order. O(N log N).
///
/// A binary radix sort by rank from the highest bit down: of two points, the one place where their ranks' bits part is
/// where the one with a 1 meets, in the running sums of the zeros that it came after, the one with a 0 (a wavelet tree
/// that is walked and never stored).
template <class Visit>
class Quadrants {
 public:
  Quadrants(std::vector<QuadrantPoint>& points, Visit visit) : other_(points.size()), visit_(visit) {
    std::size_t size = 1;
    while (size < points.size()) size *= 2;
    group(points.data(), other_.data(), 0, points.size(), size);
  }

 private:
  static constexpr std::size_t kSmall = 8;

  // The points of ranks begin … end − 1 lie at those places of `from`.
  void group(QuadrantPoint* from, QuadrantPoint* to, std::size_t begin, std::size_t end, std::size_t size) {
    if (end - begin <= kSmall) return small_group(from, begin, end);
    const std::size_t middle = begin + size / 2;
    if (middle >= end) return group(from, to, begin, end, size / 2);
    std::array<QuadrantPoint*, 2> next = {to + begin, to + middle};
    std::int64_t count = 0;
    Int128 sum = 0;
    for (const QuadrantPoint* p = from + begin; p != from + end; ++p) {
      const bool upper = p->rank >= middle;
      const std::int64_t mask = -static_cast<std::int64_t>(upper);
      QuadrantPoint& q = *next[upper]++;
      q = *p;
      q.sum += (static_cast<Int128>(p->y) * count - sum) & mask;
      count += 2 & ~mask;
      sum += (2 * p->y) & ~mask;
    }
    group(to, from, begin, middle, size / 2);
    group(to, from, middle, end, size / 2);
  }

  void small_group(QuadrantPoint* from, std::size_t begin, std::size_t end) {
    std::array<QuadrantPoint*, kSmall> by_rank;
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t j = begin; j < k; ++j) {
        const std::int64_t above = -static_cast<std::int64_t>(from[k].rank > from[j].rank);
        from[k].sum += 2 * static_cast<Int128>(from[k].y - from[j].y) & above;
      }
      by_rank[from[k].rank - begin] = from + k;
    }
    for (std::size_t k = 0; k < end - begin; ++k) visit_(*by_rank[k]);
  }

  std::vector<QuadrantPoint> other_;
  Visit visit_;
};

}  // namespace halfslope
