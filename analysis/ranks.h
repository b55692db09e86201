// Which coordinates there are, and where each point's stands among them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace halfslope {

/// One dimension of a point set, sorted; at most 2³² points.
struct RankedColumn {
  explicit RankedColumn(std::span<const double> coordinates);

  std::vector<double> values;        ///< the different coordinates, ascending
  std::vector<std::uint32_t> order;  ///< the points by coordinate, ascending; of equal ones the earlier first
  std::vector<std::uint32_t> rank;   ///< of each point: values[rank[i]] is its coordinate
};

}  // namespace halfslope
