// The L2-star discrepancy by Warnock's formula, in 106 bits.
#include <algorithm>
#include <cmath>

#include "analysis/compensated_sum.h"
#include "analysis/discrepancy.h"
#include "analysis/double_double.h"
#include "analysis/ranks.h"

namespace halfslope {
namespace {

DoubleDouble one_minus(double x) { return DoubleDouble::sum(1, -x); }

// In one dimension nothing need cancel: with x sorted, L2*² = 1/(12N²) + (1/N) Σ (x_(i) − (2i − 1)/(2N))²
// (Niederreiter 1992, section 2.1). The differences are taken 2N times as large, where both terms are exact.
double squared_1d(std::span<const double> x) {
  std::vector<double> sorted(x.begin(), x.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  CompensatedSum squares;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const DoubleDouble middle = {2 * static_cast<double>(i) + 1, 0};
    const double difference = (DoubleDouble::product(2 * n, sorted[i]) - middle).value();
    squares.add(difference * difference);
  }
  return (1 + 3 * squares.value() / n) / (12 * n * n);
}

/// Points by the rank of one coordinate: how many there are at or below a rank, and the sum of 1 − y over those above.
class FenwickTree {
 public:
  explicit FenwickTree(std::size_t ranks) : nodes_(ranks + 1) {}

  void add(std::size_t rank, DoubleDouble one_minus_y) {
    total_ = total_ + one_minus_y;
    for (std::size_t k = rank + 1; k < nodes_.size(); k += k & (~k + 1)) {
      nodes_[k].sum = nodes_[k].sum + one_minus_y;
      ++nodes_[k].count;
    }
  }
  /// Σ (1 − max(y, y_j)) over the points j so far, y being of that rank.
  DoubleDouble sum_above(std::size_t rank, DoubleDouble one_minus_y) const {
    DoubleDouble sum;
    std::int64_t count = 0;
    for (std::size_t k = rank + 1; k > 0; k -= k & (~k + 1)) {
      sum = sum + nodes_[k].sum;
      count += nodes_[k].count;
    }
    return total_ - sum + one_minus_y * static_cast<double>(count);
  }

 private:
  struct Node {
    DoubleDouble sum;
    std::int64_t count = 0;
  };
  std::vector<Node> nodes_;
  DoubleDouble total_;
};

// With the points in ascending x, max(x_i, x_j) is x_i for all j before i, so that
//   Σ_i Σ_j (1 − max(x_i, x_j)) (1 − max(y_i, y_j)) = Σ_i (1 − x_i) (1 − y_i + 2 Σ_{j before i} (1 − max(y_i, y_j))).
DoubleDouble pair_sum_2d(const PointSet& points) {
  const RankedColumn x(points.column(0)), y(points.column(1));
  FenwickTree before(y.values.size());
  DoubleDouble sum;
  for (const std::uint32_t i : x.order) {
    const DoubleDouble one_minus_y = one_minus(points.column(1)[i]);
    sum = sum + one_minus(points.column(0)[i]) * (one_minus_y + before.sum_above(y.rank[i], one_minus_y) * 2.0);
    before.add(y.rank[i], one_minus_y);
  }
  return sum;
}

DoubleDouble pair_sum(const PointSet& points) {
  DoubleDouble sum;
  for (std::size_t i = 0; i < points.count(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      DoubleDouble product = {j < i ? 2.0 : 1.0, 0};
      for (std::size_t k = 0; k < points.dims(); ++k) {
        product = product * one_minus(std::max(points.column(k)[i], points.column(k)[j]));
      }
      sum = sum + product;
    }
  }
  return sum;
}

DoubleDouble single_sum(const PointSet& points) {
  DoubleDouble sum;
  for (std::size_t i = 0; i < points.count(); ++i) {
    DoubleDouble product = {1, 0};
    for (std::size_t k = 0; k < points.dims(); ++k) {
      const double x = points.column(k)[i];
      product = product * (DoubleDouble{1, 0} - DoubleDouble::product(x, x));
    }
    sum = sum + product;
  }
  return sum;
}

}  // namespace

double l2_star_discrepancy(const PointSet& points) {
  if (points.dims() == 1) return std::sqrt(squared_1d(points.column(0)));
  const auto n = static_cast<double>(points.count());
  DoubleDouble constant = {1, 0};
  for (std::size_t k = 0; k < points.dims(); ++k) constant = constant / 3.0;
  const DoubleDouble single = single_sum(points) * std::ldexp(1.0, 1 - static_cast<int>(points.dims())) / n;
  const DoubleDouble pairs = (points.dims() == 2 ? pair_sum_2d(points) : pair_sum(points)) / n / n;
  return std::sqrt((constant - single + pairs).value());
}

}  // namespace halfslope
