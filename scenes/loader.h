// Mitsuba 3 scene files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace halfslope {

/// Reads a Mitsuba 3 XML scene. `text` is the file's content and `file` its name for messages.
/// Throws Error(kBadInput) naming file:line, what was found and what is allowed, for anything not understood: an
/// element we do not support is never guessed at.
Scene parse_scene(std::string_view text, const std::string& file);

/// The same from a path; Error(kBadInput) if the file is missing or unreadable.
Scene load_scene(const std::filesystem::path& path);

}  // namespace halfslope
