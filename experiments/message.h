// What a person is told while we work.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>

namespace halfslope {

/// Writes to stderr. A message that cannot be shown is no reason to stop, so errors of the stream are ignored.
template <class... Args>
void message(fmt::format_string<Args...> format, Args&&... args) {
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace halfslope
