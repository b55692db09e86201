// One dimension of nested-scrambled radical inverses, shared by the samplers that are made of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "samplers/word_source.h"

namespace halfslope {

class ScrambledInverse {
 public:
  /// Ready for the first `count` indices in `base`, kLanes scrambles at a time, keyed by the words of dimension `dim`.
  void prepare(const WordSource& words, int dim, std::uint32_t base, std::uint64_t count);
  /// Points begin … begin + block.samples() − 1 into dimension `dim` of the block.
  void fill(std::uint64_t begin, PointBlock& block, int dim);
  /// The radical inverses of block.samples() indices, in any order, all below the count.
  void fill(std::span<const std::uint32_t> indices, PointBlock& block, int dim) const;

  /// The most points there are in a base: the kernel holds a point's digits in 31 bits, so it is the largest power up
  /// to 2³¹.
  static std::uint64_t most_points_in(std::uint32_t base);
  /// The least of that over the first `bases` primes.
  static std::uint64_t most_points(int bases);

 private:
  std::array<std::uint32_t, 4 * kLanes> keys_;
  AlignedBuffer<double> table_;
  std::vector<std::uint32_t> indices_;
  std::uint32_t base_ = 2, table_digits_ = 0;
  const SamplerKernels* kernels_ = nullptr;
};

}  // namespace halfslope
