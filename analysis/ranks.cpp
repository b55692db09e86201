#include "analysis/ranks.h"

#include <algorithm>
#include <utility>

namespace halfslope {

RankedColumn::RankedColumn(std::span<const double> coordinates) : order(coordinates.size()), rank(coordinates.size()) {
  std::vector<std::pair<double, std::uint32_t>> sorted(coordinates.size());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) sorted[i] = {coordinates[i], i};
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const auto& [coordinate, point] = sorted[k];
    if (k == 0 || coordinate != values.back()) values.push_back(coordinate);
    order[k] = point;
    rank[point] = static_cast<std::uint32_t>(values.size() - 1);
  }
}

}  // namespace halfslope
