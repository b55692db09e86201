// Nested scrambling in base 2 by hash, kLanes replicates at a time: one hash a coordinate.
//
// With the first digit at the bottom of the word, additions, multiplications and x ⊕ c·x with even c let each digit
// depend on itself and on those before it alone, so any chain of them that keeps the first digit's weight odd is a
// nested permutation of digits; a good chain with random keys comes near to a uniformly random one (S. Laine & T.
// Karras, "Stratified sampling for stochastic transparency", 2011, section 3.1). The constants and their order are N.
// Vegdahl's ("Building a better LK hash", 2021), found by search: those of B. Burley ("Practical hash-based Owen
// scrambling", 2020) leave the coins of neighbouring nodes correlated by up to ½. The number added and the one
// multiplied are two words here, not one and its upper half, so that a key has 63 bits: among a million keys of 32
// bits, of pixels, replicates and dimensions, more than a hundred would be met twice.
#include "core/point_block.h"
#include "samplers/kernel_functions.h"

namespace halfslope::kernel {
namespace {

inline std::uint32_t swapped(std::uint32_t x, int by, std::uint32_t mask) {
  return ((x >> by) & mask) | ((x << by) & ~mask);
}

}  // namespace

void sobol_owen_fast(const SobolRun& run, const std::uint32_t* keys, int count, std::uint32_t* high) {
  // Copies, since the compiler must take it that a word written could be a key.
  alignas(64) std::uint32_t add[kLanes], multiply[kLanes], steps[32];
  for (int l = 0; l < kLanes; ++l) add[l] = keys[l];
  for (int l = 0; l < kLanes; ++l) multiply[l] = keys[kLanes + l] | 1u;
  for (int c = 0; c < 32; ++c) steps[c] = run.steps[c];
  std::uint32_t y = run.first, index = run.begin;
  for (int s = 0; s < count; ++s, ++index, high += kLanes) {
    const std::uint32_t n = y ^ (y * 0x3d20adeau);
    for (int l = 0; l < kLanes; ++l) {
      std::uint32_t x = (n + add[l]) * multiply[l];
      x ^= x * 0x05526c56u;
      x ^= x * 0x53a22864u;
      x = __builtin_bswap32(x);
      x = swapped(x, 4, 0x0f0f0f0fu);
      x = swapped(x, 2, 0x33333333u);
      high[l] = swapped(x, 1, 0x55555555u);
    }
    y ^= steps[__builtin_ctz(~index)];
  }
}

}  // namespace halfslope::kernel
