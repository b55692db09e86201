// The star discrepancy in any dimension: exact where it can be had, otherwise what it lies between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "analysis/discrepancy.h"

namespace halfslope {

struct StarBounds {
  double lower = 0;  ///< the excess of an actual box
  double upper = 1;
  bool exact = false;  ///< then both are the same number, right to 1e-13
};

/// Looks at points: as many as one core takes in 3 or 4 s, or in 15 s where the points outgrow its cache (N d > 2^20).
constexpr std::uint64_t kStarWork = std::uint64_t{1} << 30;

/// D* of star_discrepancy(), for any number of dimensions, in a fixed amount of work, so that the same points always
/// give the same bits.
///
/// One and two dimensions: exact, by star_discrepancy(). 3 to 32: by branch and bound (box_search.h), exact where that
/// ends within `work`; the lower bound is then that of a box found by threshold accepting (threshold_accepting.h) or on
/// the way, and the upper one a threshold over which the search found that there is no box, as low as `work` allows.
/// More than 32: by threshold accepting, and the upper bound is 1.
StarBounds star_bounds(const PointSet& points, std::uint64_t work = kStarWork);

/// "exact", or how the bounds were found.
std::string_view star_method(const StarBounds& bounds);

/// Why so many points are not measured: too many for their memory, which it states. Empty where they are.
std::string star_refusal(std::size_t count, std::size_t dims);

}  // namespace halfslope
