// How often comparisons find what is there, and what is not.
#pragma once

#include <string>
#include <vector>

#include "analysis/coverage.h"
#include "analysis/error_laws.h"

namespace halfslope {

/// Cells of one table: the first is compared with each of the others. Every error is √(1 − s²) times one of the cell's
/// own law, brought to mean square 1, and s times a normal number that all cells have in common, as common samples do;
/// so all mean squared errors are `pixels`' mean of 1, whatever the shapes.
struct ComparedFamily {
  std::string name;
  std::vector<ErrorLaw> laws;  ///< of the cells
  double shared = 0;           ///< s, in [0, 1)
  int pixels = 1;              ///< of an image, with independent errors
};

/// Two rows: the coverage of the intervals of the ratios, over runs × comparisons; and, as `covered`, the runs of the
/// family in which no two cells were told apart. Empty where it was stopped.
std::vector<CoverageRow> measure_alarms(const ComparedFamily& family, std::int64_t replicates,
                                        const CoverageRequest& request, double share = 1);

/// Makes the last cell's mean squared error 10 % larger. `covered` counts the runs of `replicates` in which it was told
/// from the first, and what is promised is the mean over the runs of the power that an independent pilot of 256
/// replicates predicts, ± 4 percentage points.
std::vector<CoverageRow> measure_power(const ComparedFamily& family, std::int64_t replicates,
                                       const CoverageRequest& request, double share = 1);

/// Families of 10 comparisons of like and unlike shapes, apart and on common samples, with 64 replicates of single
/// integrals and 16 of images; promised is that at most 7.5 % of them give an alarm. And differences of 10 %.
std::vector<CoverageRow> comparison_coverage(const CoverageRequest& request);

}  // namespace halfslope
