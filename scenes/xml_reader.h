// XML with a place for every complaint: elements that know their file and line, and an object's properties by name.
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace halfslope {

/// The numbers of a text, separated by commas and white space; nothing if one is not a finite decimal number.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// A parsed file. Lives as long as the elements that come from it.
class XmlFile {
 public:
  /// Throws Error(kBadInput), "file:line:column: malformed XML: …", if `text` is not well-formed UTF-8 XML with one
  /// root.
  XmlFile(std::string_view text, std::string name);

  pugi::xml_node root() const { return document_.document_element(); }
  /// "file:line" of a node.
  std::string place(pugi::xml_node node) const;

 private:
  std::string_view text_;
  std::string name_;
  pugi::xml_document document_;
};

/// One element. Every error that it throws is an Error(kBadInput) that begins with its "file:line".
class Element {
 public:
  Element(const XmlFile& file, pugi::xml_node node) : file_(&file), node_(node) {}

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
  /// The element's children; refuses text between them.
  std::vector<Element> children() const;

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

/// What stands inside an object such as <shape type="sphere">: values by name (<float name="radius" value="2"/>) and
/// nested objects by tag (<bsdf …>). A reader asks for each name that it knows; finish() then refuses the others, and
/// names those that were asked for.
class Properties {
 public:
  /// Checks the object's attributes (type, id, name), and that its children are values or one of `objects`.
  Properties(const Element& object, std::initializer_list<std::string_view> objects);

  /// Names that are asked for later, or read by nobody, and yet no mistake.
  void know(std::initializer_list<std::string_view> names);

  std::optional<double> number(const std::string& name);
  std::optional<int> integer(const std::string& name);
  std::optional<bool> boolean(const std::string& name);
  std::optional<std::string> string(const std::string& name);
  /// A <point> or a <vector>.
  std::optional<Eigen::Vector3d> vector(const std::string& name, std::string_view tag);
  /// <rgb> of three linear numbers or one, or the constant of <spectrum> or <float>.
  std::optional<Eigen::Array3d> colour(const std::string& name);
  /// A <transform>.
  std::optional<Eigen::Matrix4d> transform(const std::string& name);

  /// The nested object with that tag, if any; an error if there are two.
  std::optional<Element> object(std::string_view tag) const;
  const Element& element() const { return object_; }

  /// Throws "file:line: radius of sphere is FOUND, allowed: ALLOWED", at the property's own line if it stands there.
  [[noreturn]] void reject(const std::string& name, std::string_view found, std::string_view allowed) const;
  /// Refuses every property that was not asked for. Call it before what is missing or out of range is complained of.
  void finish() const;

 private:
  /// The property's element; an error unless its tag is among these. Marks the name as known.
  const Element* ask(const std::string& name, std::initializer_list<std::string_view> tags);

  Element object_;
  std::map<std::string, Element> values_;
  std::vector<Element> objects_;
  std::vector<std::string> known_;
};

}  // namespace halfslope
