// The largest of many lines while time goes on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace halfslope {

/// Lines v_j(t) = c_j − slope · t · y_j over ascending y_j, the c_j whole numbers that start at 0 and are raised by one
/// for a whole tail of the j at a time; it knows which line is the largest (or the smallest) at the present time t ≥ 0,
/// which only goes forward.
///
/// A kinetic tournament (J. Basch, L. J. Guibas, J. Hershberger, "Data structures for mobile data", J. Algorithms 31,
/// 1999) in the nodes of a segment tree: a node knows the winner of its lines, relative to the raises of the nodes
/// above it, and the time until which no winner below it changes. Of two lines the one with the larger y falls faster,
/// so it is the larger one early and the smaller one late, and they meet at t = (c_right − c_left) / (slope · (y_right
/// − y_left)). Going forward visits the nodes whose time is up, raising a tail those on one path.
class KineticTree {
 public:
  enum class Winner { kLargest, kSmallest };
  struct Line {
    std::int64_t c;
    double y;
  };

  /// `y`: strictly ascending, at least one, at most 2³⁰; slope > 0.
  KineticTree(std::span<const double> y, double slope, Winner winner);

  /// Goes to time t, not before the present one.
  void advance(double t);

  /// Raises c_j by one for all j ≥ first; none where first is past the end.
  void raise_from(std::size_t first);

  /// The winner now; of equal lines either.
  Line winner() const { return {nodes_[1].c, nodes_[1].y}; }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  struct Node {
    double y = 0;
    double until = kNever;  ///< the winners here and below stay until then
    std::int32_t c = 0;     ///< the winner's, without the raises above
    std::int32_t raised = 0;
  };

  void settle(std::size_t node);
  void settle_overdue(std::size_t node);

  double slope_, time_ = 0;
  bool largest_;
  std::size_t leaves_, first_leaf_;  ///< a power of two; where y[0] is
  std::vector<Node> nodes_;          ///< node n has children 2n and 2n + 1, the root is 1
};

}  // namespace halfslope
