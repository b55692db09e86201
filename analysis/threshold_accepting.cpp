#include "analysis/threshold_accepting.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "analysis/box_counter.h"
#include "core/random.h"

namespace halfslope {
namespace {

constexpr std::size_t kWalks = 4;
constexpr double kPatience = 0.1;  // of a random step's loss, what is taken at first; all of it wastes half the walk

class Walk {
 public:
  explicit Walk(const CriticalBoxes& boxes)
      : boxes_(boxes),
        counter_(boxes),
        key_(stream_key(0, "threshold accepting", "star")),
        order_(boxes.dims()),
        box_(boxes.dims()),
        next_(boxes.dims()) {
    std::iota(order_.begin(), order_.end(), 0u);
  }

  /// The largest excess so far, after so many steps from a new start.
  double go(std::size_t steps) {
    const auto rounds = static_cast<std::size_t>(std::sqrt(static_cast<double>(steps))) + 1;
    std::vector<double> thresholds;
    for (std::size_t r = 0; r < rounds; ++r) {
      const double here = start();
      const double there = step(static_cast<double>(r) / static_cast<double>(rounds));
      thresholds.push_back(kPatience * std::abs(there - here));
    }
    std::sort(thresholds.begin(), thresholds.end(), std::greater());
    double here = start();
    for (std::size_t s = 0; s < steps; ++s) {
      const double there = step(static_cast<double>(s) / static_cast<double>(steps));
      if (there < here - thresholds[s * rounds / steps]) continue;
      here = there;
      std::swap(box_, next_);
    }
    return best_;
  }

 private:
  double uniform() {
    const std::uint32_t word = random_word(key_, Draw::kHigh, 0, static_cast<std::uint32_t>(drawn_), 0,
                                           static_cast<std::uint32_t>(drawn_ >> 32));
    ++drawn_;
    return (static_cast<double>(word) + 0.5) * 0x1p-32;
  }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(uniform() * static_cast<double>(n)); }

  /// An end of this dimension between two others, with density proportional to r^(d−1).
  std::uint32_t draw_end(std::size_t dim, std::uint32_t low, std::uint32_t high) {
    const std::vector<double>& ends = boxes_.ends[dim];
    const auto d = static_cast<double>(boxes_.dims());
    const double from = low == 0 ? 0 : std::pow(ends[low], d), to = std::pow(ends[high], d);
    const double end = std::pow(from + (to - from) * uniform(), 1 / d);
    const auto place = static_cast<std::uint32_t>(std::lower_bound(ends.begin(), ends.end(), end) - ends.begin());
    return std::clamp(place, low, high);
  }
  std::uint32_t last(std::size_t dim) const { return static_cast<std::uint32_t>(boxes_.ends[dim].size() - 1); }

  /// Excess of the box, once it is snapped; the sides in random order, of which the first few are random already.
  double settle(std::vector<std::uint32_t>& box, std::size_t shuffled) {
    for (std::size_t k = shuffled; k + 1 < order_.size(); ++k) {
      std::swap(order_[k], order_[k + below(order_.size() - k)]);
    }
    const double excess = boxes_.excess(box, counter_.snap(box, order_));
    best_ = std::max(best_, excess);
    return excess;
  }
  double start() {
    for (std::size_t k = 0; k < box_.size(); ++k) box_[k] = draw_end(k, 0, last(k));
    return settle(box_, 0);
  }
  /// Sets next_ to a neighbour of box_. `done`: the part of the walk that lies behind.
  double step(double done) {
    next_ = box_;
    const auto dims = static_cast<double>(box_.size());
    const auto sides = static_cast<std::size_t>(std::min(dims, 2 + done * (dims - 2) + uniform()));
    for (std::size_t j = 0; j < sides; ++j) {
      std::swap(order_[j], order_[j + below(order_.size() - j)]);
      const std::uint32_t k = order_[j];
      const auto reach = static_cast<std::uint32_t>(1 + std::pow(0.5 * last(k), 1 - done));
      next_[k] = draw_end(k, box_[k] - std::min(box_[k], reach), std::min(last(k), box_[k] + reach));
    }
    return settle(next_, sides);
  }

  const CriticalBoxes& boxes_;
  BoxCounter counter_;
  StreamKey key_;
  std::uint64_t drawn_ = 0;
  std::vector<std::uint32_t> order_, box_, next_;
  double best_ = 0;
};

}  // namespace

double threshold_accepting(const CriticalBoxes& boxes, std::size_t steps) {
  Walk walk(boxes);
  double best = 0;
  for (std::size_t w = 0; w < kWalks; ++w) best = walk.go(steps / kWalks + 1);
  return best;
}

}  // namespace halfslope
