// What a scene holds, in numbers and words.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace halfslope {

struct LightSummary {
  std::string kind;  ///< area, point, directional, spot, constant, envmap
  std::string id;    ///< of the shape that emits, else empty
  /// Watts over all directions; of a light from infinitely far away what it gives instead: W/m² (directional) or
  /// W/m²/sr, over the whole sphere (constant, envmap).
  Rgb power = Rgb::Zero();
  std::string unit;
};

struct SceneSummary {
  std::map<std::string, std::size_t> shapes;     ///< how many of each type
  std::map<std::string, std::size_t> materials;  ///< how many shapes are made of each kind
  std::map<std::string, std::size_t> textures;   ///< how many of each type
  std::size_t triangles = 0, degenerate = 0;     ///< of meshes; those of area 0 are left out
  std::size_t pieces = 0;                        ///< shapes that are no mesh, and triangles
  std::vector<LightSummary> lights;
  std::string sensor, filter;
  std::vector<std::string> skips;  ///< which work the scene lets us skip and why; what it is traced with
};

SceneSummary summarise(const Scene& scene);

}  // namespace halfslope
