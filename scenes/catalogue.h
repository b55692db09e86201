// The rendered scenes that come with halfslope.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace halfslope {

struct SceneEntry {
  std::string name;         ///< what an experiment's `scene` says
  std::string description;  ///< one line
  std::string reference;    ///< where the scene comes from
};

/// What `list` prints, in its order.
std::vector<SceneEntry> rendered_scenes();

/// The Mitsuba XML of a shipped scene; nothing if there is none of that name.
std::optional<std::string_view> shipped_scene_text(std::string_view name);

/// A shipped scene, parsed: "cornell-box", or "cornell-box:max_depth=4" with values for its <default>s. Throws
/// Error(kBadInput) naming the nearest if there is none of that name.
Scene load_catalogue_scene(std::string_view name);

/// Whether the name is that of a Mitsuba file: "scene.xml", or "scene.xml:name=value,…".
bool is_scene_file(std::string_view name);

/// A file or a shipped scene, with the values that the name gives.
Scene load_named_scene(std::string_view name);

}  // namespace halfslope
