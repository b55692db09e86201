#include "samplers/octave_shuffle.h"

#include <algorithm>
#include <bit>

#include "samplers/keyed_hash.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kKeysAt = 0xfffffff0u;  // above the words of every block

/// The block number with each bit below its highest flipped by a random bit of the bits above.
std::uint32_t scrambled_block(std::uint32_t block, std::uint32_t key0, std::uint32_t key1) {
  std::uint32_t flips = 0;
  for (int bit = static_cast<int>(std::bit_width(block)) - 2; bit >= 0; --bit) {
    flips |= keyed_word(block >> (bit + 1), key0, key1) >> 31 << bit;
  }
  return block ^ flips;
}

}  // namespace

void OctaveShuffle::prepare(const WordSource& words, int dim) {
  words_ = words;
  dim_ = dim;
  made_ = 0;
  words_.fill(Draw::kPermutation, dim_, kKeysAt, 2, keys_.data());
}

void OctaveShuffle::rows(std::uint64_t begin, int count, std::uint32_t* indices) {
  for (std::uint64_t i = begin; i < begin + static_cast<std::uint64_t>(count); ++i, indices += kLanes) {
    if (i / kBlock + 1 != made_) make(i / kBlock);
    std::copy_n(order_.data() + i % kBlock * kLanes, kLanes, indices);
  }
}

void OctaveShuffle::make(std::uint64_t block) {
  made_ = block + 1;
  std::array<std::uint32_t, kBlock * kLanes> words;
  words_.fill(Draw::kPermutation, dim_, block * kBlock, static_cast<int>(kBlock), words.data());
  std::array<std::uint32_t, kLanes> base;
  for (std::size_t l = 0; l < kLanes; ++l) {
    base[l] = static_cast<std::uint32_t>(kBlock) *
              scrambled_block(static_cast<std::uint32_t>(block), keys_[l], keys_[kLanes + l]);
  }
  // Fisher and Yates's shuffle from the inside out (see LanePermutation). The first block holds the octaves from 1 to
  // 16, each of which is shuffled by itself.
  for (std::size_t i = 0; i < kBlock; ++i) {
    const std::size_t first = block > 0 ? 0 : std::bit_floor(i);
    for (std::size_t l = 0; l < kLanes; ++l) {
      const std::size_t j = first + ((std::uint64_t{words[i * kLanes + l]} * (i - first + 1)) >> 32);
      order_[i * kLanes + l] = order_[j * kLanes + l];
      order_[j * kLanes + l] = base[l] + static_cast<std::uint32_t>(i);
    }
  }
}

}  // namespace halfslope
