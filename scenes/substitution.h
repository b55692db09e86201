// The $parameters of a scene file.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "scenes/xml_file.h"

namespace halfslope {

/// Values by name that stand in for what a file's <default>s give.
using SceneParameters = std::map<std::string, std::string, std::less<>>;

/// A scene as a command line names it: "scene.xml", or "scene.xml:name=value,name=value" with parameters.
struct SceneName {
  std::string file;
  SceneParameters parameters;
};

/// Throws Error(kBadInput) for parameters that are not of that form, or one that is given twice. A name without ".xml:"
/// has none.
SceneName parse_scene_name(std::string_view text);

/// Replaces each $name in attributes by what a <default> above it gives, in document order as Mitsuba does; the first
/// <default> of a name stands, and a value given from outside before that.
class Substitution {
 public:
  explicit Substitution(SceneParameters given) : given_(std::move(given)), values_(given_) {}

  /// The attributes of one element; a <default> is then defined. Errors name the element's place.
  void apply(const Element& element);

  /// Throws Error(kBadInput), naming the parameters of the scene, if one that was given was never put in.
  void check_all_used(const Element& root) const;

 private:
  std::string expand(const Element& element, std::string_view text);
  const std::pair<const std::string, std::string>* longest_prefix(std::string_view text) const;

  SceneParameters given_, values_;
  std::set<std::string> used_, declared_;
  std::size_t expanded_ = 0;  ///< letters so far
};

}  // namespace halfslope
