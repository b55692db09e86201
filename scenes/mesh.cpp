#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenes/mesh_reader.h"
#include "scenes/mesh_readers.h"
#include "scenes/shape_hits.h"

namespace halfslope {
namespace {

Mesh::Point to_point(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Vec3 to_vec(const Mesh::Point& p) { return {p[0], p[1], p[2]}; }

/// Twice the area, along the normal.
Vec3 area_vector(const Mesh& mesh, std::size_t triangle) {
  const Vec3 p0 = corner(mesh, triangle, 0);
  return (corner(mesh, triangle, 1) - p0).cross(corner(mesh, triangle, 2) - p0);
}

/// The angle between two vectors, by Kahan's form: exact near 0 and π, where acos of the dot product is not.
double angle_between(const Vec3& a, const Vec3& b) {
  const Vec3 u = a.normalized(), v = b.normalized();
  return 2 * std::atan2((u - v).norm(), (u + v).norm());
}

}  // namespace

std::vector<Mesh::Point> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> sums(mesh.positions.size(), Vec3::Zero());
  std::vector<std::size_t> one(mesh.positions.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 normal = area_vector(mesh, t).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 here = corner(mesh, t, k);
      const double angle = angle_between(corner(mesh, t, (k + 1) % 3) - here, corner(mesh, t, (k + 2) % 3) - here);
      sums[mesh.triangles[t][k]] += angle * normal;
      one[mesh.triangles[t][k]] = t;
    }
  }
  std::vector<Mesh::Point> normals(mesh.positions.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    Vec3 normal = sums[i];
    // Angles are below π, so what is left of a sum that cancels is rounding.
    if (!(normal.norm() > 1e-12)) {
      normal = one[i] < mesh.triangles.size() ? area_vector(mesh, one[i]) : Vec3::UnitZ();
    }
    normals[i] = to_point(normal.normalized());
  }
  return normals;
}

void finish_normals(Mesh& mesh) {
  const bool some_absent =
      std::any_of(mesh.normals.begin(), mesh.normals.end(), [](const Mesh::Point& n) { return to_vec(n).isZero(0); });
  const std::vector<Mesh::Point> computed = some_absent ? vertex_normals(mesh) : std::vector<Mesh::Point>();
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const Vec3 normal = to_vec(mesh.normals[i]);
    mesh.normals[i] = normal.isZero(0) ? computed[i] : to_point(normal.normalized());
  }
}

void drop_degenerate(Mesh& mesh) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!area_vector(mesh, t).isZero(0)) mesh.triangles[kept++] = mesh.triangles[t];
  }
  mesh.degenerate += mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
}

Mesh make_cube() {
  // The order of Mitsuba's corners: it says where each face's uv begins.
  struct Face {
    std::array<Mesh::Point, 4> corners;
    Mesh::Point normal;
  };
  constexpr std::array<Face, 6> kFaces = {{
      {{{{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}}}, {0, -1, 0}},
      {{{{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}}}, {0, 1, 0}},
      {{{{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}}}, {1, 0, 0}},
      {{{{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}}}, {0, 0, 1}},
      {{{{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}}}, {-1, 0, 0}},
      {{{{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}}, {0, 0, -1}},
  }};
  constexpr std::array<std::array<float, 2>, 4> kUvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  Mesh mesh;
  for (const Face& face : kFaces) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t k = 0; k < 4; ++k) {
      mesh.positions.push_back(face.corners[k]);
      mesh.normals.push_back(face.normal);
      mesh.uvs.push_back(kUvs[k]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first + 3, first, first + 2});
  }
  return mesh;
}

Mesh transformed(const Mesh& mesh, const Eigen::Matrix4d& to_world, bool flip_normals, bool face_normals) {
  const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  const Vec3 translation = to_world.topRightCorner<3, 1>();
  // Cofactors are the inverse transpose times the determinant: they leave binary64 later than the inverse does.
  Eigen::Matrix3d cofactors;
  for (int i = 0; i < 3; ++i) cofactors.col(i) = linear.col((i + 1) % 3).cross(linear.col((i + 2) % 3));
  const double determinant = linear.col(0).dot(cofactors.col(0));
  if (!to_world.allFinite() || !std::isfinite(determinant) || determinant == 0)
    fail(ExitCode::kBadInput, "the mesh's transform has no inverse, allowed: a matrix with one");

  Mesh world = mesh;
  for (Mesh::Point& p : world.positions) {
    const Vec3 moved = linear * to_vec(p) + translation;
    p = to_point(moved);
    if (!to_vec(p).allFinite()) {
      fail(ExitCode::kBadInput, "a position comes to ({}, {}, {}) in the world, allowed: what binary32 holds",
           moved.x(), moved.y(), moved.z());
    }
  }
  drop_degenerate(world);
  if (world.triangles.empty()) {
    fail(ExitCode::kBadInput, "all {} triangles of the mesh come to area 0, allowed: one that does not",
         world.degenerate);
  }
  const bool mirrored = determinant < 0;
  if (mirrored != flip_normals) {
    for (auto& triangle : world.triangles) std::swap(triangle[1], triangle[2]);
  }
  if (face_normals) {
    world.normals.clear();
  } else if (world.normals.empty()) {
    world.normals = vertex_normals(world);
  } else {
    for (Mesh::Point& n : world.normals) {
      Vec3 normal = cofactors * to_vec(n);
      normal /= normal.cwiseAbs().maxCoeff();  // squares of what a transform makes may leave binary64
      n = to_point((mirrored != flip_normals ? -1 : 1) * normal.normalized());
    }
  }
  return world;
}

}  // namespace halfslope
