#include "analysis/box_sweep.h"

#include <algorithm>
#include <bit>

#include "core/assertion.h"

namespace halfslope {
namespace {

constexpr std::int32_t kMostPoints = 1 << 27;
// The line of a leaf without a box: it loses on either side, since it meets no other line at a width in [0, 1].
constexpr double kNoHeight = 2;
constexpr std::int32_t kNoPoints = 8 * kMostPoints;

}  // namespace

BoxSweep::BoxSweep(std::span<const double> heights, std::size_t count)
    : slope_(static_cast<double>(count)), leaves_(std::bit_ceil(heights.size())), nodes_(2 * leaves_) {
  assert_equal(count <= kMostPoints, true, "at most 2^27 points");
  for (std::size_t j = 0; j < leaves_; ++j) {
    Node& leaf = nodes_[leaves_ + j];
    const bool box = j < heights.size();
    leaf.fullest = box ? Line{heights[j], 0} : Line{kNoHeight, -kNoPoints};
    leaf.emptiest = box ? Line{heights[j], 0} : Line{kNoHeight, kNoPoints};
  }
  for (std::size_t n = leaves_ - 1; n > 0; --n) settle(n);
}

// One comparison decides both who wins and until when, so that rounding cannot set them at odds. Winners are picked by
// index, not by branch: who wins is as good as random.
inline void BoxSweep::settle(std::size_t n) {
  const Node* children = &nodes_[2 * n];
  const auto meeting = [&](const Line& left, const Line& right) {
    return static_cast<double>(right.points - left.points) / (slope_ * (right.height - left.height));
  };
  const double full = meeting(children[0].fullest, children[1].fullest);
  const double empty = meeting(children[0].emptiest, children[1].emptiest);
  const bool full_early = width_ < full, empty_early = width_ < empty;  // false for two leaves without a box
  Node& node = nodes_[n];
  node.fullest = children[full_early ? 1 : 0].fullest;
  node.emptiest = children[empty_early ? 0 : 1].emptiest;
  node.fullest.points += node.raised;
  node.emptiest.points += node.raised;
  node.until = std::min(std::min(children[0].until, children[1].until),
                        std::min(full_early ? full : kNever, empty_early ? empty : kNever));
}

void BoxSweep::settle_overdue(std::size_t n) {
  if (nodes_[n].until > width_) return;
  settle_overdue(2 * n);
  settle_overdue(2 * n + 1);
  settle(n);
}

void BoxSweep::grow(double width) {
  width_ = width;
  settle_overdue(1);
}

inline void BoxSweep::raise(std::size_t n) {
  ++nodes_[n].raised, ++nodes_[n].fullest.points, ++nodes_[n].emptiest.points;
}

void BoxSweep::add_point(std::size_t rank) {
  std::size_t n = leaves_ + rank;
  ++nodes_[n].fullest.points;
  for (; n > 1; n /= 2) {
    if (n % 2 == 0) raise(n + 1);  // all of the right neighbour's boxes are higher
    settle(n / 2);
  }
}

}  // namespace halfslope
