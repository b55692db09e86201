#include "core/numbers.h"

#include <array>
#include <charconv>
#include <cmath>

namespace halfslope {
namespace {

template <class T>
std::string to_text(T value) {
  std::array<char, 32> buffer;  // the longest binary64 takes 24 characters, the longest integer 20
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

}  // namespace

std::string format_number(double value) { return std::isnan(value) ? "nan" : to_text(value); }
std::string format_integer(std::int64_t value) { return to_text(value); }
std::string format_integer(std::uint64_t value) { return to_text(value); }

}  // namespace halfslope
