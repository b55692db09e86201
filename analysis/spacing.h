// How far apart points are, and how large the holes between them.
#pragma once

#include "analysis/discrepancy.h"

namespace halfslope {

/// The smallest distance between two of N ≥ 2 points, in any dimension; 0 where two are equal. In the cube, or on the
/// torus, where a coordinate's difference is min(|x − y|, 1 − |x − y|). A relative error of some 2⁻⁵², short of
/// underflow: distances below 1e-150 may read 0.
///
/// O(N log N) by a k-d tree in up to 6 dimensions (with a factor that grows with the dimension), O(N² d) in more.
double min_distance(const PointSet& points);
double min_distance_toroidal(const PointSet& points);

/// The mean over N ≥ 2 points of the distance to the nearest other one. As above.
double mean_nn_distance(const PointSet& points);
double mean_nn_distance_toroidal(const PointSet& points);

/// Dimensions in which the densest packing of balls is proven and holds on the unit torus too: 1, 2 and 3.
inline constexpr std::size_t kMostPackedDims = 3;

/// The toroidal minimum distance as a share of the largest that N ≥ 2 points could have if their balls filled the torus
/// as densely as any packing fills space, in 1 to 3 dimensions (any other number aborts). With radii (half distances),
/// A. Lagae, P. Dutré, "A comparison of methods for generating Poisson disk distributions", Computer Graphics Forum
/// 27(1), 2008, section 2: ρ = r/r_max, r_max = √(1/(2√3 N)) in two dimensions, so the distance is over √(2/(√3 N)). In
/// three, Kepler's packing: the distance over (√2/N)^(1/3); in one, over 1/N. In [0, 1] but for rounding.
double relative_radius(const PointSet& points);

/// The dispersion of two-dimensional points: the radius of the largest circle with its centre in the closed unit square
/// and no point inside, sup over q in [0, 1]² of the distance from q to the nearest point (H. Niederreiter, "Random
/// Number Generation and Quasi-Monte Carlo Methods", 1992, definition 6.2). The circle may reach beyond the square. On
/// the torus: the covering radius of the points and their images. Right to 2e-14, whatever the points, equal ones
/// included; about O(N log N). dispersion.cpp says how.
double dispersion(const PointSet& points);
double dispersion_toroidal(const PointSet& points);

}  // namespace halfslope
