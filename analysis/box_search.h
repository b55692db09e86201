// Branch and bound over the boxes that can be the worst.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "analysis/critical_boxes.h"

namespace halfslope {

/// Tells whether any box has more than a given excess, looking at few of them.
///
/// A node stands for the boxes u with low ≤ u ≤ high. Of the points that such boxes may hold, some are inside them all;
/// each of the others lies in the slab low_k < x_k ≤ high_k of some dimensions k, and is in u where it is below u_k in
/// all of these. As in D. P. Dobkin, D. Eppstein, D. P. Mitchell, "Computing the discrepancy with applications to
/// supersampling patterns", ACM Trans. Graph. 15(4), 1996, points in one slab alone are what makes a node easy: the
/// number of those in u is a sum over dimensions, Σ_k c_k(u_k). The few in m > 1 slabs count 1/m in each of them for
/// closed boxes, which is never too little, and 0 for open ones, which is never too much. The volume is a sum as well,
/// once bounded by lines in t = Σ_k log u_k, on the t where an excess over the limit is possible at all:
///   exp(t) ≥ slope · (1 + t − log slope), a tangent, for closed boxes, and
///   exp(t) ≤ exp(t_high) + slope · (t − t_high), the chord, for open ones, with the chord's slope in both.
/// So the bound of a node is a sum of maxima over single dimensions, found in one pass over its points, and off by the
/// square of its size only. The u that attains it is a box worth looking at. An end of dimension k whose term falls
/// short of the largest by more than bound − limit is in no box over the limit: low and high move in past such ends.
/// What is left is split in the widest dimension at the median of its points, and both halves are searched.
class BoxSearch {
 public:
  static constexpr std::size_t kMostDims = 32;
  /// How much larger than the one it names an excess may be that a search has passed over: what rounding does, and
  /// ties.
  static constexpr double kTolerance = 1e-13;

  /// `boxes`: of at most kMostDims dimensions; must outlive it.
  explicit BoxSearch(const CriticalBoxes& boxes);

  /// True: no box has more than the larger of `threshold` and `best`, by more than kTolerance. False: `work`, which
  /// counts looks at a point and is lessened by those taken, ran out, or the nodes their gigabyte. `best` rises to the
  /// excess of each box looked at, so with threshold 0 and true it is the largest there is.
  bool run(double threshold, double& best, std::uint64_t& work);

 private:
  /// A point in a slab; the other slabs that it is in, too, one bit a dimension.
  struct Entry {
    std::uint32_t point, slabs;
  };
  using Ends = std::array<std::uint32_t, kMostDims>;
  struct Node {
    Ends low, high;
    std::array<std::size_t, kMostDims + 1> begin;  ///< in entries_, of each slab's points in ascending order
    std::int64_t inside, undecided;                ///< points
  };
  /// Volumes of the smallest and the largest box, and their logarithms; `free` dimensions, of which `one` is one.
  struct Reach {
    double low = 1, high = 1, low_log = 0, high_log = 0;
    std::size_t free = 0, one = 0;
  };
  struct Relaxation {
    double bound, slope;
    std::array<double, kMostDims> largest;  ///< term of each dimension
    std::array<double, kMostDims> outer;    ///< the term of the end that is no point's: `low` of closed, `high` of open
    Ends box;                               ///< where they are attained
  };
  struct Split {
    Ends low, high;
    std::size_t dim, kept;  ///< dim = dims() where nothing is left to split
    std::uint32_t middle;   ///< of the upper half the lowest end
  };

  double limit() const;
  std::size_t entries(const Node& node, std::size_t k) const { return node.begin[k + 1] - node.begin[k]; }
  std::size_t entries(const Node& node) const { return node.begin[boxes_.dims()] - node.begin[0]; }
  void spend(std::size_t looks) { work_ -= std::min<std::uint64_t>(work_, looks); }
  std::size_t points_in(const Node& node, const Ends& box);
  bool narrow(const Node& from, Node& to);
  template <Side kSide>
  Reach tighten(Node& node) const;
  template <Side kSide>
  Relaxation relax(const Node& node, Reach reach);
  template <Side kSide>
  Split shrink(const Node& node, const Relaxation& relaxed) const;
  Split split_low(const Node& node) const;
  template <Side kSide>
  bool search(std::size_t depth);
  template <Side kSide>
  bool search_within(std::size_t depth, const Ends& low, const Ends& high);

  const CriticalBoxes& boxes_;
  std::vector<std::vector<double>> logs_;  ///< of boxes_.ends
  std::vector<double> weights_;            ///< of a point in so many slabs
  std::vector<Entry> entries_;             ///< of the nodes from the root to the present one
  std::vector<double> terms_;              ///< of the present node's entries
  std::deque<Node> nodes_;
  double threshold_ = 0, best_ = 0;
  std::uint64_t work_ = 0;
};

}  // namespace halfslope
