// For each of many points of the plane, a sum over the points to its lower left.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "analysis/wide_integer.h"

namespace halfslope {

/// A point, in an array that is in the order of x. `rank` is its place in the order of y, all different, 0 … N − 1.
struct QuadrantPoint {
  // In halves: as one, GCC 12 loads it into a vector, and the processor waits until both halves' stores are in memory.
  std::uint64_t sum_low;
  std::int64_t sum_high;
  std::int64_t x, y;  ///< |y| < 2⁶²
  std::uint64_t rank;

  Int128 sum() const { return static_cast<Int128>(sum_high) << 64 | sum_low; }
  void set_sum(Int128 sum) {
    sum_low = static_cast<std::uint64_t>(sum);
    sum_high = static_cast<std::int64_t>(sum >> 64);
  }
};

/// Adds 2 Σ (y − y') over the points before it of smaller rank to each point's sum, and calls visit(point) for each in
/// the order of ranks. `points` has room for as many again, and is left in no order. O(N log N).
///
/// A binary radix sort by rank from the highest bit down: of two points, the one place where their ranks' bits part is
/// where the one with a 1 meets, in the running sums of the zeros that it came after, the one with a 0 (a wavelet tree
/// that is walked and never stored).
template <class Visit>
class Quadrants {
 public:
  Quadrants(std::span<QuadrantPoint> points, Visit visit) : visit_(visit) {
    const std::size_t count = points.size() / 2;
    group(points.data(), points.data() + count, 0, count, std::bit_ceil(count));
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
      q.set_sum(p->sum() + ((static_cast<Int128>(p->y) * count - sum) & mask));
      q.x = p->x, q.y = p->y;
      q.rank = p->rank;
      count += 2 & ~mask;
      sum += (2 * p->y) & ~mask;
    }
    group(to, from, begin, middle, size / 2);
    group(to, from, middle, end, size / 2);
  }

  void small_group(QuadrantPoint* from, std::size_t begin, std::size_t end) {
    std::array<QuadrantPoint*, kSmall> by_rank;
    for (std::size_t k = begin; k < end; ++k) {
      Int128 sum = 0;
      for (std::size_t j = begin; j < k; ++j) {
        const std::int64_t above = -static_cast<std::int64_t>(from[k].rank > from[j].rank);
        sum += (from[k].y - from[j].y) & above;
      }
      from[k].set_sum(from[k].sum() + 2 * sum);
      by_rank[from[k].rank - begin] = from + k;
    }
    for (std::size_t k = 0; k < end - begin; ++k) visit_(*by_rank[k]);
  }

  Visit visit_;
};

}  // namespace halfslope
