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

struct SamplerKernels {
  static constexpr const char* kSymbol = "halfslope_sampler_kernels";

  /// Random words of dimension `dim` at indices begin … begin + count − 1: count × kLanes words, each shifted right by
  /// `shift`. Four consecutive indices share one call of Philox, so no word is wasted.
  void (*random_words)(const WordStream& stream, std::uint32_t draw, std::uint32_t dim, std::uint32_t begin, int count,
                       int shift, std::uint32_t* out);
  /// Scrambled Halton points begin … begin + count − 1 of one dimension, as high words and (unless null) low words.
  void (*halton_owen)(const HaltonDim& dim, std::uint32_t begin, int count, std::uint32_t* high, std::uint32_t* low);
  /// The first `count` points as binary64, for the table.
  void (*halton_owen_table)(std::uint32_t base, const std::uint32_t* keys, std::uint32_t count, double* out);
};

}  // namespace halfslope
