// A mergeable histogram of magnitudes over the whole range of binary64.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/log_bins.h"

namespace halfslope {

/// Counts |e| in 64 bins an octave, all equally wide on the logarithmic scale, from the least subnormal to the largest
/// number; zeros and non-finite values are counted apart. Memory grows by 512 bytes for each octave touched. Merging is
/// exact: whatever the order and the grouping, counts and serialised bytes are the same.
///
/// A quantile is a bin's geometric centre, so within 2^(1/128) − 1 = 0.543 % of the value that it stands for.
class LogHistogram {
 public:
  /// Adds |value|.
  void add(double value) {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(value) & ~(std::uint64_t{1} << 63);
    if (bits - 1 < log_bins::kInfinityBits - 1) [[likely]] {
      ++bin(log_bins::bin_of(bits));
    } else {
      ++(bits == 0 ? zeros_ : nonfinite_);
    }
  }
  void add(std::span<const double> values) {
    for (const double value : values) add(value);
  }
  void merge(const LogHistogram& other);

  std::uint64_t count() const;  ///< of everything added
  std::uint64_t zeros() const { return zeros_; }
  std::uint64_t nonfinite() const { return nonfinite_; }

  /// The value of rank ⌈q·n⌉ (at least 1) among all n = count() values in ascending order, as its bin's centre; 0 among
  /// the zeros, infinity among the non-finite values, which come last; NaN where n = 0. q is in [0, 1].
  double quantile(double q) const;
  double median() const { return quantile(0.5); }

  /// Appends the counts, compactly, touched bins only. Equal counts give equal bytes.
  void append_to(std::vector<std::byte>& bytes) const;
  /// Reads what append_to wrote and moves the cursor behind it. Throws Error(kBadInput) if the bytes are anything else.
  static LogHistogram read(std::span<const std::byte>& cursor);

 private:
  /// The counter of a bin, made if need be.
  std::uint64_t& bin(int index) {
    const int octave = (index >> 6) - first_octave_;
    if (static_cast<std::size_t>(octave) >= page_of_octave_.size() ||
        page_of_octave_[static_cast<std::size_t>(octave)] < 0) [[unlikely]] {
      return new_bin(index);
    }
    const auto page = static_cast<std::size_t>(page_of_octave_[static_cast<std::size_t>(octave)]);
    return counts_[64 * page + static_cast<std::size_t>(index & 63)];
  }
  std::uint64_t& new_bin(int index);
  /// Calls visit(bin index, count) for every bin that is not empty, ascending, while it returns true.
  template <class Visit>
  void for_each_bin(Visit visit) const;

  std::uint64_t zeros_ = 0, nonfinite_ = 0;
  int first_octave_ = 0;                      ///< of page_of_octave_, an unbroken run of octaves
  std::vector<std::int16_t> page_of_octave_;  ///< which 64 counters are the octave's; −1 for none yet
  std::vector<std::uint64_t> counts_;
};

}  // namespace halfslope
