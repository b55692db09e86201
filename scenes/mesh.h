// Triangle meshes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace halfslope {

/// Triangles in world space, in binary32, which is what is intersected: the mesh is exactly this. A triangle's front is
/// the side from which its corners run counterclockwise; a mesh with a mirroring transform is stored with its corners
/// turned, so that this holds as Mitsuba has it.
struct Mesh {
  using Point = std::array<float, 3>;
  std::vector<Point> positions;                         ///< finite
  std::vector<Point> normals;                           ///< one a position, unit length; empty where faces are flat
  std::vector<std::array<float, 2>> uvs;                ///< one a position; empty where the file has none
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of positions, in range; none of area 0
  std::size_t degenerate = 0;                           ///< triangles of area 0 that were left out
};

}  // namespace halfslope
