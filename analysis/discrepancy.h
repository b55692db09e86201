// How far points are from uniform: the discrepancies of anchored boxes. They know points as plain arrays.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace halfslope {

/// A view of N points of d dimensions: one array of N coordinates a dimension, each coordinate in [0, 1]. The arrays
/// must outlive it. No dimension, no point, or arrays of different lengths are a programmer's error and abort.
class PointSet {
 public:
  explicit PointSet(std::vector<std::span<const double>> columns);

  std::size_t count() const { return columns_.front().size(); }
  std::size_t dims() const { return columns_.size(); }
  std::span<const double> column(std::size_t dim) const { return columns_[dim]; }

 private:
  std::vector<std::span<const double>> columns_;
};

/// The star discrepancy D* = sup |#{points in B}/N − volume of B| over the boxes B with a corner at the origin, open or
/// closed, for 1 or 2 dimensions (any other number aborts; star_bounds.h takes them). In [1/(2N), 1], without a unit.
///
/// Exact but for rounding: every box that can be the worst one is looked at, and the error is at most
/// (3 log₂ N + 4) · 2⁻⁵³. One dimension: D* = 1/(2N) + max |x_(i) − (2i − 1)/(2N)| (H. Niederreiter, "Random Number
/// Generation and Quasi-Monte Carlo Methods", 1992, theorem 2.6), O(N log N). Two dimensions: O(N log² N) time and
/// about 200 N bytes; star_discrepancy.cpp says how.
double star_discrepancy(const PointSet& points);

/// The L2-star discrepancy: the root of the mean over boxes [0, u), u uniform in [0,1)^d, of
/// (#{points in [0, u)}/N − volume)². In any dimension d ≥ 1, by T. T. Warnock's formula ("Computational investigations
/// of low discrepancy point sets", 1972):
///   L2*² = 3⁻ᵈ − (2¹⁻ᵈ/N) Σ_i Π_k (1 − x_ik²) + (1/N²) Σ_i Σ_j Π_k (1 − max(x_ik, x_jk)).
///
/// Its three parts cancel to a 1/N²-th of themselves for good points, so they are computed and summed as pairs of
/// binary64 (106 bits): the root is right to about 1e-15 of itself up to N = 2²⁰. O(N log N) in one and two dimensions
/// (S. Heinrich, "Efficient algorithms for computing the L2-discrepancy", Math. Comp. 65, 1996, has the general idea;
/// in two dimensions a Fenwick tree does), O(N² d) in more.
double l2_star_discrepancy(const PointSet& points);

}  // namespace halfslope
