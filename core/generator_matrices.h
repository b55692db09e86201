// What makes a digital net: one matrix of digits a dimension.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halfslope {

/// Matrices that turn the digits of an index into those of a point: entry(dim, row, column) is what digit `column` of
/// the index (0 the lowest) counts in digit `row` of coordinate `dim` (0 the first after the point), and the sums are
/// modulo `base` (H. Niederreiter, "Random Number Generation and Quasi-Monte Carlo Methods", 1992, section 4.3).
/// Square, of `digits` rows and columns.
struct GeneratorMatrices {
  std::uint32_t base = 2;
  int dims = 0, digits = 0;
  std::vector<std::uint32_t> entries;  ///< [dim][row][column], each below base

  std::uint32_t entry(int dim, int row, int column) const {
    const auto at = [](int k) { return static_cast<std::size_t>(k); };
    return entries[(at(dim) * at(digits) + at(row)) * at(digits) + at(column)];
  }
};

}  // namespace halfslope
