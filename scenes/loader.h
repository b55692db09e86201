// Mitsuba 3 scene files.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"
#include "scenes/substitution.h"

namespace halfslope {

/// Reads a Mitsuba 3 XML scene, or one of Mitsuba 0.x in its older spelling. `text` is the file's content and `file`
/// its name, for messages and as what relative names of other files start from. `parameters` stand in for the file's
/// <default>s.
/// Throws Error(kBadInput) naming file:line, what was found and what is allowed, for anything not understood (an
/// element we do not support is never guessed at), for a parameter that the scene does not use, and for files that
/// would exhaust memory or stack.
Scene parse_scene(std::string_view text, const std::string& file, const SceneParameters& parameters = {});

/// The same from a path; Error(kBadInput) if the file is missing or unreadable.
Scene load_scene(const std::filesystem::path& path, const SceneParameters& parameters = {});

/// What a scene file was found to say.
struct SceneCheck {
  std::optional<Scene> scene;                      ///< where there is no problem
  std::string version;                             ///< as the file says
  bool upgraded = false;                           ///< names were brought from Mitsuba 0.x to Mitsuba 3
  std::vector<std::string> included, other_files;  ///< included files; meshes and images
  std::map<std::string, int> ignored;              ///< what nobody reads, and how often it stands there
  std::vector<std::string> problems;               ///< one for each element of <scene> that is wrong, in order
};

/// The same, with the problems of all elements instead of the first; a scene that is wrong throws nothing.
SceneCheck check_scene(const std::filesystem::path& path, const SceneParameters& parameters = {});
SceneCheck check_scene_text(std::string_view text, const std::string& file, const SceneParameters& parameters = {});

}  // namespace halfslope
