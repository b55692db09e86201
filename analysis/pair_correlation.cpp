#include "analysis/pair_correlation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ranges>

#include "core/assertion.h"

namespace halfslope {
namespace {

// Of so many pairs, distances are taken together and bins are counted after: the first loop becomes packets.
constexpr std::size_t kTogether = 256;
// One pair after another in the same bin would wait for its count to be written; neighbours count in tables of their
// own.
constexpr std::size_t kTables = 4;

/// Points sorted by strip of the last dimension, and within a strip by the first.
class PairCounter {
 public:
  PairCounter(const PointSet& points, const DistanceBins& bins)
      : most_(bins.most),
        bins_(static_cast<std::size_t>(bins.bins)),
        scale_(bins.bins / bins.most),
        // Fewer than three strips would be their own neighbours' neighbours; more than √N gain nothing.
        strips_(std::floor(std::min(1 / bins.most, std::sqrt(static_cast<double>(points.count()))))),
        counts_((bins_ + 1) * kTables) {
    if (strips_ < 3 || points.dims() == 1) strips_ = 1;
    sort(points);
  }

  std::vector<std::uint64_t> count() {
    const auto strips = static_cast<std::size_t>(strips_);
    for (std::size_t strip = 0; strip < strips; ++strip) {
      const std::size_t next = (strip + 1) % strips;
      for (std::size_t i = begin_[strip]; i < begin_[strip + 1]; ++i) {
        const double x = columns_.front()[i];
        // In its own strip those after it: each pair once.
        const std::size_t near_end = place_after(strip, x + most_);
        count_pairs(i, i + 1, near_end);
        count_pairs(i, std::max(near_end, place_of(strip, x + 1 - most_)), begin_[strip + 1]);
        if (next == strip) continue;
        count_pairs(i, begin_[next], place_after(next, x - 1 + most_));
        count_pairs(i, place_of(next, x - most_), place_after(next, x + most_));
        count_pairs(i, place_of(next, x + 1 - most_), begin_[next + 1]);
      }
    }
    std::vector<std::uint64_t> total(bins_);
    for (std::size_t k = 0; k < bins_; ++k) {
      for (std::size_t table = 0; table < kTables; ++table) total[k] += counts_[table * (bins_ + 1) + k];
    }
    return total;
  }

 private:
  std::size_t strip_of(double y) const {
    return std::min(static_cast<std::size_t>(y * strips_), static_cast<std::size_t>(strips_) - 1);
  }

  void sort(const PointSet& points) {
    const auto wrapped = [&](std::size_t dim, std::size_t i) {
      const double x = points.column(dim)[i];
      return x == 1 ? 0 : x;  // the same place on the torus
    };
    struct Key {
      std::size_t strip;
      double x;
      std::size_t point;
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys(points.count());
    const std::size_t last = points.dims() - 1;
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = {strip_of(wrapped(last, i)), wrapped(0, i), i};
    std::ranges::sort(keys);
    columns_.resize(points.dims());
    for (std::size_t k = 0; k < points.dims(); ++k) {
      for (const Key& key : keys) columns_[k].push_back(wrapped(k, key.point));
    }
    begin_.assign(static_cast<std::size_t>(strips_) + 1, keys.size());
    for (std::size_t i = keys.size(); i-- > 0;) begin_[keys[i].strip] = i;
    for (std::size_t strip = begin_.size() - 1; strip-- > 0;)
      begin_[strip] = std::min(begin_[strip], begin_[strip + 1]);
  }

  // Places in a strip, by x. (Sums like x + most are rounded, so a pair at `most` exactly may be looked at or not; it
  // is in no bin.)
  auto xs_of(std::size_t strip) const {
    return std::ranges::subrange(columns_.front().begin() + static_cast<std::ptrdiff_t>(begin_[strip]),
                                 columns_.front().begin() + static_cast<std::ptrdiff_t>(begin_[strip + 1]));
  }
  std::size_t place_after(std::size_t strip, double x) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(xs_of(strip), x) - columns_.front().begin());
  }
  std::size_t place_of(std::size_t strip, double x) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(xs_of(strip), x) - columns_.front().begin());
  }

  void count_pairs(std::size_t i, std::size_t begin, std::size_t end) {
    for (; begin < end; begin += kTogether) count_few(i, begin, std::min(kTogether, end - begin));
  }

  void count_few(std::size_t i, std::size_t begin, std::size_t count) {
    std::array<double, kTogether> squares = {};
    for (const std::vector<double>& column : columns_) {
      const double here = column[i];
      const double* there = column.data() + begin;
      for (std::size_t j = 0; j < count; ++j) {
        const double apart = std::abs(there[j] - here);
        const double difference = std::min(apart, 1 - apart);
        squares[j] += difference * difference;
      }
    }
    std::array<std::int32_t, kTogether> bin;
    const auto beyond = static_cast<double>(bins_);  // one bin more, for pairs too far apart
    for (std::size_t j = 0; j < count; ++j)
      bin[j] = static_cast<std::int32_t>(std::min(std::sqrt(squares[j]) * scale_, beyond));
    for (std::size_t j = 0; j < count; ++j) ++counts_[j % kTables * (bins_ + 1) + static_cast<std::size_t>(bin[j])];
  }

  double most_;
  std::size_t bins_;
  double scale_, strips_;
  std::vector<std::uint64_t> counts_;
  std::vector<std::vector<double>> columns_;
  std::vector<std::size_t> begin_;  ///< of each strip, and the end
};

}  // namespace

double usual_most_distance(std::size_t count, std::size_t dims) {
  return std::min(0.5, 10 / std::pow(static_cast<double>(count), 1 / static_cast<double>(dims)));
}

double ball_volume(std::size_t dims, double radius) {
  // V_d = V_(d−2) · 2π r²/d, from V_0 = 1 and V_1 = 2r.
  double volume = dims % 2 == 0 ? 1 : 2 * radius;
  for (std::size_t d = dims % 2 + 2; d <= dims; d += 2)
    volume *= 2 * std::numbers::pi * radius * radius / static_cast<double>(d);
  return volume;
}

std::vector<std::uint64_t> pairs_by_distance(const PointSet& points, const DistanceBins& bins) {
  assert_equal(bins.bins >= 1, true, "bins of a pair correlation");
  assert_equal(bins.most > 0 && bins.most <= 0.5, true, "a pair correlation's distances lie in (0, 1/2]");
  return PairCounter(points, bins).count();
}

std::vector<double> pair_correlation(const PointSet& points, const DistanceBins& bins) {
  assert_equal(points.count() >= 2, true, "a distance between points needs two");
  const std::vector<std::uint64_t> pairs = pairs_by_distance(points, bins);
  const auto n = static_cast<double>(points.count());
  std::vector<double> correlation;
  for (int k = 0; k < bins.bins; ++k) {
    const double shell = ball_volume(points.dims(), bins.edge(k + 1)) - ball_volume(points.dims(), bins.edge(k));
    correlation.push_back(static_cast<double>(pairs[static_cast<std::size_t>(k)]) / (n * (n - 1) / 2 * shell));
  }
  return correlation;
}

}  // namespace halfslope
