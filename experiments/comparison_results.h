// Which estimators and samplers of a run can be told apart.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/comparison.h"

namespace halfslope {

struct CellResult;

/// One row of comparisons.csv.
struct ComparedCells {
  std::size_t a, b;  ///< indices into the results' cells
  Comparison comparison;
};

/// The comparisons of one scene, precision and N: the family over which a false alarm has a probability of 5 %.
struct ComparisonFamily {
  std::vector<std::size_t> cells;   ///< indices into the results' cells
  std::vector<ComparedCells> rows;  ///< by a, then b
  bool with_first_only = false;     ///< too many for all pairs
};

/// More comparisons than this in a family, or more than a million times replicates, and each cell is compared with the
/// first of its line alone: the first sampler of its estimator, and the first estimator of its sampler. (With the best
/// would not do: who is best is known from the same errors, and the 5 % would not hold.)
inline constexpr std::size_t kMostComparisons = 2000;
inline constexpr std::size_t kMostComparedReplicates = 1000000;

/// Within each scene, precision and N: every two samplers of one estimator, and every two estimators on one sampler.
/// Families in the order of their first cells. The marks `infinite-variance` (refused) and `heavy-tailed` are the
/// cells' own. Throws Error(kInterrupted) if a signal comes meanwhile. The numbers do not depend on `threads`.
std::vector<ComparisonFamily> compare_cells(const std::vector<CellResult>& cells, int threads);

}  // namespace halfslope
