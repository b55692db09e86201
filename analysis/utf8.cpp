#include "analysis/utf8.h"

#include <cstddef>

namespace halfslope {
namespace {

/// The code point of `length` bytes, or U+FFFD where they are not its one and only form.
char32_t decode_one(std::string_view bytes, std::size_t length) {
  static constexpr char32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  char32_t c = static_cast<unsigned char>(bytes[0]) & (0xffu >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    const auto byte = static_cast<unsigned char>(bytes[k]);
    if ((byte & 0xc0) != 0x80) return kReplacementCharacter;
    c = c << 6 | (byte & 0x3fu);
  }
  const bool surrogate = c >= 0xd800 && c < 0xe000;
  return c < kSmallest[length] || c > 0x10ffff || surrogate ? kReplacementCharacter : c;
}

}  // namespace

std::vector<char32_t> decode_utf8(std::string_view text) {
  std::vector<char32_t> out;
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text[0]);
    std::size_t length = first < 0x80   ? 1
                         : first < 0xc0 ? 0
                         : first < 0xe0 ? 2
                         : first < 0xf0 ? 3
                         : first < 0xf8 ? 4
                                        : 0;
    char32_t c = kReplacementCharacter;
    if (length == 1) c = first;
    if (length > 1 && length <= text.size()) c = decode_one(text, length);
    if (c == kReplacementCharacter && !text.starts_with("\xef\xbf\xbd")) length = 1;
    out.push_back(c);
    text.remove_prefix(length);
  }
  return out;
}

void append_utf8(std::string& text, char32_t c) {
  const auto byte = [&](char32_t value) { text += static_cast<char>(static_cast<unsigned char>(value)); };
  if (c < 0x80) return byte(c);
  if (c < 0x800) {
    byte(0xc0 | c >> 6);
  } else {
    if (c < 0x10000) {
      byte(0xe0 | c >> 12);
    } else {
      byte(0xf0 | c >> 18);
      byte(0x80 | (c >> 12 & 0x3f));
    }
    byte(0x80 | (c >> 6 & 0x3f));
  }
  byte(0x80 | (c & 0x3f));
}

}  // namespace halfslope
