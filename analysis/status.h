// The status column: what a reader of a row must know before trusting its numbers.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace halfslope {

/// Marks in the order they were added, joined by ';'.
class Status {
 public:
  void mark_if(bool condition, std::string_view mark) {
    if (!condition) return;
    if (!text_.empty()) text_ += ';';
    text_ += mark;
  }
  bool ok() const { return text_.empty(); }
  /// "ok" where there are no marks.
  std::string text() const { return ok() ? "ok" : text_; }

 private:
  std::string text_;
};

/// Whether `status`, marks joined by ';', has this one.
inline bool has_mark(std::string_view status, std::string_view mark) {
  for (std::size_t begin = 0, end = 0; begin <= status.size(); begin = end + 1) {
    end = std::min(status.find(';', begin), status.size());
    if (status.substr(begin, end - begin) == mark) return true;
  }
  return false;
}

/// Whether the intervals of a row with this status, if it has any, are as sure as they say.
inline bool is_certified(std::string_view status) {
  return !has_mark(status, "few-replicates") && !has_mark(status, "heavy-tailed");
}

/// Fewer replicates than this, and intervals are not certified.
inline constexpr int kCertifiedReplicates = 16;
/// A reference whose variance is a larger share of the measured mean squared error than this limits the measurement.
inline constexpr double kReferenceShare = 0.1;
/// Mean squared errors below so many times the square of the values' own rounding error may be that error.
inline constexpr double kRoundingReach = 100;

}  // namespace halfslope
