// The star discrepancy by its definition, for few points.
#pragma once

#include <algorithm>
#include <vector>

#include "tests/analysis/point_sets.h"

namespace halfslope {

/// Every box that ends at coordinates of points or at 1, open and closed, each point counted anew.
inline double critical_grid(const Columns& columns) {
  const std::size_t dims = columns.size(), count = columns[0].size();
  Columns ends = columns;
  for (auto& end : ends) end.push_back(1);
  std::vector<std::size_t> at(dims);
  double worst = 0;
  while (true) {
    double volume = 1;
    for (std::size_t k = 0; k < dims; ++k) volume *= ends[k][at[k]];
    int closed = 0, open = 0;
    for (std::size_t i = 0; i < count; ++i) {
      bool at_most = true, below = true;
      for (std::size_t k = 0; k < dims; ++k) {
        at_most = at_most && columns[k][i] <= ends[k][at[k]];
        below = below && columns[k][i] < ends[k][at[k]];
      }
      closed += at_most, open += below;
    }
    const auto n = static_cast<double>(count);
    worst = std::max({worst, closed / n - volume, volume - open / n});
    std::size_t k = 0;
    while (k < dims && ++at[k] == ends[k].size()) at[k++] = 0;
    if (k == dims) return worst;
  }
}

}  // namespace halfslope
