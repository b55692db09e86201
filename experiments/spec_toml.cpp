// An experiment from a .toml file. The one place that knows toml++.
#include <toml++/toml.h>

#include <algorithm>

#include "core/atomic_file.h"
#include "core/numbers.h"
#include "experiments/spec.h"
#include "experiments/spec_keys.h"

namespace halfslope {
namespace {

std::string place_of(const std::string& file, const toml::source_region& source) {
  return fmt::format("{}:{}:{}", file, source.begin.line, source.begin.column);
}

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::floating_point:
      return "a floating-point number";
    case toml::node_type::boolean:
      return "a boolean";
    case toml::node_type::date:
      return "a date";
    case toml::node_type::time:
      return "a time";
    case toml::node_type::date_time:
      return "a date and time";
    default:
      return "another type";
  }
}

SpecItem item_of(const std::string& file, const toml::node& node) {
  const std::string place = place_of(file, node.source());
  if (const auto* text = node.as_string()) return {SpecItem::Kind::kText, text->get(), place};
  if (const auto* number = node.as_integer()) return {SpecItem::Kind::kInteger, format_number(number->get()), place};
  return {SpecItem::Kind::kOther, type_name(node), place};
}

SpecValue value_of(const std::string& file, const toml::node& node) {
  SpecValue value{{}, node.is_array(), place_of(file, node.source()), ExitCode::kBadInput};
  if (const toml::array* list = node.as_array()) {
    for (const toml::node& element : *list) value.items.push_back(item_of(file, element));
  } else {
    value.items.push_back(item_of(file, node));
  }
  return value;
}

toml::table parsed(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    fail(ExitCode::kBadInput, "{}: {}", place_of(file, error.source()), error.description());
  }
}

}  // namespace

Spec parse_spec_toml(std::string_view text, const std::string& file) {
  const toml::table table = parsed(text, file);
  Spec spec;
  spec.places[""] = file;
  spec.codes[""] = static_cast<int>(ExitCode::kBadInput);
  const std::span<const std::string> known = spec_key_names();
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      fail(ExitCode::kBadInput, "{}: key '{}' is not known{}", place_of(file, key.source()), key.str(),
           spec_key_hint(key.str()));
    set_spec_key(spec, key.str(), value_of(file, node));
  }
  return spec;
}

Spec load_spec(const std::filesystem::path& path) { return parse_spec_toml(read_file(path), path.string()); }

}  // namespace halfslope
