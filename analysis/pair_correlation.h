// How often points lie at a distance from each other, against points thrown at random.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/discrepancy.h"

namespace halfslope {

/// Equal bins of the distance r: bin k is [k, k + 1) · most/bins.
struct DistanceBins {
  int bins;     ///< at least 1
  double most;  ///< in (0, 1/2]: larger balls would meet themselves around the torus

  double edge(int k) const { return k * most / bins; }
  double centre(int k) const { return (2 * k + 1) * most / (2 * bins); }
};

/// How far a pair correlation is looked at if nothing is said: ten mean distances, but at most half the torus,
/// min(1/2, 10/N^(1/d)).
double usual_most_distance(std::size_t count, std::size_t dims);

/// The volume of a ball of radius r in d ≥ 1 dimensions, π^(d/2) r^d/Γ(d/2 + 1).
double ball_volume(std::size_t dims, double radius);

/// The pairs of points whose distance on the torus lies in each bin; N(N − 1)/2 is all there are.
std::vector<std::uint64_t> pairs_by_distance(const PointSet& points, const DistanceBins& bins);

/// The pair correlation g of each bin: pairs observed over pairs expected of N ≥ 2 points that are independent and
/// uniform on the torus, N(N − 1)/2 times the volume between the bin's two spheres. For such points each g has exactly
/// the expectation 1, bin by bin, in every dimension: nothing is smoothed, no border is corrected for, and pairs are
/// counted with N(N − 1), not N². g is 0 at distances that never occur. Equal points are pairs at distance 0.
///
/// The points are sorted into strips as wide as `most`, so that about N² · 3 most² pairs are looked at, N² at most.
/// D. Stoyan, W. S. Kendall, J. Mecke, "Stochastic Geometry and its Applications", 1995, section 4.5.
std::vector<double> pair_correlation(const PointSet& points, const DistanceBins& bins);

}  // namespace halfslope
