// The points nearest to a place, in the unit cube or on the torus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "analysis/discrepancy.h"

namespace halfslope {

/// Where distances are taken: in the cube as it is, or with opposite faces glued together, so that a coordinate's
/// difference is at most 1/2 and 1 is 0.
enum class Space { kCube, kTorus };

/// The squared distance between points i and j of a set.
double squared_distance(const PointSet& points, std::size_t i, std::size_t j, Space space);

struct Neighbour {
  double squared_distance;
  std::uint32_t point;
};

/// A k-d tree over points of at most `kMostDims` dimensions and at most 2³² − 2 of them. It copies the points, and
/// takes about 8 d + 40 bytes a point. Several threads may ask at once.
class NeighbourSearch {
 public:
  static constexpr std::size_t kMostDims = 6;  ///< more, and a tree is no faster than all pairs
  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

  NeighbourSearch(const PointSet& points, Space space);
  ~NeighbourSearch();

  /// The points nearest to `position`, which lies in [0, 1]^d: as many as `found` has room for or there are, nearest
  /// first; among equals, any. `excluded` is not looked at. Returns how many were found. On the torus a point is found
  /// once for each of its images that is near enough, so with few points some may stand there several times.
  std::size_t nearest(std::span<const double> position, std::span<Neighbour> found,
                      std::uint32_t excluded = kNobody) const;

  class Tree;

 private:
  Space space_;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace halfslope
