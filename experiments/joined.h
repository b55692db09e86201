// Lists in messages.
#pragma once

#include <fmt/format.h>

#include <string>

namespace halfslope {

/// "a, b, c". (fmt::join of fmt 9 sets off a false warning of GCC 12 at -O3.)
template <class Range>
std::string joined(const Range& range) {
  std::string text;
  for (const auto& element : range) text += fmt::format("{}{}", text.empty() ? "" : ", ", element);
  return text;
}

}  // namespace halfslope
