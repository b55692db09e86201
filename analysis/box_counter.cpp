#include "analysis/box_counter.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace halfslope {

BoxCounter::BoxCounter(const CriticalBoxes& boxes)
    : boxes_(boxes),
      words_((boxes.count() + 63) / 64),
      rest_(boxes.dims() + 1, std::vector<Word>(words_)),
      in_(words_),
      side_(words_) {
  std::size_t most = 0;
  for (const auto& ends : boxes.ends) most = std::max(most, ends.size());
  stride_ = most / 64 + 1;
  for (std::size_t k = 0; k < boxes.dims(); ++k) {
    const auto& first = boxes.first[k];
    auto& order = order_.emplace_back(boxes.count());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return first[a] < first[b]; });
    auto& before = before_.emplace_back(boxes.ends[k].size() + 1);
    std::uint32_t i = 0;
    for (std::size_t end = 0; end < before.size(); ++end) {
      while (i < order.size() && first[order[i]] < end) ++i;
      before[end] = i;
    }
    auto& below = below_.emplace_back();
    i = 0;
    for (std::size_t end = 0; end < before.size(); end += stride_) {
      for (; i < before[end]; ++i) side_[order[i] / 64] |= Word{1} << order[i] % 64;
      below.insert(below.end(), side_.begin(), side_.end());
    }
    std::fill(side_.begin(), side_.end(), 0);
  }
}

// Of `points`, keeps those that a box has which ends here in this dimension.
void BoxCounter::keep_below(std::size_t dim, std::uint32_t end, std::vector<Word>& points) {
  const std::size_t row = (end + 1) / stride_;
  const Word* below = below_[dim].data() + row * words_;
  std::copy(below, below + words_, side_.begin());
  for (std::uint32_t i = before_[dim][row * stride_]; i < before_[dim][end + 1]; ++i) {
    const std::uint32_t point = order_[dim][i];
    side_[point / 64] |= Word{1} << point % 64;
  }
  for (std::size_t w = 0; w < words_; ++w) points[w] &= side_[w];
}

std::size_t BoxCounter::points(std::span<const std::uint32_t> box) {
  std::fill(in_.begin(), in_.end(), ~Word{0});
  for (std::size_t k = 0; k < box.size(); ++k) keep_below(k, box[k], in_);
  std::size_t count = 0;
  for (const Word word : in_) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

std::size_t BoxCounter::snap(std::span<std::uint32_t> box, std::span<const std::uint32_t> order) {
  const std::size_t count = points(box);
  if (boxes_.side == Side::kFullest) {
    if (count == 0) return 0;
    for (std::size_t k = 0; k < box.size(); ++k) {
      std::uint32_t i = before_[k][box[k] + 1];
      while (!has(in_, order_[k][i - 1])) --i;
      box[k] = boxes_.first[k][order_[k][i - 1]];
    }
    return count;
  }
  std::fill(rest_.back().begin(), rest_.back().end(), ~Word{0});
  for (std::size_t j = order.size(); j-- > 1;) {
    rest_[j] = rest_[j + 1];
    keep_below(order[j], box[order[j]], rest_[j]);
  }
  std::fill(in_.begin(), in_.end(), ~Word{0});
  for (std::size_t j = 0; j < order.size(); ++j) {
    const std::uint32_t k = order[j];
    const auto& by_end = order_[k];
    const auto stands_in_the_way = [&](std::uint32_t point) { return has(in_, point) && has(rest_[j + 1], point); };
    std::uint32_t i = before_[k][box[k] + 1];
    while (i < by_end.size() && !stands_in_the_way(by_end[i])) ++i;
    const auto last = static_cast<std::uint32_t>(boxes_.ends[k].size() - 1);
    box[k] = i == by_end.size() ? last : boxes_.first[k][by_end[i]] - 1;
    if (j + 1 < order.size()) keep_below(k, box[k], in_);
  }
  return count;
}

}  // namespace halfslope
