#include "analysis/box_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/assertion.h"

namespace halfslope {
namespace {

// Excesses that differ by less are one: else every box that ties with the best would be looked at. Bounds, sums of less
// than 40 terms below 1 each, are rounded by less than a fifth of kTolerance.
constexpr double kTie = 1e-14;
constexpr std::size_t kMostEntries = std::size_t{1} << 27;  // a gigabyte

bool in_one(std::uint32_t slabs) { return (slabs & (slabs - 1)) == 0; }

}  // namespace

BoxSearch::BoxSearch(const CriticalBoxes& boxes) : boxes_(boxes) {
  const std::size_t dims = boxes.dims();
  assert_equal(dims <= kMostDims, true, "at most 32 dimensions");
  for (const auto& ends : boxes.ends) {
    auto& logs = logs_.emplace_back();
    for (const double end : ends) logs.push_back(std::log(end));
  }
  // 1/m rounded up to 25 binary places, so that sums of up to 2²⁷ of them are exact.
  weights_.assign(dims + 1, 1);
  for (std::size_t m = 2; m <= dims; ++m) weights_[m] = std::ceil(0x1p25 / static_cast<double>(m)) * 0x1p-25;

  Node& root = nodes_.emplace_back();
  root.inside = root.undecided = 0;
  std::vector<Entry> undecided;
  for (std::size_t k = 0; k < dims; ++k) {
    root.low[k] = 0, root.high[k] = static_cast<std::uint32_t>(boxes.ends[k].size() - 1);
  }
  for (std::uint32_t i = 0; i < boxes.count(); ++i) {
    std::uint32_t slabs = 0;
    bool out = false;
    for (std::size_t k = 0; k < dims; ++k) {
      out = out || boxes.first[k][i] > root.high[k];
      slabs |= boxes.first[k][i] > 0 ? 1u << k : 0;
    }
    if (out) continue;
    if (slabs == 0) {
      ++root.inside;
    } else {
      undecided.push_back({i, slabs});
    }
  }
  root.undecided = static_cast<std::int64_t>(undecided.size());
  for (std::size_t k = 0; k < dims; ++k) {
    root.begin[k] = entries_.size();
    std::copy_if(undecided.begin(), undecided.end(), std::back_inserter(entries_),
                 [&](const Entry& entry) { return (entry.slabs >> k & 1) != 0; });
    const std::uint32_t* first = boxes.first[k].data();
    std::stable_sort(entries_.begin() + static_cast<std::ptrdiff_t>(root.begin[k]), entries_.end(),
                     [&](const Entry& a, const Entry& b) { return first[a.point] < first[b.point]; });
  }
  root.begin[dims] = entries_.size();
}

double BoxSearch::limit() const { return std::max(threshold_, best_) + kTie; }

std::size_t BoxSearch::points_in(const Node& node, const Ends& box) {
  std::int64_t points = node.inside;
  for (std::size_t j = 0; j < boxes_.dims(); ++j) {
    const std::uint32_t lower_bits = (1u << j) - 1;
    for (std::size_t e = node.begin[j]; e < node.begin[j + 1]; ++e) {
      const Entry& entry = entries_[e];
      if ((entry.slabs & lower_bits) != 0) continue;  // looked at in its first slab
      bool in = true;
      for (std::uint32_t slabs = entry.slabs; slabs != 0 && in; slabs &= slabs - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(slabs));
        in = boxes_.first[k][entry.point] <= box[k];
      }
      points += in ? 1 : 0;
    }
  }
  spend(static_cast<std::size_t>(node.undecided));
  return static_cast<std::size_t>(points);
}

// Fills in the points of `to`, whose ends are set; false where they do not fit.
bool BoxSearch::narrow(const Node& from, Node& to) {
  struct Change {
    const std::uint32_t* first;
    std::uint32_t low, high, bit;
  };
  std::array<Change, kMostDims> changes;
  std::size_t changed = 0;
  const std::size_t dims = boxes_.dims();
  for (std::size_t k = 0; k < dims; ++k) {
    if (from.low[k] == to.low[k] && from.high[k] == to.high[k]) continue;
    changes[changed++] = {boxes_.first[k].data(), to.low[k], to.high[k], 1u << k};
  }
  const std::size_t size = entries(from);
  std::size_t end = from.begin[dims];
  spend(size * (changed + 1));
  if (end + size > kMostEntries) return false;
  if (entries_.size() < end + size) entries_.resize(end + size + size / 2);
  to.inside = from.inside, to.undecided = 0;
  Entry* const all = entries_.data();
  for (std::size_t j = 0; j < dims; ++j) {
    to.begin[j] = end;
    const std::uint32_t bit = 1u << j;
    for (std::size_t e = from.begin[j]; e < from.begin[j + 1]; ++e) {
      const Entry entry = all[e];
      std::uint32_t slabs = entry.slabs;
      bool out = false;
      for (std::size_t c = 0; c < changed; ++c) {
        const std::uint32_t first = changes[c].first[entry.point];
        out |= first > changes[c].high;
        slabs &= first <= changes[c].low ? ~changes[c].bit : ~0u;
      }
      const bool counts = !out && (entry.slabs & (bit - 1)) == 0;
      to.undecided += counts && slabs != 0 ? 1 : 0;
      to.inside += counts && slabs == 0 ? 1 : 0;
      all[end] = {entry.point, slabs};
      end += !out && (slabs & bit) != 0 ? 1 : 0;
    }
  }
  to.begin[dims] = end;
  return true;
}

// The largest box shrinks onto the last point of each slab, the smallest grows to the first.
template <Side kSide>
BoxSearch::Reach BoxSearch::tighten(Node& node) const {
  Reach reach;
  for (std::size_t k = 0; k < boxes_.dims(); ++k) {
    const bool empty = entries(node, k) == 0;
    if constexpr (kSide == Side::kFullest) {
      node.high[k] = empty ? node.low[k] : boxes_.first[k][entries_[node.begin[k + 1] - 1].point];
    } else {
      node.low[k] = empty ? node.high[k] : boxes_.first[k][entries_[node.begin[k]].point] - 1;
    }
    reach.low *= boxes_.ends[k][node.low[k]], reach.high *= boxes_.ends[k][node.high[k]];
    reach.low_log += logs_[k][node.low[k]], reach.high_log += logs_[k][node.high[k]];
    if (node.low[k] < node.high[k]) ++reach.free, reach.one = k;
  }
  return reach;
}

template <Side kSide>
BoxSearch::Relaxation BoxSearch::relax(const Node& node, Reach reach) {
  constexpr bool kFull = kSide == Side::kFullest;
  const double per_point = 1 / static_cast<double>(boxes_.count());
  const double inside = static_cast<double>(node.inside) * per_point;
  const bool exact = reach.free == 1;  // the volume is a line in u_k itself
  Relaxation relaxed;
  double& slope = relaxed.slope;
  if (exact && kFull) {
    slope = reach.low / boxes_.ends[reach.one][node.low[reach.one]];
    relaxed.bound = inside - reach.low;
  } else if (exact) {
    slope = reach.high / boxes_.ends[reach.one][node.high[reach.one]];
    relaxed.bound = reach.high - inside;
  } else {
    double low = reach.low, high = reach.high, low_log = reach.low_log, high_log = reach.high_log;
    const double most = static_cast<double>(node.inside + node.undecided) * per_point - limit();
    const double least = inside + limit();
    if (kFull && most < high) high = most, high_log = std::log(most);
    if (!kFull && least > low) low = least, low_log = std::log(least);
    slope = high_log > low_log ? (high - low) / (high_log - low_log) : low;
    relaxed.bound = kFull ? inside - slope * (1 + reach.low_log - std::log(slope)) : high - inside;
  }
  spend(entries(node));
  if (terms_.size() < entries(node)) terms_.resize(entries(node));
  relaxed.box = kFull ? node.low : node.high;
  for (std::size_t k = 0; k < boxes_.dims(); ++k) {
    if (node.low[k] == node.high[k]) continue;
    const double* height = (exact ? boxes_.ends[k] : logs_[k]).data();
    const std::uint32_t* first = boxes_.first[k].data();
    double* term = terms_.data() + (node.begin[k] - node.begin[0]);
    double points = 0, largest = kFull ? 0 : -std::numeric_limits<double>::infinity();
    for (std::size_t e = node.begin[k]; e < node.begin[k + 1]; ++e) {
      const Entry entry = entries_[e];
      std::uint32_t end = first[entry.point];
      if constexpr (kFull) {
        points += in_one(entry.slabs) ? 1 : weights_[static_cast<std::size_t>(std::popcount(entry.slabs))];
        *term = points * per_point - slope * (height[end] - height[node.low[k]]);
      } else {
        *term = slope * (height[--end] - height[node.high[k]]) - points * per_point;
        points += in_one(entry.slabs) ? 1 : 0;
      }
      if (*term > largest) largest = *term, relaxed.box[k] = end;
      ++term;
    }
    relaxed.outer[k] = kFull ? 0 : -points * per_point;
    if (relaxed.outer[k] >= largest) largest = relaxed.outer[k], relaxed.box[k] = kFull ? node.low[k] : node.high[k];
    relaxed.largest[k] = largest;
    relaxed.bound += largest;
  }
  return relaxed;
}

template <Side kSide>
BoxSearch::Split BoxSearch::shrink(const Node& node, const Relaxation& relaxed) const {
  constexpr bool kFull = kSide == Side::kFullest;
  constexpr std::uint32_t kBefore = kFull ? 0 : 1;  // the end of an open box at a point is the one that lacks it
  const std::size_t dims = boxes_.dims();
  Split split = {node.low, node.high, dims, 0, 0};
  double widest = 0;
  for (std::size_t k = 0; k < dims; ++k) {
    if (node.low[k] == node.high[k]) continue;
    const double* term = terms_.data() + (node.begin[k] - node.begin[0]);
    const Entry* entry = entries_.data() + node.begin[k];
    const auto end_of = [&](std::size_t e) { return boxes_.first[k][entry[e].point] - kBefore; };
    const double least = relaxed.largest[k] - (relaxed.bound - limit());
    std::size_t begin = 0, end = entries(node, k);
    const bool outer = relaxed.outer[k] >= least;
    if (!(kFull && outer)) {
      while (begin < end && term[begin] < least) ++begin;
    }
    if (kFull || !outer) {
      while (begin < end && term[end - 1] < least) --end;
    }
    if (kFull) {
      if (!outer) split.low[k] = end_of(begin);
      split.high[k] = begin < end ? end_of(end - 1) : split.low[k];
    } else {
      if (!outer) split.high[k] = end_of(end - 1);
      split.low[k] = begin < end ? end_of(begin) : split.high[k];
    }
    if (split.low[k] == split.high[k]) continue;
    split.kept += end - begin;
    const double width = relaxed.slope * (logs_[k][split.high[k]] - logs_[k][split.low[k]]) +
                         static_cast<double>(end - begin) / static_cast<double>(boxes_.count());
    if (width <= widest) continue;
    widest = width, split.dim = k;
    split.middle = std::clamp(boxes_.first[k][entry[begin + (end - begin) / 2].point], split.low[k] + 1, split.high[k]);
  }
  return split;
}

// Of boxes without volume there is no logarithm: those with an end 0 are split off. (Or the product was too small.)
BoxSearch::Split BoxSearch::split_low(const Node& node) const {
  Split split = {node.low, node.high, boxes_.dims(), 0, 0};
  double smallest = 1;
  for (std::size_t k = 0; k < boxes_.dims(); ++k) {
    const double end = boxes_.ends[k][node.low[k]];
    if (node.low[k] == node.high[k] || end >= smallest) continue;
    const std::uint32_t median = boxes_.first[k][entries_[node.begin[k] + entries(node, k) / 2].point];
    smallest = end, split.dim = k, split.middle = end == 0 ? node.low[k] + 1 : median;
  }
  return split;
}

template <Side kSide>
bool BoxSearch::search(std::size_t depth) {
  constexpr bool kFull = kSide == Side::kFullest;
  Node& node = nodes_[depth];
  const Reach reach = tighten<kSide>(node);
  const auto n = static_cast<double>(boxes_.count());
  const double fewest = static_cast<double>(node.inside) / n;
  const double most = static_cast<double>(node.inside + node.undecided) / n;
  if ((kFull ? most - reach.low : reach.high - fewest) <= limit()) return true;
  if (reach.free == 0 || reach.high == 0) {
    best_ = std::max(best_, kFull ? most - reach.high : reach.high - fewest);
    return true;
  }
  Split split;
  if (kFull && reach.low == 0) {
    split = split_low(node);
    split.kept = entries(node);
  } else {
    const Relaxation relaxed = relax<kSide>(node, reach);
    if (relaxed.bound <= limit()) return true;
    const std::span box(relaxed.box.data(), boxes_.dims());
    best_ = std::max(best_, boxes_.excess(box, points_in(node, relaxed.box)));
    if (relaxed.bound <= limit()) return true;
    split = shrink<kSide>(node, relaxed);
  }
  if (work_ == 0) return false;
  // With many points gone the bound is worth another look before it is split.
  if (split.dim == boxes_.dims() || 10 * split.kept < 9 * entries(node)) {
    return search_within<kSide>(depth, split.low, split.high);
  }
  Ends middle = split.high;
  middle[split.dim] = split.middle - 1;
  if (!search_within<kSide>(depth, split.low, middle)) return false;
  middle = split.low;
  middle[split.dim] = split.middle;
  return search_within<kSide>(depth, middle, split.high);
}

template <Side kSide>
bool BoxSearch::search_within(std::size_t depth, const Ends& low, const Ends& high) {
  if (nodes_.size() < depth + 2) nodes_.emplace_back();
  Node& child = nodes_[depth + 1];
  child.low = low, child.high = high;
  return narrow(nodes_[depth], child) && search<kSide>(depth + 1);
}

bool BoxSearch::run(double threshold, double& best, std::uint64_t& work) {
  threshold_ = threshold, best_ = best, work_ = work;
  const bool done = boxes_.side == Side::kFullest ? search<Side::kFullest>(0) : search<Side::kEmptiest>(0);
  best = best_, work = work_;
  return done;
}

}  // namespace halfslope
