#include "scenes/mesh_reader.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scenes/mesh_readers.h"

namespace halfslope {

std::string shown(std::string_view part) {
  std::string text(part.substr(0, 40));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

Mesh load_mesh(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".ply" && extension != ".obj")
    fail(ExitCode::kBadInput, "{}: an unknown kind of mesh '{}', allowed: .ply, .obj", path.string(), extension);
  const std::string file = path.string();
  const std::string text = read_file(path);
  Mesh mesh = extension == ".ply" ? parse_ply(text, file) : parse_obj(text, file);
  const std::size_t triangles = mesh.triangles.size();
  drop_degenerate(mesh);
  if (mesh.triangles.empty()) {
    if (triangles == 0) fail(ExitCode::kBadInput, "{}: no face, allowed: one or more", file);
    fail(ExitCode::kBadInput, "{}: all {} triangles have area 0, allowed: one that does not", file, triangles);
  }
  finish_normals(mesh);
  return mesh;
}

}  // namespace halfslope
