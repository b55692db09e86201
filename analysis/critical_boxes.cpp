#include "analysis/critical_boxes.h"

#include <utility>

#include "analysis/ranks.h"

namespace halfslope {

CriticalBoxes::CriticalBoxes(const PointSet& points, Side which) : side(which) {
  for (std::size_t k = 0; k < points.dims(); ++k) {
    RankedColumn column(points.column(k));
    if (side == Side::kEmptiest) {
      // Open at a point's coordinate it leaves the point out: the next end has it, or none where that would be
      // beyond 1.
      for (std::uint32_t& rank : column.rank) ++rank;
      if (column.values.back() < 1) column.values.push_back(1);
    }
    ends.push_back(std::move(column.values));
    first.push_back(std::move(column.rank));
  }
}

double CriticalBoxes::volume(std::span<const std::uint32_t> box) const {
  double product = 1;
  for (std::size_t k = 0; k < box.size(); ++k) product *= ends[k][box[k]];
  return product;
}

double CriticalBoxes::excess(std::span<const std::uint32_t> box, std::size_t points) const {
  const double share = static_cast<double>(points) / static_cast<double>(count());
  return side == Side::kFullest ? share - volume(box) : volume(box) - share;
}

}  // namespace halfslope
