#include "samplers/strata.h"

#include <algorithm>
#include <bit>

namespace halfslope {

void Strata::reset(std::uint64_t count) {
  if (count == count_) return;
  count_ = count;
  shift_ = count > 1 && std::has_single_bit(count) ? 32 - std::countr_zero(count) : 0;
  if (count > kTabled) return;
  edges_.resize(count + 1);
  for (std::uint64_t i = 0; i <= count; ++i) edges_[i] = exact_edge(i);
}

void LanePermutation::prepare(const WordSource& words, int dim, std::uint64_t count, std::uint64_t first) {
  count_ = count;
  if (count > kShuffled) {
    words.fill(Draw::kPermutation, dim, first, 4, keys_);
    return;
  }
  table_.resize(std::max<std::size_t>(table_.size(), count * kLanes));
  constexpr std::uint64_t kChunk = 64;
  words_.resize(kChunk * kLanes);
  for (std::uint64_t begin = 0; begin < count; begin += kChunk) {
    const auto chunk = static_cast<int>(std::min(kChunk, count - begin));
    words.fill(Draw::kPermutation, dim, first + begin, chunk, words_.data());
    // The shuffle from the inside out: element i goes to a uniform place j ≤ i, and what was there moves to i. Lanes
    // are the inner loop, since one lane's steps wait for each other.
    for (std::uint64_t s = 0; s < static_cast<std::uint64_t>(chunk); ++s) {
      const std::uint64_t i = begin + s;
      for (std::uint64_t lane = 0; lane < kLanes; ++lane) {
        const std::uint64_t j = (words_[s * kLanes + lane] * (i + 1)) >> 32;
        table_[i * kLanes + lane] = table_[j * kLanes + lane];
        table_[j * kLanes + lane] = static_cast<std::uint16_t>(i);
      }
    }
  }
}

std::uint64_t LanePermutation::walk(std::uint64_t index, int lane) const {
  const std::uint32_t* keys = keys_ + lane;
  return keyed_permutation(index, count_, {keys[0], keys[kLanes], keys[2 * kLanes], keys[3 * kLanes]});
}

std::uint64_t keyed_permutation(std::uint64_t index, std::uint64_t count, const std::array<std::uint32_t, 4>& keys) {
  if (count == 1) return 0;
  const int bits = static_cast<int>(std::bit_width(count - 1));
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  const int half = (bits + 1) / 2;
  std::uint64_t x = index;
  do {
    // Each round adds a key, multiplies by an odd keyed number and folds the upper half down: all invertible on `bits`.
    for (const std::uint32_t key : keys) {
      x = (x + key) & mask;
      x = (x * ((key << 1 | 1u) ^ 0x6c50b47cu)) & mask;
      x ^= x >> half;
      x = (x * 0x9e3779b1u) & mask;
      x ^= x >> (half + 1);
    }
  } while (x >= count);
  return x;
}

}  // namespace halfslope
