// How the dimensions of a point belong together.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace halfslope {

/// Groups of 1 or 2 dimensions, in order: a light takes {1, 2} (its choice, then a pair), a BSDF {2}. A sampler that
/// stratifies pairs knows from this which dimensions form one.
struct Layout {
  std::vector<std::uint8_t> groups;

  int dims() const { return std::accumulate(groups.begin(), groups.end(), 0); }
  void append(const Layout& other) { groups.insert(groups.end(), other.groups.begin(), other.groups.end()); }
  bool operator==(const Layout&) const = default;
};

/// How the dimensions of a path belong together: `start`, then for each of its vertices a sample of each technique and
/// `each`.
struct PathShape {
  Layout start;
  int vertices = 0;
  Layout each;

  bool operator==(const PathShape&) const = default;
};

}  // namespace halfslope
