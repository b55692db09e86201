// Text that keeps to the width there is.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace halfslope {

/// The text, or as much of its beginning and "…" as `width` points hold.
std::string fitted(std::string_view text, double size, double width, bool bold = false);

/// The text in lines of at most `width` points, broken at blanks; a word that is longer has a line of its own.
std::vector<std::string> wrapped(std::string_view text, double size, double width);

}  // namespace halfslope
