// Text as code points.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace halfslope {

inline constexpr char32_t kReplacementCharacter = 0xfffd;

/// The code points of a UTF-8 text; each byte that is not part of well-formed UTF-8 (Unicode 15, table 3-7) becomes
/// U+FFFD.
std::vector<char32_t> decode_utf8(std::string_view text);

/// Appends the UTF-8 form of a code point.
void append_utf8(std::string& text, char32_t code_point);

}  // namespace halfslope
