#include "samplers/nearest_grid.h"

#include <algorithm>
#include <cmath>

namespace halfslope {
namespace {

constexpr int kFinest = 12;  // bits of a grid's side

}  // namespace

void NearestGrid::clear() {
  points_.clear(), next_.clear();
  bits_ = 2, shift_ = 32 - bits_;
}

void NearestGrid::add(TorusPoint point) {
  points_.push_back(point);
  next_.push_back(kNone);
  if (points_.size() == 1) {
    first_.assign(std::size_t{1} << (2 * bits_), kNone);
    near_.assign(first_.size(), point);
  }
  // 4 to 16 cells for each point.
  if (points_.size() * 4 > first_.size() && bits_ < kFinest) {
    refine();
  } else {
    enter(static_cast<std::uint32_t>(points_.size() - 1));
  }
}

void NearestGrid::refine() {
  const std::vector<TorusPoint> coarse = near_;
  const int coarse_bits = bits_++;
  --shift_;
  first_.assign(std::size_t{1} << (2 * bits_), kNone);
  near_.resize(first_.size());
  const std::size_t side = std::size_t{1} << bits_;
  for (std::size_t row = 0; row < side; ++row) {
    for (std::size_t column = 0; column < side; ++column) {
      near_[row << bits_ | column] = coarse[(row / 2) << coarse_bits | column / 2];
    }
  }
  for (std::uint32_t i = 0; i < points_.size(); ++i) enter(i);
}

void NearestGrid::enter(std::uint32_t index) {
  const TorusPoint point = points_[index];
  const std::size_t home = cell_of(point);
  next_[index] = first_[home];
  first_[home] = index;
  // The cells within 1.25 mean spacings: what lies farther from a new point has a nearer one, or pays a little for it.
  const int side = 1 << bits_;
  const double spacing = side / std::sqrt(static_cast<double>(points_.size()));
  const int reach = std::min(side / 2, static_cast<int>(1.25 * spacing) + 1);
  const std::uint32_t half = 1u << (shift_ - 1), mask = static_cast<std::uint32_t>(side - 1);
  for (int dy = -reach; dy <= reach; ++dy) {
    const std::uint32_t row = ((point.y >> shift_) + static_cast<std::uint32_t>(dy)) & mask;
    for (int dx = -reach; dx <= reach; ++dx) {
      const std::uint32_t column = ((point.x >> shift_) + static_cast<std::uint32_t>(dx)) & mask;
      const TorusPoint middle = {(column << shift_) + half, (row << shift_) + half};
      TorusPoint& near = near_[std::size_t{row} << bits_ | column];
      if (squared_distance(point, middle) < squared_distance(near, middle)) near = point;
    }
  }
}

bool NearestGrid::search(TorusPoint from, std::uint64_t distance, std::uint64_t& bound) const {
  // All cells that a circle of the known distance can touch; at most the whole torus, each cell once.
  const std::uint32_t side = 1u << bits_, mask = side - 1;
  const auto radius = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(distance))) + 1;
  const auto reach = static_cast<std::uint32_t>(std::min<std::uint64_t>((radius >> shift_) + 1, side));
  const std::uint32_t across = std::min(2 * reach + 1, side);
  for (std::uint32_t r = 0; r < across; ++r) {
    const std::uint32_t row = ((from.y >> shift_) - reach + r) & mask;
    for (std::uint32_t c = 0; c < across; ++c) {
      const std::uint32_t column = ((from.x >> shift_) - reach + c) & mask;
      for (std::uint32_t i = first_[std::size_t{row} << bits_ | column]; i != kNone; i = next_[i]) {
        distance = std::min(distance, squared_distance(points_[i], from));
      }
      if (distance <= bound) return false;
    }
  }
  bound = distance;
  return true;
}

}  // namespace halfslope
