// The fullest and the emptiest of many boxes while their common side grows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace halfslope {

/// Boxes with a corner at the origin, width x that only grows, and heights y_0 < y_1 < …. Points are added as the sweep
/// comes to them. It knows which closed box has the largest, and which open one the smallest
/// (points in the box) − count · x · y_j.
///
/// For each j that is a line in x, raised by one for a whole tail of the j with each point: a kinetic tournament (J.
/// Basch, L. J. Guibas, J. Hershberger, "Data structures for mobile data", J. Algorithms 31, 1999) in the nodes of a
/// segment tree. A node knows the winners of its lines, less the raises of the nodes above it, and the x until which no
/// winner here or below changes. Of two lines the higher box's falls faster, so it is the larger one early and the
/// smaller one late, and they meet at x = (c_right − c_left) / (count · (y_right − y_left)). Growing visits the nodes
/// whose x has come, a point those on one path.
class BoxSweep {
 public:
  struct Box {
    std::int64_t points;
    double height;
  };

  /// `heights`: strictly ascending, in [0, 1], at least one; `count`: of all points, at most 2²⁷. The width is 0.
  BoxSweep(std::span<const double> heights, std::size_t count);

  /// Goes on to a width of at most 1, not less than the present one.
  void grow(double width);

  /// Adds a point (width, heights[rank]), which is in the closed boxes from that height on and in the open ones above
  /// it. These, however, have it already now: ask for the emptiest box of a width before its points are added.
  void add_point(std::size_t rank);

  Box fullest() const { return {nodes_[1].fullest.points, nodes_[1].fullest.height}; }
  Box emptiest() const { return {nodes_[1].emptiest.points, nodes_[1].emptiest.height}; }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  struct Line {
    double height = 0;
    std::int32_t points = 0;  ///< without the raises above
  };
  struct Node {
    Line fullest, emptiest;
    double until = kNever;
    std::int32_t raised = 0;  ///< what all its lines gained at once
  };

  void raise(std::size_t node);
  void settle(std::size_t node);
  void settle_overdue(std::size_t node);

  double slope_, width_ = 0;
  std::size_t leaves_;       ///< a power of two
  std::vector<Node> nodes_;  ///< node n has children 2n and 2n + 1, the root is 1
};

}  // namespace halfslope
