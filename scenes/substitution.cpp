#include "scenes/substitution.h"

#include <algorithm>

namespace halfslope {
namespace {

// A <default> may hold others, so twenty lines of "$a$a" would grow a millionfold.
constexpr std::size_t kMostExpanded = std::size_t{4} << 20;
constexpr std::size_t kLongestName = 255;

}  // namespace

SceneName parse_scene_name(std::string_view text) {
  constexpr std::string_view kEnd = ".xml:";
  const std::size_t end = text.find(kEnd);
  if (end == std::string_view::npos) return {std::string(text), {}};
  SceneName name = {std::string(text.substr(0, end + kEnd.size() - 1)), {}};
  std::string_view rest = text.substr(end + kEnd.size());
  while (true) {
    const std::string_view one = rest.substr(0, rest.find(','));
    const std::size_t equals = one.find('=');
    if (equals == 0 || equals == std::string_view::npos) {
      fail(ExitCode::kBadInput, "'{}' after '{}:', allowed: name=value,name=value", one, name.file);
    }
    const auto [at, is_new] =
        name.parameters.emplace(std::string(one.substr(0, equals)), std::string(one.substr(equals + 1)));
    if (!is_new) fail(ExitCode::kBadInput, "the parameter '{}' of '{}' is given a second time", at->first, name.file);
    if (one.size() == rest.size()) return name;
    rest.remove_prefix(one.size() + 1);
  }
}

void Substitution::apply(const Element& element) {
  for (pugi::xml_attribute attribute : element.node().attributes()) {
    const std::string_view text = attribute.value();
    if (text.find('$') != std::string_view::npos) attribute.set_value(expand(element, text).c_str());
  }
  if (element.tag() != "default") return;
  element.allow_attributes({"name", "value"});
  const std::string name = element.attribute("name");
  if (name.empty()) element.error("the name of <default> is empty");
  if (name.size() > kLongestName) element.error("the name of <default> is longer than {} letters", kLongestName);
  declared_.insert(name);
  values_.emplace(name, element.attribute("value"));
}

/// The longest name that `text` begins with: $radius_2 is not $radius.
const std::pair<const std::string, std::string>* Substitution::longest_prefix(std::string_view text) const {
  text = text.substr(0, kLongestName);
  while (true) {
    auto next = values_.upper_bound(text);
    if (next == values_.begin()) return nullptr;
    --next;
    if (text.starts_with(next->first)) return &*next;
    // A name that fits is a beginning of both, since it lies before this one in the order.
    const auto common = std::mismatch(text.begin(), text.end(), next->first.begin(), next->first.end());
    text = text.substr(0, static_cast<std::size_t>(common.first - text.begin()));
  }
}

std::string Substitution::expand(const Element& element, std::string_view text) {
  std::string expanded;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t dollar = std::min(text.find('$', at), text.size());
    expanded += text.substr(at, dollar - at);
    at = dollar;
    if (at == text.size()) break;
    const auto* found = longest_prefix(text.substr(at + 1));
    if (!found) {
      std::vector<std::string> names;
      for (const auto& entry : values_) names.push_back("$" + entry.first);
      element.unknown("parameter", text.substr(at), names);
    }
    expanded += found->second;
    used_.insert(found->first);
    at += 1 + found->first.size();
    if (expanded_ + expanded.size() > kMostExpanded) {
      element.error("what the parameters of the scene stand for is longer than {} MiB", kMostExpanded >> 20);
    }
  }
  expanded_ += expanded.size();
  return expanded;
}

void Substitution::check_all_used(const Element& root) const {
  for (const auto& entry : given_) {
    if (used_.contains(entry.first)) continue;
    if (declared_.contains(entry.first)) root.error("the parameter '{}' is used nowhere in the scene", entry.first);
    std::set<std::string> names = declared_;
    names.insert(used_.begin(), used_.end());
    root.unknown("parameter", entry.first, {names.begin(), names.end()});
  }
}

}  // namespace halfslope
