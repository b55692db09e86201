// Exact fractions that are counted up: consecutive radical inverses and consecutive i/N without a division each.
//
// Both are rational numbers over a denominator D that stays the same. Such a number is held as
//   (Q + R/D) · 2⁻⁵³ with integers Q < 2⁵³ and R < D,
// so Q is its first 53 bits, rounded down. The step to the next one is a constant of the same form, known exactly too:
// add the Qs modulo 2⁵³ and the Rs, with a carry from R into Q at D. Nothing is ever rounded, however far one counts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/point_block.h"

namespace halfslope {

/// (quotient + remainder/D) · 2⁻⁵³.
struct ExactFraction {
  std::uint64_t quotient = 0, remainder = 0;

  /// `numerator`/`denominator`, both below 2⁶⁴, the fraction below 1 or (for a step) 1.
  static ExactFraction of(std::uint64_t numerator, std::uint64_t denominator);
  /// This plus `step` modulo 1, both over `denominator` ≤ 2⁶³.
  ExactFraction plus(const ExactFraction& step, std::uint64_t denominator) const {
    const std::uint64_t sum = remainder + step.remainder;
    const bool carry = sum >= denominator;
    constexpr std::uint64_t kBelowOne = (std::uint64_t{1} << 53) - 1;
    return {(quotient + step.quotient + carry) & kBelowOne, carry ? sum - denominator : sum};
  }
};

/// The radical inverses φ_b(0), φ_b(1), … in one base, b < 2¹⁶, for indices up to 2³¹.
///
/// From i to i + 1, where i ends in c digits b − 1: they fall to 0, which takes 1 − b^−c away, and digit c grows by
/// one, which adds b^−(c+1). Modulo 1 that is (b + 1) b^−(c+1), one constant for each c. D = b^t is the least power
/// above 2³¹.
class RadicalCounter {
 public:
  explicit RadicalCounter(std::uint32_t base);
  /// Goes to `index` ≤ 2³¹; costs nothing where it is there already.
  void seek(std::uint64_t index);
  /// ⌊2⁵³ φ_b(index)⌋.
  std::uint64_t bits() const { return at_.quotient; }
  /// To the next index, ≤ 2³¹.
  void next() {
    std::size_t c = 0;
    while (++digits_[c] == base_) digits_[c++] = 0;
    at_ = at_.plus(steps_[c], denominator_);
    ++index_;
  }

 private:
  std::uint32_t base_;
  std::uint64_t index_ = 0, denominator_ = 1;
  ExactFraction at_;
  std::vector<ExactFraction> steps_;
  std::vector<std::uint16_t> digits_;
};

/// The fractions 0/N, 1/N, … (N−1)/N.
class EvenCounter {
 public:
  /// N = count, 1 ≤ N ≤ 2³¹; at index 0.
  void reset(std::uint64_t count);
  /// Goes to `index` < N; costs nothing where it is there already.
  void seek(std::uint64_t index);
  /// ⌊2⁵³ index/N⌋.
  std::uint64_t bits() const { return at_.quotient; }
  /// To the next index.
  void next() {
    at_ = at_.plus(step_, count_);
    ++index_;
  }

 private:
  std::uint64_t index_ = 0, count_ = 1;
  ExactFraction at_, step_;
};

/// Points `begin` … of a counter into dimension `dim` of the block, the same in every lane.
template <class Counter>
void fill_lanes(Counter& counter, std::uint64_t begin, PointBlock& block, int dim) {
  counter.seek(begin);
  std::uint32_t *high = block.high(dim), *low = block.low(dim);
  for (int s = 0; s < block.samples(); ++s, high += kLanes) {
    const std::uint64_t bits = counter.bits();
    std::fill_n(high, kLanes, static_cast<std::uint32_t>(bits >> 21));
    if (low) {
      std::fill_n(low, kLanes, static_cast<std::uint32_t>(bits & 0x1fffff));
      low += kLanes;
    }
    counter.next();
  }
}

}  // namespace halfslope
