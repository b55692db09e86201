// The random words of one request, a block at a time.
#pragma once

#include "core/kernel_library.h"
#include "samplers/kernels.h"
#include "samplers/sampler.h"

namespace halfslope {

/// Dimensions that a stream of random words can tell apart.
inline constexpr int kMaxWordDims = 1 << 28;

class WordSource {
 public:
  void prepare(const PointRequest& request) {
    // Not before: a catalogue of samplers must not need kernels.
    if (!kernels_) kernels_ = &kernels<SamplerKernels>();
    stream_ = {request.key.word0, request.key.word1, request.pixel, request.replicate};
  }
  /// count × kLanes words of dimension `dim` from index `begin`; `out` lanes fastest.
  void fill(Draw draw, int dim, std::uint64_t begin, int count, std::uint32_t* out) const {
    kernels_->random_words(stream_, static_cast<std::uint32_t>(draw), static_cast<std::uint32_t>(dim),
                           static_cast<std::uint32_t>(begin), count, 0, out);
  }
  /// The 21 random bits below the high word.
  void fill_low(int dim, std::uint64_t begin, int count, std::uint32_t* out) const {
    kernels_->random_words(stream_, static_cast<std::uint32_t>(Draw::kLow), static_cast<std::uint32_t>(dim),
                           static_cast<std::uint32_t>(begin), count, 11, out);
  }

 private:
  WordStream stream_ = {};
  const SamplerKernels* kernels_ = nullptr;
};

}  // namespace halfslope
