#include "scenes/xml_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "scenes/transform.h"

namespace halfslope {
namespace {

constexpr std::array<std::string_view, 9> kValueTags = {"float",  "integer", "boolean",  "string",   "point",
                                                        "vector", "rgb",     "spectrum", "transform"};

template <class Range>
bool contains(const Range& range, std::string_view name) {
  return std::find(range.begin(), range.end(), name) != range.end();
}

template <class Range>
std::vector<std::string> strings(const Range& range) {
  return {range.begin(), range.end()};
}

}  // namespace

Properties::Properties(const Element& object, std::initializer_list<std::string_view> objects) : object_(object) {
  object.allow_attributes({"type", "id", "name"});
  for (const Element& child : object.children()) {
    const std::string tag = child.tag();
    if (contains(objects, tag)) {
      const Element nested = tag == "ref" ? resolve(child, objects) : child;
      if (nested.tag() == "texture") {
        add_value(child.attribute("name"), nested, child);
      } else {
        objects_.push_back({nested, child});
      }
      continue;
    }
    if (!contains(kValueTags, tag)) {
      std::vector<std::string> allowed = strings(objects);
      for (const std::string_view value : kValueTags) allowed.emplace_back(value);
      child.unknown(fmt::format("element in <{}>", object.tag()), tag, allowed);
    }
    if (tag != "transform" && !child.children().empty()) {
      child.children().front().error("<{}> inside <{}>, allowed: nothing", child.children().front().tag(), tag);
    }
    add_value(child.attribute("name"), child, child);
  }
}

Element Properties::resolve(const Element& ref, std::initializer_list<std::string_view> objects) {
  ref.allow_attributes({"id", "name"});
  const std::string id = ref.attribute("id");
  const Ids& ids = ref.file().ids();
  if (const auto found = ids.find(id); found != ids.end() && contains(objects, found->second.tag()))
    return found->second;
  std::vector<std::string> candidates;
  for (const auto& [other, element] : ids) {
    if (contains(objects, element.tag())) candidates.push_back(other);
  }
  ref.unknown(fmt::format("{} id", *objects.begin()), id, candidates);
}

void Properties::add_value(const std::string& name, const Element& value, const Element& at) {
  if (!values_.emplace(name, value).second) at.error("'{}' is given a second time", name);
}

const Element* Properties::ask(const std::string& name, std::initializer_list<std::string_view> tags) {
  know({name});
  const auto found = values_.find(name);
  if (found == values_.end()) return nullptr;
  if (!contains(tags, found->second.tag())) {
    reject(name, fmt::format("given as {}", found->second.tag()), fmt::format("as {}", comma_separated(tags)));
  }
  read_.push_back(name);
  return &found->second;
}

void Properties::know(std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    if (!contains(known_, name)) known_.emplace_back(name);
  }
}

std::optional<double> Properties::number(const std::string& name) {
  const Element* value = ask(name, {"float", "integer"});
  if (!value) return std::nullopt;
  value->allow_attributes({"name", "value"});
  return value->numbers("value", 1)[0];
}

std::optional<int> Properties::integer(const std::string& name) {
  const Element* value = ask(name, {"integer"});
  if (!value) return std::nullopt;
  value->allow_attributes({"name", "value"});
  const double number = value->numbers("value", 1)[0];
  if (number != std::trunc(number) || std::abs(number) > 1e9) reject(name, value->attribute("value"), "a whole number");
  return static_cast<int>(number);
}

std::optional<bool> Properties::boolean(const std::string& name) {
  const Element* value = ask(name, {"boolean"});
  if (!value) return std::nullopt;
  value->allow_attributes({"name", "value"});
  std::string text = value->attribute("value");
  for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (text != "true" && text != "false") reject(name, fmt::format("'{}'", text), "true, false");
  return text == "true";
}

std::optional<std::string> Properties::string(const std::string& name) {
  const Element* value = ask(name, {"string"});
  if (!value) return std::nullopt;
  value->allow_attributes({"name", "value"});
  return value->attribute("value");
}

std::optional<Properties::NumberOrName> Properties::number_or_name(const std::string& name) {
  const Element* value = ask(name, {"float", "integer", "string"});
  if (!value) return std::nullopt;
  if (value->tag() == "string") return NumberOrName{std::nullopt, *string(name)};
  return NumberOrName{number(name), ""};
}

std::optional<Eigen::Vector3d> Properties::vector(const std::string& name) {
  const Element* value = ask(name, {"point", "vector"});
  if (!value) return std::nullopt;
  value->allow_attributes({"name", "value", "x", "y", "z"});
  return value->vector(0);
}

std::optional<Eigen::Array3d> Properties::colour(const std::string& name) {
  const Element* value = ask(name, {"rgb", "spectrum", "float"});
  if (!value) return std::nullopt;
  value->allow_attributes({"name", "value"});
  if (value->tag() != "rgb") {
    const std::string text = value->attribute("value");
    if (const auto numbers = parse_numbers(text); !numbers || numbers->size() != 1) {
      reject(name, fmt::format("'{}'", text), "one number, the same at every wavelength");
    }
    return Eigen::Array3d::Constant(value->numbers("value", 1)[0]);
  }
  if (const std::string text = value->attribute("value"); text.find('#') != std::string::npos) {
    reject(name, fmt::format("'{}', an sRGB code, which is not linear", text),
           "linear numbers \"r, g, b\", or one number");
  }
  return value->vector(0).array();
}

std::optional<Element> Properties::texture(const std::string& name) {
  const auto found = values_.find(name);
  if (found == values_.end() || found->second.tag() != "texture") return std::nullopt;
  return *ask(name, {"texture"});
}

std::optional<Eigen::Matrix4d> Properties::transform(const std::string& name) {
  const Element* value = ask(name, {"transform"});
  return value ? std::optional<Eigen::Matrix4d>(read_transform(*value)) : std::nullopt;
}

std::vector<Element> Properties::objects(std::string_view tag) const {
  std::vector<Element> found;
  for (const Nested& nested : objects_) {
    if (nested.object.tag() == tag) found.push_back(nested.object);
  }
  return found;
}

std::optional<Element> Properties::object(std::string_view tag) const {
  std::optional<Element> found;
  bool by_ref = false;
  for (const Nested& nested : objects_) {
    if (nested.object.tag() != tag) continue;
    const bool is_ref = nested.at.tag() == "ref";
    if (found && is_ref != by_ref) {
      nested.at.error("a <{}> beside a <{}> in one {}, allowed: one or the other", nested.at.tag(),
                      by_ref ? "ref" : tag, object_.tag());
    }
    if (found) nested.at.error("a second <{}> in <{}>, allowed: one", nested.at.tag(), object_.tag());
    found = nested.object;
    by_ref = is_ref;
  }
  return found;
}

std::vector<std::string> Properties::unread() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : values_) {
    if (contains(known_, name) && !contains(read_, name)) names.push_back(name);
  }
  return names;
}

void Properties::reject(const std::string& name, std::string_view found, std::string_view allowed) const {
  const auto value = values_.find(name);
  const Element& at = value == values_.end() ? object_ : value->second;
  at.error("'{}' of {} '{}' is {}, allowed: {}", name, object_.tag(), object_.attribute("type"), found, allowed);
}

void Properties::finish() const {
  for (const auto& [name, value] : values_) {
    if (contains(known_, name)) continue;
    value.unknown(fmt::format("property of {} '{}'", object_.tag(), object_.attribute("type")), name, known_);
  }
}

}  // namespace halfslope
