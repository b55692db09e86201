// Equal strata of [0, 1) in 32-bit fixed point, and shuffles of them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "samplers/word_source.h"

namespace halfslope {

/// Splits [0, 1) into `count` strata whose edges are rounded up to multiples of 2⁻³², so that a point drawn inside a
/// stratum stays inside it to the last bit.
class Strata {
 public:
  /// 1 ≤ count ≤ 2³¹; costs nothing when the count is the same as last time.
  void reset(std::uint64_t count);
  /// The high word at fraction `word` · 2⁻³² of stratum `index` < count.
  std::uint32_t place(std::uint64_t index, std::uint32_t word) const {
    const std::uint64_t lower = edge(index), upper = edge(index + 1);
    return static_cast<std::uint32_t>(lower + (((upper - lower) * word) >> 32));
  }
  /// place() for each lane: words[l] becomes the high word at fraction words[l] of stratum cells[l].
  void place_lanes(const std::uint32_t* cells, std::uint32_t* words) const {
    const int shift = shift_;  // the compiler must take it that a word written could be the member
    if (shift > 0) {           // a power of two: the stratum is the upper bits
      for (int l = 0; l < kLanes; ++l) words[l] = (cells[l] << shift) + (words[l] >> (32 - shift));
    } else {
      for (int l = 0; l < kLanes; ++l) words[l] = place(cells[l], words[l]);
    }
  }
  /// place() for each lane of the same stratum.
  void place_row(std::uint64_t index, std::uint32_t* words) const {
    if (count_ == 1) return;  // all of [0, 1), whose width 32 bits do not hold
    const auto lower = static_cast<std::uint32_t>(edge(index));
    const int shift = shift_;
    if (shift > 0) {
      for (int l = 0; l < kLanes; ++l) words[l] = lower + (words[l] >> (32 - shift));
      return;
    }
    const auto width = static_cast<std::uint32_t>(edge(index + 1) - lower);
    for (int l = 0; l < kLanes; ++l) {
      words[l] = lower + static_cast<std::uint32_t>((std::uint64_t{width} * words[l]) >> 32);
    }
  }

 private:
  static constexpr std::uint64_t kTabled = 4096;  // a division would cost more than the rest of a coordinate
  std::uint64_t edge(std::uint64_t index) const { return count_ <= kTabled ? edges_[index] : exact_edge(index); }
  std::uint64_t exact_edge(std::uint64_t index) const { return ((index << 32) + count_ - 1) / count_; }

  std::uint64_t count_ = 0;
  int shift_ = 0;  ///< 32 − log2(count) for the powers of two from 2, else 0
  std::vector<std::uint64_t> edges_;
};

/// Where `index` < count goes under a permutation of 0 … count − 1 that four keys choose: a keyed bijection of the next
/// power of two that is walked until it falls inside (A. Kensler, "Correlated multi-jittered sampling", 2013, §4, with
/// four keyed rounds). 1 ≤ count ≤ 2³¹.
std::uint64_t keyed_permutation(std::uint64_t index, std::uint64_t count, const std::array<std::uint32_t, 4>& keys);

/// A uniformly random permutation of 0 … count − 1 in each lane, from words of Draw::kPermutation.
///
/// Up to kShuffled elements by Fisher and Yates's shuffle, exactly uniform and held in memory. Above, where no
/// experiment could tell the difference and memory must not grow, by keyed_permutation().
class LanePermutation {
 public:
  static constexpr std::uint64_t kShuffled = 4096;

  /// From the words of dimension `dim` at `first` and on, kShuffled of them at most.
  void prepare(const WordSource& words, int dim, std::uint64_t count, std::uint64_t first = 0);
  std::uint64_t at(std::uint64_t index, int lane) const {
    if (count_ <= kShuffled) return table_[index * kLanes + static_cast<std::size_t>(lane)];
    return walk(index, lane);
  }
  /// at() for each lane.
  void lanes(std::uint64_t index, std::uint32_t* out) const {
    for (int l = 0; l < kLanes; ++l) out[l] = static_cast<std::uint32_t>(at(index, l));
  }

 private:
  std::uint64_t walk(std::uint64_t index, int lane) const;

  std::uint64_t count_ = 0;
  std::vector<std::uint16_t> table_;  // [index][lane]
  std::vector<std::uint32_t> words_;
  std::uint32_t keys_[4 * kLanes] = {};
};

}  // namespace halfslope
