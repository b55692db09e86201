#include "scenes/xml_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "scenes/transform.h"

namespace halfslope {
namespace {

constexpr std::string_view kSeparators = " ,\t\r\n";
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

template <class Range>
std::string joined(const Range& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

}  // namespace

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(kSeparators), text.size()));
    if (text.empty()) return numbers;
    std::string_view word = text.substr(0, text.find_first_of(kSeparators));
    text.remove_prefix(word.size());
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    double number = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (status != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
}

XmlFile::XmlFile(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {
  const auto result = document_.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_trim_pcdata,
                                            pugi::encoding_utf8);
  if (!result) {
    const std::string_view before = text.substr(0, std::min(static_cast<std::size_t>(result.offset), text.size()));
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0: the first line
    fail(ExitCode::kBadInput, "{}:{}:{}: malformed XML: {}", name_, line, column, result.description());
  }
  for (const pugi::xml_node node : document_.children()) {
    if (node != root())
      fail(ExitCode::kBadInput, "{}: a second root element <{}>, allowed: one", place(node), node.name());
  }
}

std::string XmlFile::place(pugi::xml_node node) const {
  const auto offset = std::clamp<std::ptrdiff_t>(node.offset_debug(), 0, static_cast<std::ptrdiff_t>(text_.size()));
  return fmt::format("{}:{}", name_, std::count(text_.begin(), text_.begin() + offset, '\n') + 1);
}

std::optional<std::string> Element::find(const char* attribute) const {
  const pugi::xml_attribute found = node_.attribute(attribute);
  return found ? std::optional<std::string>(found.value()) : std::nullopt;
}

std::string Element::attribute(const char* name) const {
  if (auto found = find(name)) return *found;
  error("<{}> has no attribute '{}'", tag(), name);
}

std::vector<double> Element::numbers(const char* name, std::size_t count) const {
  const std::string text = attribute(name);
  const auto found = parse_numbers(text);
  if (!found || found->size() != count) {
    error("attribute '{}' of <{}> is '{}', allowed: {} finite number{}", name, tag(), text, count,
          count == 1 ? "" : "s");
  }
  return *found;
}

Eigen::Vector3d Element::vector(double absent) const {
  if (const auto text = find("value")) {
    for (const char* name : {"x", "y", "z"}) {
      if (find(name)) error("<{}> has both 'value' and '{}', allowed: one or the other", tag(), name);
    }
    const auto found = parse_numbers(*text);
    if (!found || (found->size() != 1 && found->size() != 3)) {
      error("attribute 'value' of <{}> is '{}', allowed: one finite number or three", tag(), *text);
    }
    if (found->size() == 1) return Eigen::Vector3d::Constant((*found)[0]);
    return {(*found)[0], (*found)[1], (*found)[2]};
  }
  const auto coordinate = [&](const char* name) { return find(name) ? numbers(name, 1)[0] : absent; };
  return {coordinate("x"), coordinate("y"), coordinate("z")};
}

void Element::allow_attributes(std::initializer_list<std::string_view> allowed) const {
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (!contains(allowed, attribute.name())) {
      unknown(fmt::format("attribute of <{}>", tag()), attribute.name(), strings(allowed));
    }
    if (node_.attribute(attribute.name()) != attribute) error("attribute '{}' stands twice", attribute.name());
  }
}

std::vector<Element> Element::children() const {
  std::vector<Element> children;
  for (const pugi::xml_node child : node_.children()) {
    if (child.type() != pugi::node_element) {
      const std::string_view text = child.value();
      Element(*file_, child)
          .error("unexpected text '{}' in <{}>, allowed: elements",
                 text.substr(0, std::min<std::size_t>(text.find('\n'), 40)), tag());
    }
    children.emplace_back(*file_, child);
  }
  return children;
}

void Element::unknown(std::string_view what, std::string_view found, const std::vector<std::string>& allowed) const {
  const std::string list = allowed.empty() ? "none" : joined(allowed);
  error("unknown {} '{}', allowed: {}{}", what, found, list, did_you_mean(found, allowed));
}

Properties::Properties(const Element& object, std::initializer_list<std::string_view> objects) : object_(object) {
  object.allow_attributes({"type", "id", "name"});
  for (const Element& child : object.children()) {
    if (contains(objects, child.tag())) {
      objects_.push_back(child);
      continue;
    }
    if (!contains(kValueTags, child.tag())) {
      std::vector<std::string> allowed = strings(objects);
      for (const std::string_view tag : kValueTags) allowed.emplace_back(tag);
      child.unknown(fmt::format("element in <{}>", object.tag()), child.tag(), allowed);
    }
    if (child.tag() != "transform" && !child.children().empty()) {
      child.children().front().error("<{}> inside <{}>, allowed: nothing", child.children().front().tag(), child.tag());
    }
    const std::string name = child.attribute("name");
    if (!values_.emplace(name, child).second) child.error("'{}' is given a second time", name);
  }
}

const Element* Properties::ask(const std::string& name, std::initializer_list<std::string_view> tags) {
  know({name});
  const auto found = values_.find(name);
  if (found == values_.end()) return nullptr;
  if (!contains(tags, found->second.tag())) {
    reject(name, fmt::format("given as {}", found->second.tag()), fmt::format("as {}", joined(tags)));
  }
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
  const std::string text = value->attribute("value");
  if (text != "true" && text != "false") reject(name, fmt::format("'{}'", text), "true, false");
  return text == "true";
}

std::optional<std::string> Properties::string(const std::string& name) {
  const Element* value = ask(name, {"string"});
  if (!value) return std::nullopt;
  value->allow_attributes({"name", "value"});
  return value->attribute("value");
}

std::optional<Eigen::Vector3d> Properties::vector(const std::string& name, std::string_view tag) {
  const Element* value = ask(name, {tag});
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

std::optional<Eigen::Matrix4d> Properties::transform(const std::string& name) {
  const Element* value = ask(name, {"transform"});
  return value ? std::optional<Eigen::Matrix4d>(read_transform(*value)) : std::nullopt;
}

std::optional<Element> Properties::object(std::string_view tag) const {
  std::optional<Element> found;
  for (const Element& object : objects_) {
    if (object.tag() != tag) continue;
    if (found) object.error("a second <{}> in <{}>, allowed: one", tag, object_.tag());
    found = object;
  }
  return found;
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
