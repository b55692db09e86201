// The star discrepancy, exact.
#include <algorithm>
#include <cmath>

#include "analysis/box_sweep.h"
#include "analysis/discrepancy.h"
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

// The worst box ends at a coordinate of some point, or at 1, in both directions: a box with too many points shrinks
// onto them, one with too few grows until it would take in another. So with c(x, y) the points ≤ (x, y) and c°(x, y)
// those < (x, y), D* is the larger of the maxima over x of {x_i} ∪ {1} and y of {y_i} ∪ {1} of
//   c(x, y)/N − x y  and  x y − c°(x, y)/N.
// x sweeps over its values in ascending order; BoxSweep knows the best y for each.
double star_discrepancy_2d(const RankedColumn& x, const RankedColumn& y) {
  const auto n = static_cast<double>(x.order.size());
  BoxSweep boxes(y.values, x.order.size());
  double worst = 0;
  const auto consider = [&](const BoxSweep::Box& box, double width, int sign) {
    worst = std::max(worst, sign * (static_cast<double>(box.points) / n - width * box.height));
  };
  const bool below_1 = y.values.back() < 1;  // a box of height 1 is another, which holds all points so far
  std::size_t added = 0;
  const auto consider_emptiest = [&](double width) {
    consider(boxes.emptiest(), width, -1);
    if (below_1) consider({static_cast<std::int64_t>(added), 1}, width, -1);
  };
  for (std::size_t k = 0; k < x.values.size(); ++k) {
    const double width = x.values[k];
    boxes.grow(width);
    consider_emptiest(width);
    for (; added < x.order.size() && x.rank[x.order[added]] == k; ++added) boxes.add_point(y.rank[x.order[added]]);
    consider(boxes.fullest(), width, 1);
  }
  if (x.values.back() < 1) {
    boxes.grow(1);
    consider_emptiest(1);
  }
  return worst;
}

}  // namespace

double star_discrepancy(const PointSet& points) {
  if (points.dims() == 1) return star_discrepancy_1d(points.column(0));
  assert_equal(points.dims(), 2u, "dimensions of the star discrepancy");
  return star_discrepancy_2d(RankedColumn(points.column(0)), RankedColumn(points.column(1)));
}

}  // namespace halfslope
