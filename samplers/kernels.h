// The vectorised loops of samplers: plain data across the border to an instruction set's library.
#pragma once

#include <cstdint>

namespace halfslope {

/// Counter and key of a block of random words; see core/random.h.
struct WordStream {
  std::uint32_t key0, key1;
  std::uint32_t pixel, replicate;  ///< lane l is replicate + l
};

/// What the scrambled Halton kernel needs of one dimension.
struct HaltonDim {
  std::uint32_t base;
  std::uint32_t table_digits;  ///< the table holds the first base^table_digits points
  const double* table;         ///< [point][kLanes]
  const std::uint32_t* keys;   ///< [4][kLanes]
};

/// Consecutive points of one dimension of the Sobol' sequence (samplers/sobol_sequence.h).
struct SobolRun {
  const std::uint32_t* steps;  ///< [32]: an index that ends in c ones is followed by the point exclusive or steps[c]
  std::uint32_t begin;         ///< the first index
  std::uint32_t first;         ///< the first point
};

/// What exact nested scrambling in base 2 needs of one dimension.
struct OwenTree {
  const std::uint32_t* keys;   ///< [2][kLanes]
  const std::uint32_t* table;  ///< [2^table_digits][kLanes]: the scrambled words of k · 2^(32 − table_digits)
  std::uint32_t table_digits;
};

struct SamplerKernels {
  static constexpr const char* kSymbol = "halfslope_sampler_kernels";

  /// Random words of dimension `dim` at indices begin … begin + count − 1: count × kLanes words, each shifted right by
  /// `shift`. Four consecutive indices share one call of Philox, so no word is wasted.
  void (*random_words)(const WordStream& stream, std::uint32_t draw, std::uint32_t dim, std::uint32_t begin, int count,
                       int shift, std::uint32_t* out);
  /// Scrambled radical inverses of `count` indices in one dimension, as high words and (unless null) low words.
  void (*halton_owen)(const HaltonDim& dim, const std::uint32_t* indices, int count, std::uint32_t* high,
                      std::uint32_t* low);
  /// The first `count` points as binary64, for the table.
  void (*halton_owen_table)(std::uint32_t base, const std::uint32_t* keys, std::uint32_t count, double* out);
  /// High words of `count` Sobol' points under exact nested scrambling, and the table for it.
  void (*sobol_owen)(const SobolRun& run, const OwenTree& tree, int count, std::uint32_t* high);
  void (*sobol_owen_table)(const std::uint32_t* keys, std::uint32_t digits, std::uint32_t* out);
  /// High words of `count` Sobol' points under nested scrambling by hash. `run` has its digits the other way round, the
  /// first at the bottom; `keys` is [2][kLanes].
  void (*sobol_owen_fast)(const SobolRun& run, const std::uint32_t* keys, int count, std::uint32_t* high);
};

}  // namespace halfslope
