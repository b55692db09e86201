#include "scenes/xml_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

namespace halfslope {
namespace {

constexpr std::string_view kSeparators = " ,\t\r\n";

/// How much of a file's text a message repeats.
constexpr std::size_t kQuoted = 80;

/// How many names a message lists, and among how many it looks for the nearest.
constexpr std::size_t kListed = 50, kCompared = 1000;

std::string_view quoted(std::string_view text) { return text.substr(0, std::min(text.find('\n'), kQuoted)); }

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

XmlFile::XmlFile(std::string text, std::string name, XmlBudget& budget, const Ids& ids)
    : text_(std::move(text)), name_(std::move(name)), ids_(ids) {
  check_size(budget);
  const auto result =
      document_.load_buffer(text_.data(), text_.size(),
                            pugi::parse_default | pugi::parse_trim_pcdata | pugi::parse_doctype, pugi::encoding_utf8);
  if (!result) {
    const std::string_view before =
        std::string_view(text_).substr(0, std::min(static_cast<std::size_t>(result.offset), text_.size()));
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0: the first line
    fail(ExitCode::kBadInput, "{}:{}:{}: malformed XML: {}", name_, line, column, result.description());
  }
  check_top_level();
  check_depth();
}

/// Counted in the text, since the parser would already have allocated for them.
void XmlFile::check_size(XmlBudget& budget) const {
  if (text_.size() > budget.bytes) {
    fail(ExitCode::kBadInput, "{}:1: the scene's files are larger than {} MiB together", name_,
         XmlBudget().bytes >> 20);
  }
  budget.bytes -= text_.size();
  for (std::size_t i = 0; i + 1 < text_.size(); ++i) {
    const bool element = text_[i] == '<' && text_[i + 1] != '/' && text_[i + 1] != '!' && text_[i + 1] != '?';
    if (!element && text_[i] != '=') continue;
    if (budget.names == 0) {
      fail(ExitCode::kBadInput, "{}:{}: more than {} elements and attributes in the scene's files", name_,
           std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(i), '\n') + 1, XmlBudget().names);
    }
    --budget.names;
  }
}

void XmlFile::check_top_level() const {
  for (const pugi::xml_node node : document_.children()) {
    if (node.type() == pugi::node_doctype) {
      const std::string_view doctype = node.value();
      if (doctype.find_first_of("[\"'") == std::string_view::npos) continue;
      fail(ExitCode::kBadInput, "{}: a DOCTYPE with definitions or from elsewhere, allowed: none", place(node));
    }
    if (node != root())
      fail(ExitCode::kBadInput, "{}: a second root element <{}>, allowed: one", place(node), node.name());
  }
}

/// Without recursion, which is what depth would exhaust.
void XmlFile::check_depth() const {
  int depth = 1;
  for (pugi::xml_node node = root(); node;) {
    if (depth > kMaxXmlDepth) {
      fail(ExitCode::kBadInput, "{}: elements are nested more than {} deep", place(node), kMaxXmlDepth);
    }
    if (const pugi::xml_node child = node.first_child()) {
      node = child;
      ++depth;
      continue;
    }
    while (node != root() && !node.next_sibling()) {
      node = node.parent();
      --depth;
    }
    if (node == root()) return;
    node = node.next_sibling();
  }
}

std::string XmlFile::place(pugi::xml_node node) const {
  const auto offset = std::clamp<std::ptrdiff_t>(node.offset_debug(), 0, static_cast<std::ptrdiff_t>(text_.size()));
  return fmt::format("{}:{}", name_, std::count(text_.begin(), text_.begin() + offset, '\n') + 1);
}

void XmlFile::include(pugi::xml_node node, std::unique_ptr<XmlFile> file) {
  includes_[node.internal_object()] = std::move(file);
}

const XmlFile* XmlFile::included(pugi::xml_node node) const {
  const auto found = includes_.find(node.internal_object());
  return found == includes_.end() ? nullptr : found->second.get();
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
    error("attribute '{}' of <{}> is '{}', allowed: {} finite number{}", name, tag(), quoted(text), count,
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
      error("attribute 'value' of <{}> is '{}', allowed: one finite number or three", tag(), quoted(*text));
    }
    if (found->size() == 1) return Eigen::Vector3d::Constant((*found)[0]);
    return {(*found)[0], (*found)[1], (*found)[2]};
  }
  const auto coordinate = [&](const char* name) { return find(name) ? numbers(name, 1)[0] : absent; };
  return {coordinate("x"), coordinate("y"), coordinate("z")};
}

void Element::allow_attributes(std::initializer_list<std::string_view> allowed) const {
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (std::find(allowed.begin(), allowed.end(), attribute.name()) == allowed.end()) {
      unknown(fmt::format("attribute of <{}>", tag()), quoted(attribute.name()), {allowed.begin(), allowed.end()});
    }
    if (node_.attribute(attribute.name()) != attribute) error("attribute '{}' stands twice", attribute.name());
  }
}

std::vector<Element> Element::children() const {
  std::vector<Element> children;
  for (const pugi::xml_node child : node_.children()) {
    refuse_text(child);
    const bool include = std::string_view(child.name()) == "include";
    if (const XmlFile* included = include ? file_->included(child) : nullptr) {
      const Element root(*included, included->root());
      if (root.tag() != "scene") {
        children.push_back(root);
        continue;
      }
      const std::vector<Element> inner = root.children();
      children.insert(children.end(), inner.begin(), inner.end());
    } else {
      children.emplace_back(*file_, child);
    }
  }
  return children;
}

void Element::refuse_text(pugi::xml_node child) const {
  if (child.type() == pugi::node_element) return;
  const std::string_view text = child.value();
  Element(*file_, child)
      .error("unexpected text '{}' in <{}>, allowed: elements",
             text.substr(0, std::min<std::size_t>(text.find('\n'), 40)), tag());
}

void Element::unknown(std::string_view what, std::string_view found, const std::vector<std::string>& allowed) const {
  const std::span<const std::string> listed = std::span(allowed).first(std::min(allowed.size(), kListed));
  const std::string list = allowed.empty() ? "none" : comma_separated(listed);
  const std::string rest =
      listed.size() < allowed.size() ? fmt::format(" and {} more", allowed.size() - listed.size()) : "";
  error("unknown {} '{}', allowed: {}{}{}", what, quoted(found), list, rest,
        did_you_mean(quoted(found), std::span(allowed).first(std::min(allowed.size(), kCompared))));
}

}  // namespace halfslope
