// An experiment from flags: every key of a file is also a flag of `run`.
#include <algorithm>

#include "experiments/spec.h"
#include "experiments/spec_keys.h"

namespace halfslope {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// "alpha=0.05": what follows a comma here is a parameter of the name before it, not another name.
bool begins_with_parameter(std::string_view text) {
  if (text.empty() || !is_letter(text[0])) return false;
  const auto end = std::find_if(text.begin(), text.end(), [](char c) { return !is_letter(c) && !is_digit(c); });
  return end != text.end() && *end == '=';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

// A comma after a backslash is a name's own.
bool is_part_of_name(std::string_view text, std::size_t comma) {
  return begins_with_parameter(text.substr(comma + 1)) || (comma > 0 && text[comma - 1] == '\\');
}

std::string without_escapes(std::string_view text) {
  std::string name(text);
  for (std::size_t at = name.find("\\,"); at != std::string::npos; at = name.find("\\,", at)) name.erase(at++, 1);
  return name;
}

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> list;
  while (true) {
    std::size_t comma = text.find(',');
    while (comma != std::string_view::npos && is_part_of_name(text, comma)) comma = text.find(',', comma + 1);
    list.push_back(without_escapes(trimmed(text.substr(0, comma))));
    if (comma == std::string_view::npos) return list;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace

void apply_flag(Spec& spec, std::string_view key, std::string_view value, std::string_view shown_as) {
  const std::string place = fmt::format("--{}", shown_as.empty() ? key : shown_as);
  const std::span<const std::string> known = spec_key_names();
  if (std::find(known.begin(), known.end(), key) == known.end())
    fail(ExitCode::kUsage, "{} is not known{}", place, spec_key_hint(key));
  std::string list(value);
  if (key == "resolution") std::replace(list.begin(), list.end(), 'x', ',');
  SpecValue raw{{}, false, place, ExitCode::kUsage};
  for (const std::string& item : spec_key_takes_list(key) ? split_list(list) : std::vector{std::string(trimmed(list))})
    raw.items.push_back({SpecItem::Kind::kFlag, item, place});
  raw.is_list = raw.items.size() > 1;
  set_spec_key(spec, key, raw);
}

}  // namespace halfslope
