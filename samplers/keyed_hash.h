// Random words at random places: a hash of an index under keys that are words of Philox, in a few instructions. Where
// neighbouring indices are wanted in bulk, WordSource is both better and faster.
#pragma once

#include <cstdint>

namespace halfslope {

/// A 32-bit finaliser with low bias (constants: C. Wellons's exhaustive search, "hash prospector").
inline std::uint32_t mix32(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x21f0aaadu;
  x = (x ^ (x >> 15)) * 0x735a2d97u;
  return x ^ (x >> 15);
}

/// A random word of (keys, index): two keyed rounds.
inline std::uint32_t keyed_word(std::uint32_t index, std::uint32_t key0, std::uint32_t key1) {
  return mix32(mix32(index ^ key0) + key1);
}

/// Two random words of (keys, index) at once: two keyed rounds of splitmix64's finaliser (G. Steele, D. Lea & C. Flood,
/// "Fast splittable pseudorandom number generators", 2014).
inline std::uint64_t keyed_pair(std::uint64_t index, std::uint64_t key0, std::uint64_t key1) {
  const auto mix = [](std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  };
  return mix(mix(index ^ key0) + key1);
}

}  // namespace halfslope
