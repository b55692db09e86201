// The largest empty circle, by Voronoi cells that are cut only as far as they can matter.
//
// The distance to the nearest point is largest at a corner of some Voronoi cell (cells cut off at the square's edges).
// For each point, a polygon holds its cell at first with room to spare and is cut with the bisectors of a few near
// points. Then its corner v farthest from the point is asked for the point nearest to it: that distance is a lower
// bound of the dispersion; if the nearest is another point, its bisector cuts v off. The polygon is done once no corner
// is farther from its point than the largest distance found so far: most are at once.
//
// Why rounding does no harm, whatever the points: each bisector stands kSpare farther out than it should, which is more
// than rounding can move it. So every place of the square stays in the polygon of the point nearest to it, and no place
// can be farther from its nearest point than the farthest corner: the largest distance found plus kEnough. And that
// distance is one at a place of the square, not a circumradius of points that may lie on a line.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "analysis/neighbours.h"
#include "analysis/spacing.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

constexpr double kSpare = 0x1p-48, kEnough = 0x1p-46;
constexpr std::size_t kFirstCuts = 8;  // 6 neighbours is the mean

/// A place or a step.
struct Step {
  double x, y;
};
double length(Step a) { return std::hypot(a.x, a.y); }
double squared_length(Step a) { return a.x * a.x + a.y * a.y; }

/// A convex polygon around the origin.
class Polygon {
 public:
  void reset(double left, double right, double bottom, double top) {
    corners_ = {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
  }

  Step farthest() const { return *std::ranges::max_element(corners_, {}, squared_length); }

  /// Keeps what is nearer to the origin than to `other`, and kSpare beyond. Nothing where `other` is the origin.
  void cut(Step other) {
    const double distance = length(other);
    if (!(distance > 0)) return;
    const Step normal = {other.x / distance, other.y / distance};
    const auto beyond = [&](Step a) { return a.x * normal.x + a.y * normal.y - (distance / 2 + kSpare); };
    kept_.clear();
    Step last = corners_.back();
    double last_beyond = beyond(last);
    for (const Step corner : corners_) {
      const double corner_beyond = beyond(corner);
      if ((corner_beyond > 0) != (last_beyond > 0)) {
        const double t = last_beyond / (last_beyond - corner_beyond);
        kept_.push_back({last.x + t * (corner.x - last.x), last.y + t * (corner.y - last.y)});
      }
      if (!(corner_beyond > 0)) kept_.push_back(corner);
      last = corner, last_beyond = corner_beyond;
    }
    std::swap(corners_, kept_);
  }

 private:
  std::vector<Step> corners_, kept_;
};

/// The points without those that are equal, on the torus 1 being 0: a search goes through all points of one place.
std::array<std::vector<double>, 2> distinct(const PointSet& points, Space space) {
  std::vector<std::pair<double, double>> pairs;
  const auto wrapped = [&](double x) { return space == Space::kTorus && x == 1 ? 0 : x; };
  for (std::size_t i = 0; i < points.count(); ++i)
    pairs.emplace_back(wrapped(points.column(0)[i]), wrapped(points.column(1)[i]));
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::array<std::vector<double>, 2> columns;
  for (const auto& [x, y] : pairs) columns[0].push_back(x), columns[1].push_back(y);
  return columns;
}

class LargestHole {
 public:
  LargestHole(std::span<const double> x, std::span<const double> y, Space space)
      : x_(x), y_(y), space_(space), search_(PointSet({x, y}), space) {}

  double radius() {
    for (std::uint32_t point = 0; point < x_.size(); ++point) look_around(point);
    return largest_;
  }

 private:
  /// From `point` to `other`; on the torus to that one of its images that is nearest to `place`, a step from `point`.
  Step step(std::uint32_t point, std::uint32_t other, Step place) const {
    const Step step = {x_[other] - x_[point], y_[other] - y_[point]};
    if (space_ == Space::kCube) return step;
    return {step.x - std::rint(step.x - place.x), step.y - std::rint(step.y - place.y)};
  }

  void look_around(std::uint32_t point) {
    const double x = x_[point], y = y_[point];
    if (space_ == Space::kTorus) {
      cell_.reset(-0.5, 0.5, -0.5, 0.5);  // beyond, the point's own images are nearer
    } else {
      cell_.reset(-x, 1 - x, -y, 1 - y);
    }
    std::array<Neighbour, kFirstCuts> near;
    const std::size_t found = search_.nearest(std::array{x, y}, near, point);
    for (std::size_t k = 0; k < found; ++k) cell_.cut(step(point, near[k].point, {0, 0}));
    for (;;) {
      const Step corner = cell_.farthest();
      const double bound = length(corner) - kEnough;
      if (bound <= largest_) return;
      Neighbour nearest = {};
      search_.nearest(std::array{inside(x + corner.x), inside(y + corner.y)}, {&nearest, 1});
      largest_ = std::max(largest_, std::sqrt(nearest.squared_distance));
      if (bound <= largest_) return;
      cell_.cut(step(point, nearest.point, corner));
    }
  }

  double inside(double coordinate) const {
    if (space_ == Space::kTorus) coordinate -= std::floor(coordinate);
    return std::clamp(coordinate, 0.0, 1.0);
  }

  std::span<const double> x_, y_;
  Space space_;
  NeighbourSearch search_;
  Polygon cell_;
  double largest_ = 0;
};

double largest_hole(const PointSet& points, Space space) {
  assert_equal(points.dims(), 2u, "dimensions of the dispersion");
  const auto [x, y] = distinct(points, space);
  return LargestHole(x, y, space).radius();
}

}  // namespace

double dispersion(const PointSet& points) { return largest_hole(points, Space::kCube); }
double dispersion_toroidal(const PointSet& points) { return largest_hole(points, Space::kTorus); }

}  // namespace halfslope
