// The rates that theorems promise: the exponent of N in the RMSE, logarithms aside.
#pragma once

#include <optional>

#include "core/layout.h"
#include "core/regularity.h"

namespace halfslope {

// Each takes the integrand's class and the layout of the points, and gives nothing where no theorem is known. A rate of
// −½ is also that of any square-integrable function that is not a sum of functions of what the points stratify.

/// Independent points: σ/√N.
std::optional<double> monte_carlo_rate(Regularity regularity, const Layout& layout);

/// One uniform point in each cell of a grid of N^(1/d) cells a side, independently: the cells that a surface cuts are
/// N^(1−1/d), each with a variance of order N^−2, and elsewhere a cell's variance is that of a linear function. S.
/// Haber, "A modified Monte-Carlo quadrature", Math. Comp. 20 (1966).
std::optional<double> grid_rate(Regularity regularity, const Layout& layout);

/// The same in every group of dimensions by itself, groups shuffled.
std::optional<double> grouped_grid_rate(Regularity regularity, const Layout& layout);

/// N strata in every dimension, shuffled independently: only sums of functions of one coordinate gain. M. Stein, "Large
/// sample properties of simulations using Latin hypercube sampling", Technometrics 29 (1987).
std::optional<double> latin_rate(Regularity regularity, const Layout& layout);

/// Pairs whose coordinates are stratified as in a Latin hypercube, shuffled between groups. How the points of one pair
/// depend on each other is no theorem's.
std::optional<double> stratified_pairs_rate(Regularity regularity, const Layout& layout);

/// Low discrepancy, (log N)^d/N, by the Koksma-Hlawka inequality: H. Niederreiter, "Random number generation and
/// quasi-Monte Carlo methods" (1992), theorem 2.11. Shifts modulo 1 and digital shifts leave it.
std::optional<double> low_discrepancy_rate(Regularity regularity, const Layout& layout);

/// The same for points whose scrambling may do better for functions of one coordinate, by a rate that depends on which.
std::optional<double> scrambled_sequence_rate(Regularity regularity, const Layout& layout);

/// Nested scrambling of a digital net: N^(−3/2) (log N)^((d−1)/2) where the mixed derivative is square-integrable; A.
/// B. Owen, "Scrambled net variance for integrals of smooth functions", Ann. Statist. 25 (1997). Across a jump the net
/// has a bounded multiple of the variance of one point in each of N cubical cells, since the gain coefficients of all
/// coarser functions are 0: N^(−½−1/(2d)).
std::optional<double> scrambled_net_rate(Regularity regularity, const Layout& layout);

/// Scrambled points that are a net in base 2 up to two dimensions, and beyond in bases whose powers an N of 2^m is not.
std::optional<double> scrambled_plane_rate(Regularity regularity, const Layout& layout);

/// A shifted lattice folded by the tent: N^−2. F. J. Hickernell, "Obtaining O(N^(−2+ε)) convergence for lattice
/// quadrature rules", MCQMC 2000.
std::optional<double> folded_lattice_rate(Regularity regularity, const Layout& layout);

/// Multiples of a badly approximable number, which in one dimension the golden section is: as low discrepancy. In more
/// it is not known whether the powers are.
std::optional<double> kronecker_rate(Regularity regularity, const Layout& layout);

/// The midpoint rule of a grid: N^(−2/d).
std::optional<double> midpoint_rate(Regularity regularity, const Layout& layout);

}  // namespace halfslope
