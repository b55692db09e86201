// An object's properties by name, such as <float name="radius" value="2"/> in <shape type="sphere">.
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/xml_file.h"

namespace halfslope {

/// What stands inside an object: values by name (<float name="radius" value="2"/>, or a named <texture>) and nested
/// objects by tag (<bsdf …>), each in place or as a <ref> to what has that id. A reader asks for each name that it
/// knows; finish() then refuses the others, and names those that were asked for.
class Properties {
 public:
  /// Checks the object's attributes (type, id, name), and that its children are values or one of `objects`; a <ref>
  /// may stand for one of these where "ref" is among them.
  Properties(const Element& object, std::initializer_list<std::string_view> objects);

  /// Names that are asked for later, or read by nobody, and yet no mistake.
  void know(std::initializer_list<std::string_view> names);

  std::optional<double> number(const std::string& name);
  std::optional<int> integer(const std::string& name);
  std::optional<bool> boolean(const std::string& name);
  std::optional<std::string> string(const std::string& name);
  /// A number, or a string.
  struct NumberOrName {
    std::optional<double> number;
    std::string name;
  };
  std::optional<NumberOrName> number_or_name(const std::string& name);
  /// A <point> or a <vector>.
  std::optional<Eigen::Vector3d> vector(const std::string& name);
  /// <rgb> of three linear numbers or one, or the constant of <spectrum> or <float>.
  std::optional<Eigen::Array3d> colour(const std::string& name);
  /// A <texture>, if that is what the property is.
  std::optional<Element> texture(const std::string& name);
  /// A <transform>.
  std::optional<Eigen::Matrix4d> transform(const std::string& name);

  bool has(const std::string& name) const { return values_.contains(name); }

  /// The nested objects with that tag, in order.
  std::vector<Element> objects(std::string_view tag) const;
  /// The nested object with that tag, if any; an error if there are two.
  std::optional<Element> object(std::string_view tag) const;
  const Element& element() const { return object_; }
  /// Of those that may stand here and were given, the names that nobody read; know() named them.
  std::vector<std::string> unread() const;

  /// Throws "file:line: radius of sphere is FOUND, allowed: ALLOWED", at the property's own line if it stands there.
  [[noreturn]] void reject(const std::string& name, std::string_view found, std::string_view allowed) const;
  /// Refuses every property that was not asked for. Call it before what is missing or out of range is complained of.
  void finish() const;

 private:
  /// A nested object, and where it stands: itself, or the <ref> to it.
  struct Nested {
    Element object, at;
  };

  /// The element that a <ref> names; an error unless its tag is among these.
  static Element resolve(const Element& ref, std::initializer_list<std::string_view> objects);
  void add_value(const std::string& name, const Element& value, const Element& at);
  /// The property's element; an error unless its tag is among these. Marks the name as known.
  const Element* ask(const std::string& name, std::initializer_list<std::string_view> tags);

  Element object_;
  std::map<std::string, Element> values_;
  std::vector<Nested> objects_;
  std::vector<std::string> known_, read_;
};

}  // namespace halfslope
