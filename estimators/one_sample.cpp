#include "estimators/one_sample.h"

#include <algorithm>
#include <numeric>

namespace halfslope {

SharedLayout shared_layout(std::span<const int> techniques, std::span<const Technique> catalogue) {
  const auto layout_of = [&](std::size_t k) -> const Layout& {
    return catalogue[static_cast<std::size_t>(techniques[k])].layout;
  };
  std::vector<std::size_t> longest_first(techniques.size());
  std::iota(longest_first.begin(), longest_first.end(), std::size_t{0});
  std::stable_sort(longest_first.begin(), longest_first.end(),
                   [&](std::size_t a, std::size_t b) { return layout_of(a).dims() > layout_of(b).dims(); });
  SharedLayout shared = {{{1}}, std::vector<int>(techniques.size())};
  auto& groups = shared.layout.groups;
  for (const std::size_t k : longest_first) {
    const auto& own = layout_of(k).groups;
    auto at = std::search(groups.begin() + 1, groups.end(), own.begin(), own.end());
    shared.first_dims[k] = std::accumulate(groups.begin(), at, 0);
    if (at == groups.end()) shared.layout.append(layout_of(k));
  }
  return shared;
}

template <class T>
OneSample<T>::OneSample(const Allocation& allocation, std::span<const Technique> catalogue)
    : techniques_(allocation.techniques),
      first_dims_(shared_layout(allocation.techniques, catalogue).first_dims),
      chosen_(allocation.techniques.size()) {
  for (std::size_t k = 0; k < techniques_.size(); ++k) {
    dims_.push_back(catalogue[static_cast<std::size_t>(techniques_[k])].layout.dims());
    slots_.insert(slots_.end(), static_cast<std::size_t>(allocation.counts[k]), k);
  }
}

template <class T>
void OneSample<T>::sample(const Integral& integral, const PointBlock& points, TermBlock<T>& terms) {
  const int slots = static_cast<int>(techniques_.size());
  std::fill_n(terms.data(), static_cast<std::size_t>(slots * (terms.channels() + terms.densities())) * terms.stride(),
              T(0));
  choose(points);
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    if (chosen_[k].empty()) continue;
    gather(points, k);
    terms_.reset(1, terms.channels(), terms.densities(), points_.samples());
    integral.sample({techniques_[k], 0, 0, techniques_}, points_, terms_);
    scatter(terms, k);
  }
}

// By all the bits there are, so that a binary32 pass chooses as the binary64 one does.
template <class T>
void OneSample<T>::choose(const PointBlock& points) {
  for (auto& chosen : chosen_) chosen.clear();
  const std::uint32_t *high = points.high(0), *low = points.low(0);
  for (std::size_t p = 0; p < points.stride(); ++p) {
    const std::uint64_t word = (std::uint64_t{high[p]} << 21) | (low ? low[p] : 0);
    chosen_[slots_[(word * slots_.size()) >> 53]].push_back(static_cast<std::uint32_t>(p));
  }
}

template <class T>
void OneSample<T>::gather(const PointBlock& points, std::size_t k) {
  const auto& chosen = chosen_[k];
  const std::size_t rows = (chosen.size() + kLanes - 1) / kLanes;
  points_.reset(dims_[k], static_cast<int>(rows), points.has_low_words());
  for (int d = 0; d < dims_[k]; ++d) {
    const auto copy = [&](const std::uint32_t* from, std::uint32_t* to) {
      for (std::size_t i = 0; i < chosen.size(); ++i) to[i] = from[chosen[i]];
      // Packets are whole: what fills the last is a point that is there anyway.
      std::fill(to + chosen.size(), to + rows * kLanes, from[chosen.back()]);
    };
    copy(points.high(first_dims_[k] + d), points_.high(d));
    if (points.has_low_words()) copy(points.low(first_dims_[k] + d), points_.low(d));
  }
}

template <class T>
void OneSample<T>::scatter(TermBlock<T>& terms, std::size_t k) {
  const auto& chosen = chosen_[k];
  const auto copy = [&](const T* from, T* to) {
    for (std::size_t i = 0; i < chosen.size(); ++i) to[chosen[i]] = from[i];
  };
  const int slot = static_cast<int>(k);
  for (int c = 0; c < terms.channels(); ++c) copy(terms_.value(0, c), terms.value(slot, c));
  for (int j = 0; j < terms.densities(); ++j) copy(terms_.pdf(0, j), terms.pdf(slot, j));
}

template class OneSample<float>;
template class OneSample<double>;

}  // namespace halfslope
