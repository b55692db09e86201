// What holds of every mesh that a reader gives, whatever the text.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.h"
#include "scenes/mesh_readers.h"

namespace halfslope {

inline void require(bool holds) {
  if (!holds) __builtin_trap();
}

/// An Error is a good end of reading; any other exception, a sanitizer's finding or a broken mesh is not.
template <class Reader>
int fuzz_mesh(const Reader& read, const std::uint8_t* data, std::size_t size) {
  Mesh mesh;
  try {
    mesh = read(std::string_view(reinterpret_cast<const char*>(data), size), std::string("file"));
  } catch (const Error& error) {
    require(error.code() == ExitCode::kBadInput);
    return 0;
  }
  require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  drop_degenerate(mesh);
  finish_normals(mesh);
  for (const Mesh::Point& normal : vertex_normals(mesh))
    require(std::abs(std::hypot(normal[0], normal[1], normal[2]) - 1) < 1e-3F);
  for (const Mesh::Point& normal : mesh.normals)
    require(std::abs(std::hypot(normal[0], normal[1], normal[2]) - 1) < 1e-3F);
  for (const Mesh::Point& position : mesh.positions) {
    for (const float x : position) require(std::isfinite(x));
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) require(index < mesh.positions.size());
  }
  return 0;
}

}  // namespace halfslope
