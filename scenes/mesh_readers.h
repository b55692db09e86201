// What the readers of mesh files share; scenes/mesh_reader.h is what others call.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/mesh.h"

namespace halfslope {

/// The content of a .ply file; `file` is its name for messages. Throws Error(kBadInput) with "file:line" in the header
/// and in ASCII files, "file, byte n" in binary ones. Triangles of area 0 are left in. Memory is bounded by a small
/// multiple of the text's size, whatever it claims.
Mesh parse_ply(std::string_view text, const std::string& file);

/// Likewise of a .obj file. Each combination of position, normal and uv that a face asks for is one position of the
/// mesh. Lines other than v, vn, vt and f are not looked at. v of texture coordinates is turned over, v → 1 − v, as
/// Mitsuba does unless flip_tex_coords is false.
Mesh parse_obj(std::string_view text, const std::string& file);

/// A part of a file for a message: at most 40 letters, and without what a terminal would act upon.
std::string shown(std::string_view part);

/// Normals at each position: those of the triangles around it, weighted by their angles there (G. Thürmer and C.
/// Wüthrich, "Computing Vertex Normals from Polygonal Facets", JGT 3(1), 1998), as Mitsuba computes them. Where they
/// cancel, that of one of the triangles; +z where there is none.
std::vector<Mesh::Point> vertex_normals(const Mesh& mesh);

/// Makes the normals unit length. Those that are (0, 0, 0) are absent, and computed.
void finish_normals(Mesh& mesh);

/// Leaves out the triangles of area 0 and counts them.
void drop_degenerate(Mesh& mesh);

}  // namespace halfslope
