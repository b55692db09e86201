// Plain values as bytes and back, for records that only this program reads.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "core/error.h"

namespace halfslope {

template <class T>
void append_bytes(std::vector<std::byte>& bytes, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto raw = std::as_bytes(values);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}
template <class T>
void append_bytes(std::vector<std::byte>& bytes, const T& value) {
  append_bytes(bytes, std::span<const T>(&value, 1));
}

/// Reads `count` values and moves the cursor behind them; Error(kBadInput) if there are not that many.
template <class T>
std::vector<T> take_bytes(std::span<const std::byte>& cursor, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (cursor.size() / sizeof(T) < count) fail(ExitCode::kBadInput, "a record is shorter than its contents");
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), cursor.data(), count * sizeof(T));
  cursor = cursor.subspan(count * sizeof(T));
  return values;
}
template <class T>
T take_bytes(std::span<const std::byte>& cursor) {
  return take_bytes<T>(cursor, 1).front();
}

}  // namespace halfslope
