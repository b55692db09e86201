// Points as everything downstream reads them.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

namespace halfslope {

/// Replicates that travel together. Lane l of a block holds replicate `first + l`; a packet of any width divides it, so
/// the scene, the sample index and all control flow are uniform over a packet, N = 1 fills it too, and each replicate's
/// sums run in an order that no packet width can change (docs/decisions/0001-lanes-are-replicates.md).
inline constexpr int kLanes = 16;

/// 64-byte aligned array of T, zero-initialised; sized once and grown on demand.
template <class T>
class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  explicit AlignedBuffer(std::size_t size) { resize(size); }
  void resize(std::size_t size) {
    if (size > capacity_) {
      data_.reset(static_cast<T*>(::operator new (size * sizeof(T), std::align_val_t{64})));
      capacity_ = size;
      for (std::size_t i = 0; i < size; ++i) data_.get()[i] = T{};
    }
    size_ = size;
  }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }

 private:
  struct Free {
    void operator()(T* p) const { ::operator delete (p, std::align_val_t{64}); }
  };
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

/// A block of points: `dims` arrays of `samples` × kLanes coordinates, lanes fastest.
///
/// A coordinate is a 53-bit fixed-point fraction, so it is never 1: a 32-bit high word and a 21-bit low word,
/// x = high · 2⁻³² + low · 2⁻⁵³. Binary32 kernels take the top 24 bits, binary64 kernels all of them; low words are
/// filled only for the latter.
class PointBlock {
 public:
  void reset(int dims, int samples, bool low_words) {
    dims_ = dims;
    samples_ = samples;
    low_words_ = low_words;
    const auto size = static_cast<std::size_t>(dims) * stride();
    high_.resize(size);
    if (low_words) low_.resize(size);
  }
  int dims() const { return dims_; }
  int samples() const { return samples_; }
  bool has_low_words() const { return low_words_; }
  /// Points in the block: samples × kLanes.
  std::size_t stride() const { return static_cast<std::size_t>(samples_) * kLanes; }
  std::uint32_t* high(int dim) { return high_.data() + static_cast<std::size_t>(dim) * stride(); }
  const std::uint32_t* high(int dim) const { return high_.data() + static_cast<std::size_t>(dim) * stride(); }
  /// Null where the block has no low words.
  std::uint32_t* low(int dim) { return low_words_ ? low_.data() + static_cast<std::size_t>(dim) * stride() : nullptr; }
  const std::uint32_t* low(int dim) const {
    return low_words_ ? low_.data() + static_cast<std::size_t>(dim) * stride() : nullptr;
  }
  /// The coordinate as binary64, exact.
  double coordinate(int dim, int sample, int lane) const {
    const std::size_t i = static_cast<std::size_t>(sample) * kLanes + static_cast<std::size_t>(lane);
    return high(dim)[i] * 0x1p-32 + (low_words_ ? low(dim)[i] * 0x1p-53 : 0.0);
  }

 private:
  int dims_ = 0, samples_ = 0;
  bool low_words_ = false;
  AlignedBuffer<std::uint32_t> high_, low_;
};

}  // namespace halfslope
