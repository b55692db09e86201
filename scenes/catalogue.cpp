#include "scenes/catalogue.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "core/installed_folders.h"
#include "scenes/loader.h"
#include "scenes/shipped_files.h"
#include "scenes/substitution.h"

namespace halfslope {

// To add a scene: put NAME.xml into this folder (the build compiles it in) and its entry here. Meshes and images go
// beside it, as NAME.ply, NAME.obj or NAME.exr: the build copies them to where the program finds them.
std::vector<SceneEntry> rendered_scenes() {
  return {
      {"veach-mis", "four glossy plates, from smooth to rough, reflect four spheres, from small to large",
       "Veach & Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995, fig. 2"},
      {"veach-mis-plastic", "the same with plates of rough plastic, as in the scene file that renderers pass on",
       "Veach & Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995, fig. 2"},
      {"veach-mis-phong", "the same with plates that are Phong lobes",
       "Veach & Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995, fig. 2"},
      {"diffuse-rectangle", "a diffuse floor under one rectangle light; every pixel in closed form",
       "Lambert, Photometria, 1760"},
      {"diffuse-disk", "a diffuse floor under one disk light; every pixel in closed form",
       "Heitz & Hill, Real-Time Line- and Disk-Light Shading with Linearly Transformed Cosines, 2017"},
      {"diffuse-sphere", "a diffuse floor under one sphere light; every pixel in closed form",
       "Snyder, Area Light Sources for Real-Time Graphics, 1996"},
      {"furnace", "a sphere and a plane in radiance 1 from all around reflect exactly their six albedos",
       "the white-furnace test of energy conservation"},
      {"glossy-reflection", "a glossy floor reflects square lights of equal power, from small to large",
       "the comparison of uniform with stratified sampling by their noise"},
      {"cornell-box",
       "a diffuse room of red, green and white with two blocks under a lamp; for paths of many reflections",
       "Goral, Torrance, Greenberg & Battaile, Modeling the Interaction of Light Between Diffuse Surfaces, SIGGRAPH "
       "1984"},
      {"glossy-indirect", "a lamp that shines at the ceiling lights a room with a glossy floor; for paths",
       "light that no connection with the lamp finds"},
      {"environment-mesh", "a glossy knot of 3072 triangles on the ground under a clear sky with its sun",
       "ISO 15469:2004, CIE standard general sky, type 12"},
  };
}

namespace {

/// The folder of the files that shipped scenes name; empty, for the current one, where there is none.
std::filesystem::path shipped_folder() {
  const std::filesystem::path share = HALFSLOPE_INSTALL_DATADIR;
  for (const auto& folder :
       installed_folders("HALFSLOPE_SCENES", "scenes", {"share/halfslope/scenes"}, share / "halfslope" / "scenes")) {
    std::error_code ignored;
    if (std::filesystem::is_directory(folder, ignored)) return folder;
  }
  return {};
}

}  // namespace

std::optional<std::string_view> shipped_scene_text(std::string_view name) {
  for (const ShippedFile& file : shipped_files()) {
    if (file.name == name) return file.text;
  }
  return std::nullopt;
}

Scene load_catalogue_scene(std::string_view name) {
  const std::string head(name.substr(0, name.find(':')));
  if (const auto text = shipped_scene_text(head)) {
    const SceneName full = parse_scene_name(fmt::format("{}.xml{}", head, name.substr(head.size())));
    return parse_scene(*text, (shipped_folder() / full.file).string(), full.parameters);
  }
  std::vector<std::string> names;
  std::string allowed;
  for (const SceneEntry& entry : rendered_scenes()) {
    names.push_back(entry.name);
    allowed += (allowed.empty() ? "" : ", ") + entry.name;
  }
  fail(ExitCode::kBadInput, "unknown scene '{}', allowed: {}{}", head, allowed, did_you_mean(head, names));
}

bool is_scene_file(std::string_view name) { return name.ends_with(".xml") || name.find(".xml:") != name.npos; }

Scene load_named_scene(std::string_view name) {
  if (!is_scene_file(name)) return load_catalogue_scene(name);
  const SceneName full = parse_scene_name(name);
  return load_scene(full.file, full.parameters);
}

}  // namespace halfslope
