// What evaluating samples emits, and what heuristics fold.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/point_block.h"

namespace halfslope {

/// Terms of a block of points. A round of samples has one slot for each sample of each technique; a slot's term at a
/// point is its unweighted contribution f/p_i (per channel; 0 where the sample is worth nothing) and the densities
/// p_1 … p_n of every technique of the set at the sample, in one measure. Arrays are samples × kLanes, lanes fastest.
template <class T>
class TermBlock {
 public:
  void reset(int slots, int channels, int densities, int samples) {
    channels_ = channels;
    densities_ = densities;
    stride_ = static_cast<std::size_t>(samples) * kLanes;
    data_.resize(static_cast<std::size_t>(slots * (channels + densities)) * stride_);
  }
  /// f / p_i, channel c of slot q.
  T* value(int slot, int channel) { return at(slot, channel); }
  /// The density of the set's k-th technique at slot q's sample.
  T* pdf(int slot, int k) { return at(slot, channels_ + k); }
  std::size_t stride() const { return stride_; }
  int channels() const { return channels_; }
  int densities() const { return densities_; }
  T* data() { return data_.data(); }

 private:
  T* at(int slot, int row) {
    return data_.data() + static_cast<std::size_t>(slot * (channels_ + densities_) + row) * stride_;
  }
  int channels_ = 1, densities_ = 0;
  std::size_t stride_ = 0;
  AlignedBuffer<T> data_;
};

}  // namespace halfslope
