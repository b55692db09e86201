// Shuffles of a sequence that keep its prefixes.
#pragma once

#include <array>
#include <cstdint>

#include "samplers/word_source.h"

namespace halfslope {

/// A random order of the points of a sequence, one in each lane, that depends on no number of points: every octave
/// [2^k, 2^{k+1}) is permuted within itself, so that the first 2^m points are the same set in any order.
///
/// Within an octave, blocks of kBlock points are permuted by nested scrambling of the block's number, bit by bit from
/// the top, so an aligned run of 2^m points goes to an aligned run: what begins an octave is as good a part of it as it
/// was. Within a block the order is uniform. Nested down to the last bit it would pair each two neighbours with two
/// neighbours; since the neighbours of a (0, 2)-sequence lie in opposite halves, that would leave a product of
/// coordinates of two shuffled groups with 1.6 times the variance of independent points.
class OctaveShuffle {
 public:
  static constexpr std::uint64_t kBlock = 16;

  /// Keyed by the words Draw::kPermutation of dimension `dim`.
  void prepare(const WordSource& words, int dim);
  /// The indices that begin … begin + count − 1 go to: count × kLanes, lanes fastest. begin + count ≤ 2³¹.
  void rows(std::uint64_t begin, int count, std::uint32_t* indices);

 private:
  void make(std::uint64_t block);

  WordSource words_;
  int dim_ = 0;
  std::uint64_t made_ = 0;  ///< the block at hand, plus 1
  std::array<std::uint32_t, 2 * kLanes> keys_;
  std::array<std::uint32_t, kBlock * kLanes> order_;
};

}  // namespace halfslope
