// Counter-based random numbers: every (seed, sampler, replicate, pixel, dimension) stands alone, so order, threads and
// shards cannot matter. J. K. Salmon and others, "Parallel random numbers: as easy as 1, 2, 3", SC 2011.
#pragma once

#include <Random123/philox.h>

#include <cstdint>
#include <string_view>

namespace halfslope {

/// The 64-bit Philox key of one stream of random numbers.
struct StreamKey {
  std::uint32_t word0 = 0, word1 = 0;
  bool operator==(const StreamKey&) const = default;
};

/// The key of (seed, sampler, purpose). `purpose` keeps apart what must never share numbers: "run", "reference", ….
StreamKey stream_key(std::uint64_t seed, std::string_view sampler, std::string_view purpose);

/// What a word of a stream is for; part of the counter, so kinds never overlap.
enum class Draw : std::uint32_t { kHigh = 0, kLow = 1, kPermutation = 2, kScramble = 3 };

/// Word `index` of dimension `dim` of the stream at (replicate, pixel). Four consecutive indices share one call.
inline std::uint32_t random_word(StreamKey key, Draw draw, std::uint32_t dim, std::uint32_t index,
                                 std::uint32_t replicate, std::uint32_t pixel) {
  const r123::Philox4x32::ctr_type counter = {
      {index / 4, replicate, pixel, dim | (static_cast<std::uint32_t>(draw) << 28)}};
  const r123::Philox4x32::key_type philox_key = {{key.word0, key.word1}};
  return r123::Philox4x32()(counter, philox_key)[index % 4];
}

/// 64-bit hash of a text (FNV-1a, finished by splitmix64): seeds bootstraps by a cell's name.
std::uint64_t hash_text(std::string_view text, std::uint64_t seed = 0);

}  // namespace halfslope
