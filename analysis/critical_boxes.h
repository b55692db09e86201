// The boxes among which is the worst one, by number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/discrepancy.h"

namespace halfslope {

/// Which boxes: closed ones, with too many points; or open ones, with too few.
enum class Side { kFullest, kEmptiest };

/// The boxes [0, u] or [0, u) whose every u_k is a coordinate of some point or, of open ones, 1: one of them has the
/// largest excess, since a closed box may shrink and an open one grow until it meets a point (H. Niederreiter,
/// "Discrepancy and convex programming", Ann. Mat. Pura Appl. 93, 1972). A box is named by the place of each u_k among
/// `ends[k]`, and a point is in it where first[k][point] ≤ box[k] for all k. At most 2²⁷ points.
struct CriticalBoxes {
  CriticalBoxes(const PointSet& points, Side side);

  std::size_t count() const { return first.front().size(); }
  std::size_t dims() const { return ends.size(); }
  double volume(std::span<const std::uint32_t> box) const;
  /// (points in the box)/N − volume for closed boxes, volume − (points)/N for open ones.
  double excess(std::span<const std::uint32_t> box, std::size_t points) const;

  Side side;
  std::vector<std::vector<double>> ends;          ///< of each dimension, strictly ascending
  std::vector<std::vector<std::uint32_t>> first;  ///< of each dimension and point: the first end that has it
};

}  // namespace halfslope
