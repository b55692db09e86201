#include "samplers/sample_elimination.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfslope {
namespace {

constexpr std::uint32_t kRemoved = ~0u;

}  // namespace

const std::vector<std::uint32_t>& SampleElimination::keep(const std::vector<TorusPoint>& points, std::uint32_t count) {
  const double n = count, candidates = static_cast<double>(points.size());
  const double r_max = std::sqrt(1 / (2 * std::numbers::sqrt3 * n));
  const double reach = 2 * r_max * 0x1p32;
  inverse_reach_ = 1 / reach;
  squared_reach_ = static_cast<std::uint64_t>(std::min(reach * reach, 0x1p63));  // no two points are farther apart
  least_ = (1 - std::pow(n / candidates, 1.5)) * 0.65;
  side_ = static_cast<std::uint32_t>(1 / (2 * r_max));
  if (side_ < 3) side_ = 1;
  sort_into_cells(points);
  weigh();

  auto left = static_cast<std::uint32_t>(points.size());
  for (; left > count; --left) {
    const std::uint32_t heaviest = heap_.front();
    places_[heaviest] = kRemoved;
    put(0, heap_[left - 1]);
    heap_.pop_back();
    sift_down(0);
    for_neighbours(heaviest, [this](std::uint32_t neighbour, std::uint64_t distance) {
      if (places_[neighbour] == kRemoved) return;
      weights_[neighbour] -= weight(distance);
      sift_down(places_[neighbour]);
    });
  }
  kept_.clear();
  for (const std::uint32_t point : heap_) kept_.push_back(original_[point]);
  std::sort(kept_.begin(), kept_.end());
  return kept_;
}

void SampleElimination::sort_into_cells(const std::vector<TorusPoint>& points) {
  const auto cell_of = [this](TorusPoint p) {
    const auto column = static_cast<std::uint32_t>((std::uint64_t{p.x} * side_) >> 32);
    const auto row = static_cast<std::uint32_t>((std::uint64_t{p.y} * side_) >> 32);
    return row * side_ + column;
  };
  starts_.assign(std::size_t{side_} * side_ + 1, 0);
  for (const TorusPoint& p : points) ++starts_[cell_of(p) + 1];
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  points_.resize(points.size()), original_.resize(points.size()), cells_.resize(points.size());
  heap_.assign(starts_.begin(), starts_.end() - 1);  // the next free place of each cell
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t cell = cell_of(points[i]), at = heap_[cell]++;
    points_[at] = points[i], original_[at] = static_cast<std::uint32_t>(i), cells_[at] = cell;
  }
}

void SampleElimination::weigh() {
  const auto size = static_cast<std::uint32_t>(points_.size());
  weights_.assign(size, 0);
  heap_.resize(size), places_.resize(size);
  for (std::uint32_t i = 0; i < size; ++i) put(i, i);
  for (std::uint32_t i = 0; i < size; ++i) {
    for_neighbours(i, [this, i](std::uint32_t neighbour, std::uint64_t distance) {
      if (neighbour > i) return;
      const std::uint64_t between = weight(distance);
      weights_[i] += between;
      weights_[neighbour] += between;
    });
  }
  for (std::uint32_t i = size / 2; i-- > 0;) sift_down(i);
}

template <class Visit>
void SampleElimination::for_neighbours(std::uint32_t point, Visit visit) const {
  const auto visit_run = [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i) {
      const std::uint64_t distance = squared_distance(points_[i], points_[point]);
      if (distance < squared_reach_ && i != point) visit(i, distance);
    }
  };
  if (side_ == 1) return visit_run(0, static_cast<std::uint32_t>(points_.size()));
  const std::uint32_t row = cells_[point] / side_, column = cells_[point] % side_;
  for (const std::uint32_t r : {row == 0 ? side_ - 1 : row - 1, row, row == side_ - 1 ? 0 : row + 1}) {
    const std::uint32_t* start = starts_.data() + std::size_t{r} * side_;
    // Cells beside each other hold one run of points, but for the two ends of a row.
    const std::uint32_t left = column == 0 ? 0 : column - 1, right = column == side_ - 1 ? column : column + 1;
    visit_run(start[left], start[right + 1]);
    if (column == 0) visit_run(start[side_ - 1], start[side_]);
    if (column == side_ - 1) visit_run(start[0], start[1]);
  }
}

std::uint64_t SampleElimination::weight(std::uint64_t squared_distance) const {
  // Signed conversions, which both numbers fit, are the fast ones.
  const double d = std::sqrt(static_cast<double>(static_cast<std::int64_t>(squared_distance))) * inverse_reach_;
  double w = 1 - std::max(d, least_);
  w *= w, w *= w, w *= w;
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(w * 0x1p40));
}

void SampleElimination::sift_down(std::uint32_t place) {
  const std::uint32_t point = heap_[place];
  const auto size = static_cast<std::uint32_t>(heap_.size());
  while (2 * place + 1 < size) {
    std::uint32_t child = 2 * place + 1;
    if (child + 1 < size && weights_[heap_[child + 1]] > weights_[heap_[child]]) ++child;
    if (weights_[heap_[child]] <= weights_[point]) break;
    put(place, heap_[child]);
    place = child;
  }
  put(place, point);
}

}  // namespace halfslope
