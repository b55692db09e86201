// XML with a place for every complaint: files, and elements that know their file and line.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace halfslope {

/// The numbers of a text, separated by commas and white space; nothing if one is not a finite decimal number.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// What all files of a scene may hold together, so that no file exhausts memory or stack.
struct XmlBudget {
  std::size_t bytes = std::size_t{24} << 20;
  std::size_t names = 1'000'000;  ///< elements and attributes, each counted alone
};

/// Elements in a scene are five or six levels deep; deeper ones would only exhaust the stack.
constexpr int kMaxXmlDepth = 64;

class Element;
using Ids = std::map<std::string, Element>;

/// A parsed file, and the files that its <include>s name once include() was told them. Lives as long as the elements
/// that come from it.
class XmlFile {
 public:
  /// Throws Error(kBadInput), "file:line:column: malformed XML: …", if `text` is not well-formed UTF-8 XML with one
  /// root; "file:line: …" if it defines entities, is nested more than kMaxXmlDepth deep or is beyond the budget, of
  /// which it takes its part. `ids` are the elements that a <ref> may name, of all files of the scene, once they are
  /// known.
  XmlFile(std::string text, std::string name, XmlBudget& budget, const Ids& ids);
  XmlFile(const XmlFile&) = delete;
  XmlFile& operator=(const XmlFile&) = delete;

  const std::string& name() const { return name_; }
  pugi::xml_node root() const { return document_.document_element(); }
  /// "file:line" of a node.
  std::string place(pugi::xml_node node) const;

  /// From now on the children of `file`'s root (or, where that is no <scene>, the root) stand where `node` does.
  void include(pugi::xml_node node, std::unique_ptr<XmlFile> file);
  /// Null unless include() gave one for the node.
  const XmlFile* included(pugi::xml_node node) const;

  const Ids& ids() const { return ids_; }

  /// Whether its names were brought from Mitsuba 0.x to Mitsuba 3.
  bool upgraded = false;

 private:
  void check_size(XmlBudget& budget) const;
  void check_top_level() const;
  void check_depth() const;

  std::string text_, name_;
  const Ids& ids_;
  pugi::xml_document document_;
  std::map<const void*, std::unique_ptr<XmlFile>> includes_;
};

/// One element. Every error that it throws is an Error(kBadInput) that begins with its "file:line".
class Element {
 public:
  Element(const XmlFile& file, pugi::xml_node node) : file_(&file), node_(node) {}

  const XmlFile& file() const { return *file_; }
  std::string tag() const { return node_.name(); }
  std::string place() const { return file_->place(node_); }
  pugi::xml_node node() const { return node_; }

  std::optional<std::string> find(const char* attribute) const;
  /// The attribute's text; an error if it is missing.
  std::string attribute(const char* name) const;
  /// The attribute's numbers; an error unless there are exactly `count`, all finite.
  std::vector<double> numbers(const char* name, std::size_t count) const;
  /// The attributes x, y, z, or `value` with one number or three; an absent one is `absent`.
  Eigen::Vector3d vector(double absent) const;
  /// Refuses an attribute that is not among these, or stands twice.
  void allow_attributes(std::initializer_list<std::string_view> allowed) const;
  /// The element's children, with what an <include> brings in its place; refuses text between them.
  std::vector<Element> children() const;
  /// Refuses a text node.
  void refuse_text(pugi::xml_node child) const;

  template <class... Args>
  [[noreturn]] void error(fmt::format_string<Args...> format, Args&&... args) const {
    throw Error(ExitCode::kBadInput, place() + ": " + fmt::format(format, std::forward<Args>(args)...));
  }
  /// "file:line: unknown WHAT 'FOUND', allowed: A, B; did you mean 'A'?"
  [[noreturn]] void unknown(std::string_view what, std::string_view found,
                            const std::vector<std::string>& allowed) const;

 private:
  const XmlFile* file_;
  pugi::xml_node node_;
};

/// "a, b, c".
template <class Range>
std::string comma_separated(const Range& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

}  // namespace halfslope
