#pragma once

#include <cstdint>
#include <vector>

#include "samplers/torus.h"

namespace halfslope {

/// Removes points of a set on the torus until `count` are left, each time the one with the most weight of neighbours
/// within twice the radius of the densest packing of `count` discs (C. Yuksel, "Sample elimination for generating
/// Poisson disk sample sets", 2015, with its α = 8, β = 0.65, γ = 1.5). Keeps its scratch memory between calls.
///
/// Weights are integers, so that their sums do not depend on the order in which neighbours come and go.
class SampleElimination {
 public:
  /// The indices of the points that stay, ascending. 1 ≤ count ≤ points.size() < 2³².
  const std::vector<std::uint32_t>& keep(const std::vector<TorusPoint>& points, std::uint32_t count);

 private:
  void sort_into_cells(const std::vector<TorusPoint>& points);
  void weigh();
  /// Calls visit(neighbour, squared distance) for the points within reach of `point`, the removed ones too.
  template <class Visit>
  void for_neighbours(std::uint32_t point, Visit visit) const;
  std::uint64_t weight(std::uint64_t squared_distance) const;
  void sift_down(std::uint32_t place);
  void put(std::uint32_t place, std::uint32_t point) { heap_[place] = point, places_[point] = place; }

  std::uint32_t side_ = 1;  ///< cells along an axis, each at least as wide as the reach; 1 if there were fewer than 3
  double inverse_reach_ = 0, least_ = 0;  ///< 2⁻³² / (2 r_max); r_min / r_max
  std::uint64_t squared_reach_ = 0;
  std::vector<TorusPoint> points_;                        // by cell, and so is all that follows
  std::vector<std::uint32_t> original_, cells_, starts_;  // caller's index, cell, where each cell starts
  std::vector<std::uint64_t> weights_;
  std::vector<std::uint32_t> heap_, places_;  // the heaviest first; a removed point has no place
  std::vector<std::uint32_t> kept_;
};

}  // namespace halfslope
