// One sample at a time, of a technique chosen at random: Veach's one-sample model.
//
// A sample is of technique i with probability c_i (E. Veach, "Robust Monte Carlo methods for light transport
// simulation", 1997, section 9.2.4), and
//
//   F = w_i(x) f(x) / (c_i p_i(x)),
//
// unbiased under the conditions of the multi-sample estimator (estimators/heuristics.h), whose weights serve here as
// they are: with c_i ∝ counts_i the ratios c_k p_k / max_l c_l p_l are the same.
//
// The first dimension of a point chooses; the others are shared, since only one technique reads them. A technique's
// points are then a slab of the point set, cut across the choice: a set that is well distributed in all dimensions
// together is so in the slab. With dimensions of their own the techniques would need more of them, of which each sample
// leaves some unread, and good points are best in their first few.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/integral.h"
#include "core/layout.h"
#include "estimators/estimator.h"

namespace halfslope {

struct SharedLayout {
  Layout layout;                ///< the choice's 1-D group, then the techniques'
  std::vector<int> first_dims;  ///< where each technique's dimensions begin
};

/// Lays the techniques over one another: one whose groups are a run of those there already takes them, so that a pair
/// stays a pair; another's are added at the end. The longest layout comes first.
SharedLayout shared_layout(std::span<const int> techniques, std::span<const Technique> catalogue);

/// Draws the samples of a one-sample allocation. Holds a thread's buffers.
template <class T>
class OneSample {
 public:
  OneSample(const Allocation& allocation, std::span<const Technique> catalogue);

  /// `terms` has a slot for each technique; at each point that of the chosen one receives its term, and all others 0.
  /// Each technique is evaluated at its own points alone.
  void sample(const Integral& integral, const PointBlock& points, TermBlock<T>& terms);

 private:
  void choose(const PointBlock& points);
  void gather(const PointBlock& points, std::size_t k);
  void scatter(TermBlock<T>& terms, std::size_t k);

  std::vector<int> techniques_, first_dims_, dims_;
  std::vector<std::size_t> slots_;                  ///< of each of Σ counts equal parts of the choice
  std::vector<std::vector<std::uint32_t>> chosen_;  ///< each slot's points
  PointBlock points_;
  TermBlock<T> terms_;
};

extern template class OneSample<float>;
extern template class OneSample<double>;

}  // namespace halfslope
