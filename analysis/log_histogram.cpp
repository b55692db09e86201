#include "analysis/log_histogram.h"

#include <limits>
#include <numeric>

#include "core/error.h"

namespace halfslope {
namespace {

/// Seven bits a byte, least first, the top bit set on all bytes but the last (LEB128).
void append_varint(std::vector<std::byte>& bytes, std::uint64_t value) {
  for (; value >= 128; value >>= 7) bytes.push_back(static_cast<std::byte>(value | 128));
  bytes.push_back(static_cast<std::byte>(value));
}

std::uint64_t read_varint(std::span<const std::byte>& cursor) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    if (cursor.empty()) fail(ExitCode::kBadInput, "a stored histogram ends too early");
    const auto byte = std::to_integer<std::uint64_t>(cursor.front());
    cursor = cursor.subspan(1);
    if (shift == 63 && byte > 1) break;
    value |= (byte & 127) << shift;
    if (byte < 128) return value;
  }
  fail(ExitCode::kBadInput, "a stored histogram has a number of more than 64 bits");
}

}  // namespace

template <class Visit>
void LogHistogram::for_each_bin(Visit visit) const {
  for (std::size_t octave = 0; octave < page_of_octave_.size(); ++octave) {
    if (page_of_octave_[octave] < 0) continue;
    const auto page = 64 * static_cast<std::size_t>(page_of_octave_[octave]);
    for (std::size_t i = 0; i < 64; ++i) {
      const int index = (first_octave_ + static_cast<int>(octave)) * 64 + static_cast<int>(i);
      if (counts_[page + i] != 0 && !visit(index, counts_[page + i])) return;
    }
  }
}

std::uint64_t& LogHistogram::new_bin(int index) {
  const int octave = index >> 6;
  if (page_of_octave_.empty()) first_octave_ = octave;
  if (octave < first_octave_) {
    page_of_octave_.insert(page_of_octave_.begin(), static_cast<std::size_t>(first_octave_ - octave), std::int16_t{-1});
    first_octave_ = octave;
  }
  const auto slot = static_cast<std::size_t>(octave - first_octave_);
  if (slot >= page_of_octave_.size()) page_of_octave_.resize(slot + 1, -1);
  page_of_octave_[slot] = static_cast<std::int16_t>(counts_.size() / 64);
  counts_.resize(counts_.size() + 64);
  return bin(index);
}

void LogHistogram::merge(const LogHistogram& other) {
  zeros_ += other.zeros_;
  nonfinite_ += other.nonfinite_;
  if (this == &other) {
    for (std::uint64_t& count : counts_) count *= 2;
    return;
  }
  other.for_each_bin([this](int index, std::uint64_t count) {
    bin(index) += count;
    return true;
  });
}

std::uint64_t LogHistogram::count() const {
  return std::accumulate(counts_.begin(), counts_.end(), zeros_ + nonfinite_);
}

double LogHistogram::quantile(double q) const {
  const std::uint64_t total = count();
  if (total == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(total))));
  if (rank <= zeros_) return 0;
  std::uint64_t below = zeros_;
  double value = std::numeric_limits<double>::infinity();
  for_each_bin([&](int index, std::uint64_t count) {
    below += count;
    if (below >= rank) value = log_bins::centre_of(index);
    return below < rank;
  });
  return value;
}

// zeros, non-finite values, number of bins, then each bin: steps from the last one (the first from kMinBin), its count.
void LogHistogram::append_to(std::vector<std::byte>& bytes) const {
  std::uint64_t bins = 0;
  for_each_bin([&](int, std::uint64_t) { return ++bins, true; });
  append_varint(bytes, zeros_);
  append_varint(bytes, nonfinite_);
  append_varint(bytes, bins);
  int last = log_bins::kMinBin;
  for_each_bin([&](int index, std::uint64_t count) {
    append_varint(bytes, static_cast<std::uint64_t>(index - last));
    append_varint(bytes, count);
    last = index;
    return true;
  });
}

LogHistogram LogHistogram::read(std::span<const std::byte>& cursor) {
  LogHistogram histogram;
  histogram.zeros_ = read_varint(cursor);
  histogram.nonfinite_ = read_varint(cursor);
  const std::uint64_t bins = read_varint(cursor);
  std::uint64_t index = 0;  // from kMinBin
  for (std::uint64_t i = 0; i < bins; ++i) {
    const std::uint64_t step = read_varint(cursor), count = read_varint(cursor);
    if (step > std::uint64_t{log_bins::kMaxBin - log_bins::kMinBin} - index || (i > 0 && step == 0) || count == 0) {
      fail(ExitCode::kBadInput, "a stored histogram has bins out of order or range");
    }
    index += step;
    histogram.bin(log_bins::kMinBin + static_cast<int>(index)) = count;
  }
  return histogram;
}

}  // namespace halfslope
