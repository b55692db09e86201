// The discrepancies that are a double sum over the points: L2 norms of the local discrepancy, and the diaphony.
#pragma once

#include <cstddef>
#include <string>

#include "analysis/discrepancy.h"
#include "analysis/double_double.h"
#include "analysis/kernels.h"

namespace halfslope {

/// A quadratic discrepancy of N points of [0,1]^d is the root of
///   D² = C^d − (2/N) Σ_i Π_k f(x_ik) + (1/N²) Σ_i Σ_j Π_k k(x_ik, x_jk),   f(x) = ∫ k(x, y) dy,   C = ∫ f(x) dx,
/// over a norm: the worst error that equal weights make on the unit ball of the space of functions that Πk reproduces
/// (F. J. Hickernell, "A generalized discrepancy and quadrature error bound", Math. Comp. 67, 1998). In all those that
/// halfslope has, with z = x − ½ and z' = y − ½,
///   k(x, y) = g(z) + g(z') + h z z' − c |z − z'|,   g(z) = g0 + g1 z + g2 |z| + g3 z²,
/// so that f(z) = g(z) + ḡ − c (z² + ¼) and C = 2ḡ − c/3 with ḡ = g0 + g2/4 + g3/12.
struct QuadraticKernel {
  QuadraticForm form;
  DoubleDouble g0;
  double g1, g2, g3, h, c;
  int doublings;            ///< k is 2^doublings times its definition's: many dimensions' products stay in range
  bool normalised = false;  ///< D² is over that of a single point, k(0, 0)^d − C^d: the diaphony

  /// ḡ and C.
  DoubleDouble mean_g() const { return g0 + DoubleDouble{g2 / 4, 0} + DoubleDouble{g3, 0} / 12.0; }
  DoubleDouble mean() const { return mean_g() * 2.0 - DoubleDouble{c, 0} / 3.0; }
};

extern const QuadraticKernel kL2Star, kExtremeL2, kSymmetricL2, kCenteredL2, kWraparoundL2, kPeriodicL2, kMixtureL2,
    kDiaphony;

/// The most dimensions that the functions here take: beyond, products of kernels leave binary64's range.
inline constexpr std::size_t kQuadraticDims = 1024;
/// Beyond these the extreme discrepancy itself, of the size of 6^(−d/2), may be too small for binary64, and come out 0.
inline constexpr std::size_t kExtremeDims = 512;

/// D, not squared. All printed digits are right: a few units of 10⁻¹⁶ of itself up to N = 2²⁰, however much its three
/// parts cancel. One dimension: a sum of squares of which nothing cancels, O(N log N). Two: exact integers, O(N log N)
/// time, 132 N bytes. More: pairs of binary64 on packets, O(d N²). More than 2²⁶ points in two dimensions, or more than
/// kQuadraticDims dimensions, abort. The bits do not depend on the class of instruction set in one and two dimensions.
double quadratic_discrepancy(const PointSet& points, const QuadraticKernel& kernel);

/// Why it will not measure so many points: the time of more than 10¹² kernels, or memory that this machine does not
/// have; empty where it will.
std::string quadratic_discrepancy_refusal(std::size_t count, std::size_t dims);

/// The same in O(d N²) whatever d is: what the faster ways for one and two dimensions are checked against.
double quadratic_discrepancy_by_pairs(const PointSet& points, const QuadraticKernel& kernel);

/// E[D²] · N for N independent uniform points: E k(x, x)^d − C^d over the norm. D² itself is this over N on average.
double quadratic_discrepancy_variance(std::size_t dims, const QuadraticKernel& kernel);

/// The measures by name, each the root of its D²; l2_star_discrepancy is in analysis/discrepancy.h.
/// Boxes from each place of the cube to its nearest corner: F. J. Hickernell, 1998.
double centered_l2_discrepancy(const PointSet& points);
/// Boxes that may go round the torus: F. J. Hickernell, "Lattice rules: how well do they measure up?", 1998.
double wraparound_l2_discrepancy(const PointSet& points);
/// Y.-D. Zhou, K.-T. Fang, J.-H. Ning, "Mixture discrepancy for quasi-random point sets", J. Complexity 29, 2013.
double mixture_l2_discrepancy(const PointSet& points);
/// Unions of boxes at corners of even parity: F. J. Hickernell, 1998.
double symmetric_l2_discrepancy(const PointSet& points);
/// All axis-parallel boxes of the cube: W. J. Morokoff, R. E. Caflisch, "Quasi-random sequences and their
/// discrepancies", SIAM J. Sci. Comput. 15, 1994.
double extreme_l2_discrepancy(const PointSet& points);
/// All boxes of the torus, without wrap-around's projections: A. Hinrichs, R. Kritzinger, F. Pillichshammer,
/// "Extreme and periodic L2 discrepancy of plane point sets", Acta Arith. 199, 2021.
double periodic_l2_discrepancy(const PointSet& points);
/// P. Zinterhof, "Über einige Abschätzungen bei der Approximation von Funktionen mit Gleichverteilungsmethoden", 1976,
/// with the norm for which a single point has 1.
double diaphony(const PointSet& points);

}  // namespace halfslope
