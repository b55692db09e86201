// Meshes from files and by name.
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "scenes/mesh.h"

namespace halfslope {

/// A .ply (ASCII or binary, either byte order) or .obj file, in its own space; polygons become fans of triangles, and
/// triangles of area 0 are left out and counted. Normals are empty where the file has none. The v of an OBJ's uvs is
/// turned over, v → 1 − v, as Mitsuba has it by default (`flip_tex_coords`, which is false for PLY).
/// Throws Error(kBadInput) that names the file and the line or byte, what was found and what is allowed; a mesh without
/// a triangle is an error too. Memory is bounded by a small multiple of the file's size, whatever it claims.
Mesh load_mesh(const std::filesystem::path& path);

/// Mitsuba's cube: [-1, 1]^3, its front outside, each face with uv over the unit square.
Mesh make_cube();

/// The mesh in world space: positions by the matrix, normals by its inverse transpose, the corners of each triangle
/// turned where it mirrors (the second and third change places). `flip_normals` turns the front to the other side;
/// `face_normals` drops the normals, and where it is false and the mesh has none, they are computed in world space from
/// the triangles around each position, weighted by angle, as Mitsuba does.
/// Triangles that come to area 0 are dropped and counted. Throws Error(kBadInput), without a place, for a matrix
/// without an inverse and for positions that leave binary32.
Mesh transformed(const Mesh& mesh, const Eigen::Matrix4d& to_world, bool flip_normals, bool face_normals);

}  // namespace halfslope
