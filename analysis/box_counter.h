// How many points there are in a box, in any dimension.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/critical_boxes.h"

namespace halfslope {

/// Counts the points of critical boxes, and moves boxes on to their nearest points, with one bit a point: of each
/// dimension it keeps the points below every 64th part of the ends, so that a count takes about N (d + 64)/64 word
/// operations. 8 N d bytes.
class BoxCounter {
 public:
  /// `boxes` must outlive it.
  explicit BoxCounter(const CriticalBoxes& boxes);

  std::size_t points(std::span<const std::uint32_t> box);

  /// Makes the excess of a box at least as large without changing its points: closed, each side moves in to the
  /// outermost point of the box; open, out to the next point that it would take in, one dimension after another in the
  /// order given. Returns the number of points.
  std::size_t snap(std::span<std::uint32_t> box, std::span<const std::uint32_t> order);

 private:
  using Word = std::uint64_t;

  bool has(const std::vector<Word>& points, std::uint32_t point) const {
    return (points[point / 64] >> point % 64 & 1) != 0;
  }
  void keep_below(std::size_t dim, std::uint32_t end, std::vector<Word>& points);

  const CriticalBoxes& boxes_;
  std::size_t words_, stride_;                      ///< of a set of points; of the ends that have one
  std::vector<std::vector<std::uint32_t>> order_;   ///< of each dimension: the points by their first end
  std::vector<std::vector<std::uint32_t>> before_;  ///< of each dimension and end: how many have an earlier first end
  std::vector<std::vector<Word>> below_;            ///< of each dimension: sets, of first ends < stride · row
  std::vector<std::vector<Word>> rest_;             ///< of a box: the points in it in this dimension and later ones
  std::vector<Word> in_, side_;
};

}  // namespace halfslope
