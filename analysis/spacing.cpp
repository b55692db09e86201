#include "analysis/spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/compensated_sum.h"
#include "analysis/neighbours.h"
#include "analysis/ranks.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

// In the order of the first coordinate: consecutive searches then go through memory that the last ones have fetched.
std::vector<double> squares_by_tree(const PointSet& unsorted, Space space) {
  const RankedColumn first(unsorted.column(0));
  std::vector<std::vector<double>> columns(unsorted.dims());
  for (std::size_t k = 0; k < unsorted.dims(); ++k) {
    for (const std::uint32_t i : first.order) columns[k].push_back(unsorted.column(k)[i]);
  }
  const PointSet points({columns.begin(), columns.end()});
  const NeighbourSearch search(points, space);
  std::vector<double> squares(points.count()), position(points.dims());
  for (std::size_t i = 0; i < points.count(); ++i) {
    for (std::size_t k = 0; k < points.dims(); ++k) position[k] = columns[k][i];
    Neighbour nearest = {};
    search.nearest(position, {&nearest, 1}, static_cast<std::uint32_t>(i));
    // Anew from the coordinates: an image of the position, moved by 1, is rounded.
    squares[i] = squared_distance(points, i, nearest.point, space);
  }
  return squares;
}

std::vector<double> squares_by_pairs(const PointSet& points, Space space) {
  std::vector<double> squares(points.count(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 1; i < points.count(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double square = squared_distance(points, i, j, space);
      squares[i] = std::min(squares[i], square);
      squares[j] = std::min(squares[j], square);
    }
  }
  return squares;
}

/// Of each point, in some order, the squared distance to the nearest other one.
std::vector<double> nearest_squares(const PointSet& points, Space space) {
  assert_equal(points.count() >= 2, true, "a distance between points needs two");
  return points.dims() <= NeighbourSearch::kMostDims ? squares_by_tree(points, space) : squares_by_pairs(points, space);
}

double smallest(const PointSet& points, Space space) {
  const std::vector<double> squares = nearest_squares(points, space);
  return std::sqrt(*std::min_element(squares.begin(), squares.end()));
}

double mean(const PointSet& points, Space space) {
  CompensatedSum sum;
  for (const double square : nearest_squares(points, space)) sum.add(std::sqrt(square));
  return sum.value() / static_cast<double>(points.count());
}

}  // namespace

double min_distance(const PointSet& points) { return smallest(points, Space::kCube); }
double min_distance_toroidal(const PointSet& points) { return smallest(points, Space::kTorus); }
double mean_nn_distance(const PointSet& points) { return mean(points, Space::kCube); }
double mean_nn_distance_toroidal(const PointSet& points) { return mean(points, Space::kTorus); }

double relative_radius(const PointSet& points) {
  assert_equal(points.dims() <= kMostPackedDims, true, "dimensions of a known densest packing");
  const auto n = static_cast<double>(points.count());
  double largest = 1 / n;
  if (points.dims() == 2) largest = std::sqrt(2 / (std::sqrt(3.0) * n));
  if (points.dims() == 3) largest = std::cbrt(std::sqrt(2.0) / n);
  return min_distance_toroidal(points) / largest;
}

}  // namespace halfslope
