// The quadratic discrepancies in two dimensions, in integers.
#pragma once

#include "analysis/quadratic_discrepancy.h"

namespace halfslope {

/// The most points that plane_sums takes: its integers would overflow.
inline constexpr std::size_t kPlanePoints = std::size_t{1} << 26;
inline constexpr std::size_t kPlaneBytes = 132;

/// N² (D² − C²) of points in two dimensions, for the kernel as it is taken: −2N Σ f f + ΣΣ k k. The sums are of
/// integers and exact but for squares of coordinates, cut to 2⁻⁹⁶, and the result has 106 bits. Coordinates count as
/// the nearest multiples of 2⁻⁶¹, which all binary64 from 2⁻⁹ on are. O(N log N) time; at most 2²⁶ points, 120 bytes
/// each.
DoubleDouble plane_sums(const PointSet& points, const QuadraticKernel& kernel);

}  // namespace halfslope
