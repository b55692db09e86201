#include <algorithm>
#include <cctype>
#include <string>

#include "scenes/mesh_reader.h"
#include "scenes/readers.h"

namespace halfslope {
namespace {

/// The mesh of `filename` as the file has it, read once however many shapes name it.
std::shared_ptr<const Mesh> read_file_mesh(Properties& properties, const std::string& name, Reading& reading) {
  const auto path = reading.files.find(properties.element(), name);
  std::shared_ptr<const Mesh>& mesh = reading.meshes[path];
  if (mesh) return mesh;
  try {
    mesh = std::make_shared<const Mesh>(load_mesh(path));
  } catch (const Error& error) {
    throw Error(error.code(), properties.element().place() + ": " + error.what());
  }
  return mesh;
}

Mesh with_flipped_v(Mesh mesh) {
  for (auto& uv : mesh.uvs) uv[1] = 1 - uv[1];
  return mesh;
}

}  // namespace

std::shared_ptr<const Mesh> read_mesh(Properties& properties, const std::string& type, Reading& reading) {
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  const bool flip_normals = properties.boolean("flip_normals").value_or(false);
  bool face_normals = false, flip_v = false;  // flip_v: apart from what load_mesh() does
  std::optional<std::string> name;
  if (type != "cube") {
    name = properties.string("filename");
    face_normals = properties.boolean("face_normals").value_or(false);
    const bool by_default = type == "obj";
    flip_v = properties.boolean("flip_tex_coords").value_or(by_default) != by_default;
  }
  properties.finish();
  if (type != "cube") {
    if (!name) properties.reject("filename", "absent", "the name of a mesh");
    std::string extension = std::filesystem::path(*name).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    if (extension != "." + type) {
      properties.reject("filename", fmt::format("'{}'", *name), fmt::format("a file whose name ends in .{}", type));
    }
  }
  const std::shared_ptr<const Mesh> own =
      name ? read_file_mesh(properties, *name, reading) : std::make_shared<const Mesh>(make_cube());
  std::shared_ptr<const Mesh> mesh;
  try {
    mesh = std::make_shared<const Mesh>(
        transformed(flip_v ? with_flipped_v(*own) : *own, to_world, flip_normals, face_normals));
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}: {}", properties.element().place(), error.what()));
  }
  if (mesh->triangles.empty()) {
    properties.element().error("the mesh has no triangle with an area, {} without; allowed: one or more",
                               mesh->degenerate);
  }
  return mesh;
}

}  // namespace halfslope
