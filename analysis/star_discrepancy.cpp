// The star discrepancy, exact.
#include <algorithm>
#include <cmath>

#include "analysis/discrepancy.h"
#include "analysis/kinetic_tree.h"
#include "analysis/ranks.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

double star_discrepancy_1d(std::span<const double> x) {
  std::vector<double> sorted(x.begin(), x.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  double farthest = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    farthest = std::max(farthest, std::abs(sorted[i] - (2 * static_cast<double>(i) + 1) / (2 * n)));
  }
  return 1 / (2 * n) + farthest;
}

/// A box [0, x] × [0, y] and the points in it.
double excess(const KineticTree::Line& line, double x, double n) {
  return static_cast<double>(line.c) / n - x * line.y;
}

// The worst box ends at a coordinate of some point, or at 1, in both directions: a box with too many points shrinks
// onto them, one with too few grows until it would take in another. So with c(x, y) the points ≤ (x, y) and c°(x, y)
// those < (x, y), D* is the larger of
//   max c(x, y)/N − x y   over x of {x_i}, y of {y_i},
//   max x y − c°(x, y)/N  over x of {x_i} ∪ {1}, y of {y_i} ∪ {1}.
// x sweeps over its values in ascending order. At each, c(x, y_j) − N x y_j is a line in x for every j, raised by one
// for all y_j ≥ y_i (of c°: y_j > y_i) by each point that the sweep passes; the tree knows the largest, or the
// smallest.
double largest_excess(const RankedColumn& x, const RankedColumn& y, double n) {
  KineticTree lines(y.values, n, KineticTree::Winner::kLargest);
  double worst = 0;
  for (std::size_t k = 0, i = 0; k < x.values.size(); ++k) {
    lines.advance(x.values[k]);
    for (; i < x.order.size() && x.rank[x.order[i]] == k; ++i) lines.raise_from(y.rank[x.order[i]]);
    worst = std::max(worst, excess(lines.winner(), x.values[k], n));
  }
  return worst;
}

double largest_deficit(const RankedColumn& x, const RankedColumn& y, double n) {
  std::vector<double> ends = y.values;
  if (ends.back() < 1) ends.push_back(1);
  KineticTree lines(ends, n, KineticTree::Winner::kSmallest);
  double worst = 0;
  for (std::size_t k = 0, i = 0; k < x.values.size(); ++k) {
    lines.advance(x.values[k]);
    worst = std::max(worst, -excess(lines.winner(), x.values[k], n));
    for (; i < x.order.size() && x.rank[x.order[i]] == k; ++i) lines.raise_from(y.rank[x.order[i]] + 1);
  }
  if (x.values.back() < 1) {
    lines.advance(1);
    worst = std::max(worst, -excess(lines.winner(), 1, n));
  }
  return worst;
}

}  // namespace

double star_discrepancy(const PointSet& points) {
  if (points.dims() == 1) return star_discrepancy_1d(points.column(0));
  assert_equal(points.dims(), 2u, "dimensions of the star discrepancy");
  const RankedColumn x(points.column(0)), y(points.column(1));
  const auto n = static_cast<double>(points.count());
  return std::max(largest_excess(x, y, n), largest_deficit(x, y, n));
}

}  // namespace halfslope
