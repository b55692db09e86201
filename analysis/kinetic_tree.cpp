#include "analysis/kinetic_tree.h"

#include <algorithm>
#include <bit>

namespace halfslope {

// Where the lines do not fill the leaves, the rest have an infinite y on the side that wins early: they meet every line
// at t = 0, so that from the start it is late, and they lose.
KineticTree::KineticTree(std::span<const double> y, double slope, Winner winner)
    : slope_(slope), largest_(winner == Winner::kLargest), leaves_(std::bit_ceil(y.size())), nodes_(2 * leaves_) {
  first_leaf_ = leaves_ + (largest_ ? 0 : leaves_ - y.size());
  for (std::size_t n = leaves_; n < 2 * leaves_; ++n) nodes_[n].y = largest_ ? kNever : -kNever;
  for (std::size_t j = 0; j < y.size(); ++j) nodes_[first_leaf_ + j].y = y[j];
  for (std::size_t n = leaves_ - 1; n > 0; --n) settle(n);
}

// One comparison decides both who wins and until when, so that rounding cannot set them at odds.
inline void KineticTree::settle(std::size_t n) {
  const Node &left = nodes_[2 * n], &right = nodes_[2 * n + 1];
  const double meeting = static_cast<double>(right.c - left.c) / (slope_ * (right.y - left.y));
  const bool early = time_ < meeting;  // false too for two lines without end, whose meeting is not a number
  const Node& winner = early == largest_ ? right : left;
  Node& node = nodes_[n];
  node.y = winner.y;
  node.c = winner.c + node.raised;
  node.until = std::min({left.until, right.until, early ? meeting : kNever});
}

void KineticTree::settle_overdue(std::size_t n) {
  if (nodes_[n].until > time_) return;
  settle_overdue(2 * n);
  settle_overdue(2 * n + 1);
  settle(n);
}

void KineticTree::advance(double t) {
  time_ = t;
  settle_overdue(1);
}

void KineticTree::raise_from(std::size_t first) {
  std::size_t n = first_leaf_ + first;
  if (n >= 2 * leaves_) return;
  ++nodes_[n].raised, ++nodes_[n].c;
  for (; n > 1; n /= 2) {
    if (n % 2 == 0) ++nodes_[n + 1].raised, ++nodes_[n + 1].c;  // all of the right neighbour is in the tail
    settle(n / 2);
  }
}

}  // namespace halfslope
