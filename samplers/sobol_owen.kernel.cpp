// Exact nested uniform scrambling in base 2 (A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995),
// kLanes replicates at a time, one random word for each digit 1 of a point.
//
// A point is 32 digits y, the first on top. Nested scrambling flips digit k by a fair coin of the node (k, the k digits
// above it), all coins independent. Each node lies on exactly one path of zeros: strip the zeros at the end of the
// digits above it, and what is left, z, is where that path leaves the 1s. So hand the coins of each path out together:
// the digits of one uniform word W(z) below the lowest 1 of z (all 32 digits for z = 0) are the coins of the nodes (k,
// z's digits and then zeros). W(z) = a hash of z for every z, so the coins of all 2³² − 1 nodes are handed out once
// each, and the joint law of all scrambled points is that of the definition:
//   S(0) = W(0);
//   for y > 0 let bit k be its lowest 1 and z be y without it. The first k digits of S(y) are those of S(z), since they
//   share these nodes; digit k is the other one than that of S(z), since y has the other digit at the same node; and on
//   the digits below, where y has zeros, S(y) is W(y) itself.
// Nothing here depends on which digital sequence y comes from. All lanes have the same y, so which steps are taken is
// uniform over them, and in a block of 2^t consecutive Sobol' points nearly uniform over points too: their digits below
// the first t are the same.
#include "core/point_block.h"
#include "samplers/kernel_functions.h"
#include "samplers/keyed_hash.h"

namespace halfslope::kernel {
namespace {

// S(y) from S(y without `bit`), y's lowest 1, in all lanes.
inline void step(std::uint32_t y, std::uint32_t bit, const std::uint32_t* __restrict keys,
                 const std::uint32_t* __restrict from, std::uint32_t* __restrict to) {
  const std::uint32_t below = bit - 1;
  for (int l = 0; l < kLanes; ++l) {
    to[l] = ((from[l] ^ bit) & ~below) | (keyed_word(y, keys[l], keys[kLanes + l]) & below);
  }
}

}  // namespace

void sobol_owen_table(const std::uint32_t* keys, std::uint32_t digits, std::uint32_t* out) {
  for (int l = 0; l < kLanes; ++l) out[l] = keyed_word(0, keys[l], keys[kLanes + l]);
  for (std::uint32_t k = 1; k < 1u << digits; ++k) {
    const std::uint32_t y = k << (32 - digits);
    step(y, y & (0 - y), keys, out + std::size_t{k & (k - 1)} * kLanes, out + std::size_t{k} * kLanes);
  }
}

void sobol_owen(const SobolRun& run, const OwenTree& tree, int count, std::uint32_t* high) {
  std::uint32_t y = run.first, index = run.begin;
  for (int s = 0; s < count; ++s, ++index) {
    const std::uint32_t* row = tree.table + (std::uint64_t{y} >> (32 - tree.table_digits)) * kLanes;
    alignas(64) std::uint32_t x[kLanes];
    for (int l = 0; l < kLanes; ++l) x[l] = row[l];
    for (std::uint32_t rest = y & (0xffffffffu >> tree.table_digits); rest > 0;) {
      const std::uint32_t bit = 0x80000000u >> __builtin_clz(rest);
      rest ^= bit;
      alignas(64) std::uint32_t next[kLanes];
      step(y ^ rest, bit, tree.keys, x, next);
      for (int l = 0; l < kLanes; ++l) x[l] = next[l];
    }
    std::uint32_t* out = high + std::size_t{static_cast<unsigned>(s)} * kLanes;
    for (int l = 0; l < kLanes; ++l) out[l] = x[l];
    y ^= run.steps[__builtin_ctz(~index)];
  }
}

}  // namespace halfslope::kernel
