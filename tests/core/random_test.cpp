#include "core/random.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

namespace halfslope {
namespace {

TEST(RandomWord, IsPhilox4x32AsPublished) {
  // Known answers of Philox 4×32-10 that come with Random123 (Salmon and others 2011): counters 0, and the digits of π.
  constexpr std::uint32_t kZero[] = {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8};
  constexpr std::uint32_t kPi[] = {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
  for (std::uint32_t w = 0; w < 4; ++w) {
    EXPECT_EQ(random_word({0, 0}, Draw::kHigh, 0, w, 0, 0), kZero[w]);
    EXPECT_EQ(
        random_word({0xa4093822, 0x299f31d0}, Draw::kHigh, 0x03707344, 0x243f6a88u * 4 + w, 0x85a308d3, 0x13198a2e),
        kPi[w]);
  }
}

TEST(RandomWord, EveryPartOfItsNameMatters) {
  const auto word = [](std::uint32_t dim, std::uint32_t index, std::uint32_t replicate, std::uint32_t pixel,
                       Draw draw) {
    return random_word({1, 2}, draw, dim, index, replicate, pixel);
  };
  // 3⁴ · 4 names; that two of 324 words coincide by chance has probability 324²/2/2³² = 1.2e-5, and the key is fixed.
  std::set<std::uint32_t> words;
  for (std::uint32_t i = 0; i < 81; ++i) {
    for (const Draw draw : {Draw::kHigh, Draw::kLow, Draw::kPermutation, Draw::kScramble}) {
      words.insert(word(i % 3, i / 3 % 3 * 2, i / 9 % 3, i / 27, draw));
    }
  }
  EXPECT_EQ(words.size(), 324u);
}

TEST(StreamKey, TellsSeedsSamplersAndPurposesApart) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> keys;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    for (const char* sampler : {"halton", "halton-owen", ""}) {
      for (const char* purpose : {"run", "reference", ""}) {
        const StreamKey key = stream_key(seed, sampler, purpose);
        keys.emplace(key.word0, key.word1);
        EXPECT_EQ(key, stream_key(seed, sampler, purpose));
      }
    }
  }
  keys.emplace(stream_key(1, "ab", "c").word0, stream_key(1, "ab", "c").word1);
  keys.emplace(stream_key(1, "a", "bc").word0, stream_key(1, "a", "bc").word1);
  keys.emplace(stream_key(~std::uint64_t{0}, "", "").word0, stream_key(~std::uint64_t{0}, "", "").word1);
  EXPECT_EQ(keys.size(), 9003u);  // 64-bit keys: by chance 1e-12
}

TEST(HashText, SpreadsOverAll64Bits) {
  // Of 4096 hashes each bit is set in half: 2048 ± 32 · 6; false alarm 64 · 2e-9 = 1.3e-7.
  int set[64] = {};
  for (int i = 0; i < 4096; ++i) {
    const std::uint64_t hash = hash_text("scene/estimator/" + std::to_string(i));
    for (int bit = 0; bit < 64; ++bit) set[bit] += static_cast<int>(hash >> bit & 1);
  }
  for (const int count : set) EXPECT_NEAR(count, 2048, 192);
}

TEST(HashText, SeedsNeverCollideOnOneText) {
  // Each step of the hash is a bijection of 64 bits, so distinct seeds cannot meet.
  std::set<std::uint64_t> hashes;
  for (std::uint64_t seed = 0; seed < 100000; ++seed) hashes.insert(hash_text("veach-mis", seed));
  EXPECT_EQ(hashes.size(), 100000u);
}

}  // namespace
}  // namespace halfslope
