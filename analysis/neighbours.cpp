// The one file that includes nanoflann.
#include "analysis/neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <vector>

#include "core/assertion.h"

namespace halfslope {
namespace {

/// The points as nanoflann reads them, all coordinates of a point together.
struct Cloud {
  std::vector<double> coordinates;
  std::size_t dims;

  std::size_t kdtree_get_point_count() const { return coordinates.size() / dims; }
  double kdtree_get_pt(std::size_t point, std::size_t dim) const { return coordinates[point * dims + dim]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

Cloud cloud_of(const PointSet& points) {
  Cloud cloud = {std::vector<double>(points.count() * points.dims()), points.dims()};
  for (std::size_t k = 0; k < points.dims(); ++k) {
    for (std::size_t i = 0; i < points.count(); ++i) cloud.coordinates[i * points.dims() + k] = points.column(k)[i];
  }
  return cloud;
}

/// nanoflann's "result set", which outlives one search: each image of the torus goes on where the last one ended.
class Nearest {
 public:
  Nearest(std::span<Neighbour> found, std::uint32_t excluded) : found_(found), excluded_(excluded) {}

  std::size_t size() const { return size_; }
  bool full() const { return size_ == found_.size(); }
  double worstDist() const { return full() ? found_.back().squared_distance : std::numeric_limits<double>::infinity(); }
  /// False once nothing can be nearer: many points at one place would else all be looked at.
  bool addPoint(double squared_distance, std::uint32_t point) {
    if (point == excluded_ || !(squared_distance < worstDist())) return true;
    std::size_t at = full() ? size_ - 1 : size_++;
    for (; at > 0 && found_[at - 1].squared_distance > squared_distance; --at) found_[at] = found_[at - 1];
    found_[at] = {squared_distance, point};
    return worstDist() > 0;
  }

 private:
  std::span<Neighbour> found_;
  std::uint32_t excluded_;
  std::size_t size_ = 0;
};

using Position = std::array<double, NeighbourSearch::kMostDims>;

}  // namespace

class NeighbourSearch::Tree {
 public:
  explicit Tree(const PointSet& points) : cloud_(cloud_of(points)) {
    for (std::size_t k = 0; k < points.dims(); ++k) {
      const auto [low, high] = std::minmax_element(points.column(k).begin(), points.column(k).end());
      low_[k] = *low, high_[k] = *high;
    }
  }
  virtual ~Tree() = default;

  virtual void search(const Position& position, Nearest& nearest) const = 0;

  /// Searches about every image of `position` that can be nearer to a point than what has been found: a coordinate
  /// from `dim` on may be moved by −1 or 1; those before have left the points' box by `squared_gap` already.
  void search_images(Position& position, std::size_t dim, double squared_gap, Nearest& nearest) const {
    if (dim == cloud_.dims) return search(position, nearest);
    const double here = position[dim];
    for (const double image : {here, here - 1, here + 1}) {
      const double gap = std::max({low_[dim] - image, image - high_[dim], 0.0});
      if (!(squared_gap + gap * gap < nearest.worstDist())) continue;
      position[dim] = image;
      search_images(position, dim + 1, squared_gap + gap * gap, nearest);
    }
    position[dim] = here;
  }

 protected:
  const Cloud cloud_;

 private:
  Position low_{}, high_{};
};

namespace {

/// `kDims`: −1 where it is only known at run time.
template <int kDims>
class TreeOf : public NeighbourSearch::Tree {
 public:
  explicit TreeOf(const PointSet& points) : Tree(points), index_(static_cast<int>(cloud_.dims), cloud_) {}
  void search(const Position& position, Nearest& nearest) const override {
    index_.findNeighbors(nearest, position.data(), nanoflann::SearchParams());
  }

 private:
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, kDims> index_;
};

}  // namespace

double squared_distance(const PointSet& points, std::size_t i, std::size_t j, Space space) {
  double sum = 0;
  for (std::size_t k = 0; k < points.dims(); ++k) {
    const double apart = std::abs(points.column(k)[i] - points.column(k)[j]);
    const double difference = space == Space::kTorus ? std::min(apart, 1 - apart) : apart;
    sum += difference * difference;
  }
  return sum;
}

NeighbourSearch::NeighbourSearch(const PointSet& points, Space space) : space_(space) {
  assert_equal(points.dims() <= kMostDims, true, "dimensions of a search for neighbours");
  assert_equal(points.count() < kNobody, true, "points of a search for neighbours");
  if (points.dims() == 2) {
    tree_ = std::make_unique<TreeOf<2>>(points);
  } else if (points.dims() == 3) {
    tree_ = std::make_unique<TreeOf<3>>(points);
  } else {
    tree_ = std::make_unique<TreeOf<-1>>(points);
  }
}

NeighbourSearch::~NeighbourSearch() = default;

std::size_t NeighbourSearch::nearest(std::span<const double> position, std::span<Neighbour> found,
                                     std::uint32_t excluded) const {
  Position at{};
  std::ranges::copy(position, at.begin());
  Nearest nearest(found, excluded);
  if (space_ == Space::kTorus) {
    tree_->search_images(at, 0, 0, nearest);
  } else {
    tree_->search(at, nearest);
  }
  return nearest.size();
}

}  // namespace halfslope
