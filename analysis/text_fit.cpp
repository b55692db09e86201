#include "analysis/text_fit.h"

#include "analysis/typeface.h"
#include "analysis/utf8.h"

namespace halfslope {

std::string fitted(std::string_view text, double size, double width, bool bold) {
  if (text_width(text, size, bold) <= width) return std::string(text);
  std::vector<char32_t> letters = decode_utf8(text);
  std::string shorter;
  do {
    if (letters.empty()) return "…";
    letters.pop_back();
    shorter.clear();
    for (const char32_t letter : letters) append_utf8(shorter, letter);
  } while (text_width(shorter + "…", size, bold) > width);
  return shorter + "…";
}

std::vector<std::string> wrapped(std::string_view text, double size, double width) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::string word(text.substr(0, text.find(' ')));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (!lines.empty() && text_width(lines.back() + " " + word, size) <= width) {
      lines.back() += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

}  // namespace halfslope
