// Numbers as text, the same on every machine.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>

namespace halfslope {

/// The shortest decimal text that reads back as exactly `value`, whatever the locale: "0.1", "1e-30", "-0".
/// Non-finite values are "inf", "-inf" and "nan" (whatever the NaN's sign or payload).
std::string format_number(double value);

/// The decimal digits of an integer.
std::string format_integer(std::int64_t value);
std::string format_integer(std::uint64_t value);

/// Any integer type but bool and characters goes to the 64-bit type of its own sign.
template <std::integral T>
requires(!std::same_as<T, bool> && !std::same_as<T, char>) std::string format_number(T value) {
  if constexpr (std::signed_integral<T>) {
    return format_integer(static_cast<std::int64_t>(value));
  } else {
    return format_integer(static_cast<std::uint64_t>(value));
  }
}

}  // namespace halfslope
