// Point sets of the unit square, and what padded() (samplers/padded.h) needs of one to give it any dimensions.
#pragma once

#include <cstdint>
#include <optional>

#include "samplers/sampler.h"

namespace halfslope {

/// Rows of points that are asked of a PairSet: row s of lane l is the set's point indices[s · kLanes + l].
struct PairRows {
  std::uint64_t begin;  ///< the sampler's index of the first row, to key what belongs to a row and not to a point
  int rows;
  const std::uint32_t* indices;
  std::uint32_t *x, *y;  ///< high words to fill; y is null where only the first coordinate is wanted
  /// 21-bit low words, or null. They come filled with random bits, which is right for points that are random below the
  /// high word; others overwrite them.
  std::uint32_t *low_x, *low_y;
};

/// The words of Draw::kPermutation from here on may be used by a set that is no sequence.
inline constexpr std::uint64_t kSetWords = std::uint64_t{1} << 16;

/// One randomisation of a two-dimensional point set for each of kLanes replicates.
class PairSet {
 public:
  virtual ~PairSet() = default;
  /// Whether a set of `count` points exists; if not, the legal counts next to it.
  virtual std::optional<LegalNeighbours> illegal(std::uint64_t count) const {
    (void)count;
    return std::nullopt;
  }
  /// Makes ready `request.count` points. All of their random words belong to dimension `dim`, the first of a group
  /// (only what is for y alone may belong to `dim` + 1); those of Draw::kPermutation below kSetWords are the padding's,
  /// and the low words' too.
  virtual void prepare(const PointRequest& request, int dim) = 0;
  virtual void points(const PairRows& rows) = 0;
};

}  // namespace halfslope
