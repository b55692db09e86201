// The nearest of a growing number of points on the torus.
#pragma once

#include <cstdint>
#include <vector>

#include "samplers/torus.h"

namespace halfslope {

/// Points on the torus, by the cells of a grid that becomes finer as they become more. Meant for points that keep their
/// distance; with any others it is right, and slow.
class NearestGrid {
 public:
  /// Takes all points away; those that were added first stay in place in `points`, which must outlive the calls.
  void clear();
  void add(TorusPoint point);
  std::size_t size() const { return points_.size(); }
  /// Whether all points are farther from `from` than √`bound` (in squared_distance's unit), in which case `bound`
  /// becomes the squared distance of the nearest. One point at least.
  bool all_beyond(TorusPoint from, std::uint64_t& bound) const {
    // The point that is nearest to the middle of a cell is near enough to refuse most places in it.
    const std::uint64_t distance = squared_distance(near_[cell_of(from)], from);
    return distance > bound && search(from, distance, bound);
  }

 private:
  std::size_t cell_of(TorusPoint p) const { return (std::size_t{p.y >> shift_} << bits_) | (p.x >> shift_); }
  bool search(TorusPoint from, std::uint64_t distance, std::uint64_t& bound) const;
  void refine();
  void enter(std::uint32_t index);

  static constexpr std::uint32_t kNone = ~0u;
  int bits_ = 0, shift_ = 32;  ///< 2^bits cells along an axis, each of width 2^shift
  std::vector<TorusPoint> points_;
  std::vector<std::uint32_t> next_;   // of the same cell
  std::vector<std::uint32_t> first_;  // of each cell
  std::vector<TorusPoint> near_;      // a point near each cell's middle; any point will do, the nearer the better
};

}  // namespace halfslope
