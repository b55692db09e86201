// Meshes in space: the cube, transforms, fronts, vertex normals, and files as a whole.
#include "scenes/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/error.h"
#include "scenes/mesh_reader.h"
#include "scenes/mesh_readers.h"
#include "scenes/shape_hits.h"
#include "tests/scenes/scene_folder.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;

Vec3 vec(const Mesh::Point& p) { return {p[0], p[1], p[2]}; }

Vec3 face_normal(const Mesh& mesh, std::size_t t) {
  const Vec3 p0 = corner(mesh, t, 0);
  return (corner(mesh, t, 1) - p0).cross(corner(mesh, t, 2) - p0).normalized();
}

Vec3 face_middle(const Mesh& mesh, std::size_t t) {
  return (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3;
}

/// The volume that a closed mesh encloses, negative where its fronts are inside.
double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += corner(mesh, t, 0).dot(corner(mesh, t, 1).cross(corner(mesh, t, 2))) / 6;
  return sum;
}

Eigen::Matrix4d matrix(const Eigen::Affine3d& transform) { return transform.matrix(); }

TEST(Cube, IsTwoByTwoByTwoWithItsFrontOutside) {
  const Mesh cube = make_cube();
  EXPECT_EQ(cube.triangles.size(), 12U);
  EXPECT_DOUBLE_EQ(volume(cube), 8);
  for (std::size_t t = 0; t < 12; ++t) {
    EXPECT_GT(face_normal(cube, t).dot(face_middle(cube, t)), 0.9) << t;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(vec(cube.normals[cube.triangles[t][k]]), face_normal(cube, t)) << t;
  }
}

TEST(Cube, EachFaceShowsTheUnitSquareOnce) {
  const Mesh cube = make_cube();
  ASSERT_EQ(cube.uvs.size(), 24U);
  double area = 0;
  for (const auto& triangle : cube.triangles) {
    const auto edge = [&](std::size_t k) {
      return Eigen::Vector2d(double{cube.uvs[triangle[k]][0]} - double{cube.uvs[triangle[0]][0]},
                             double{cube.uvs[triangle[k]][1]} - double{cube.uvs[triangle[0]][1]});
    };
    area += std::abs(edge(1).x() * edge(2).y() - edge(1).y() * edge(2).x()) / 2;
  }
  EXPECT_DOUBLE_EQ(area, 6);
}

TEST(Transformed, MovesAndKeepsTheFrontOutside) {
  const Eigen::Affine3d move =
      Eigen::Translation3d(5, 0, 0) * Eigen::AngleAxisd(0.5, Vec3(1, 2, 2) / 3) * Eigen::Scaling(1.0, 2.0, 3.0);
  for (const bool mirrored : {false, true}) {
    const Eigen::Affine3d all = mirrored ? move * Eigen::Scaling(-1.0, 1.0, 1.0) : move;
    for (const bool flipped : {false, true}) {
      const Mesh cube = transformed(make_cube(), matrix(all), flipped, false);
      EXPECT_NEAR(volume(cube), flipped ? -48 : 48, 1e-4);
      for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 normal = vec(cube.normals[cube.triangles[t][k]]);
          EXPECT_NEAR(normal.norm(), 1, 1e-6);
          EXPECT_NEAR(normal.dot(face_normal(cube, t)), 1, 1e-6);
        }
      }
    }
  }
}

TEST(Transformed, FacesCanBeFlat) {
  EXPECT_TRUE(transformed(make_cube(), Eigen::Matrix4d::Identity(), false, true).normals.empty());
}

TEST(Transformed, HugeAndTinyTransformsKeepNormals) {
  for (const double scale : {1e-30, 1e30}) {
    const Mesh cube = transformed(make_cube(), matrix(Eigen::Affine3d(Eigen::Scaling(scale))), false, false);
    EXPECT_EQ(cube.triangles.size(), 12U);
    EXPECT_EQ(vec(cube.normals[0]), Vec3(0, -1, 0));
  }
}

std::string failure(const Eigen::Matrix4d& to_world) {
  try {
    transformed(make_cube(), to_world, false, false);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "no error";
}

TEST(Transformed, RefusesWhatLeavesNoMesh) {
  Eigen::Matrix4d flat = Eigen::Matrix4d::Identity();
  flat(2, 2) = 0;
  EXPECT_EQ(failure(flat), "the mesh's transform has no inverse, allowed: a matrix with one");
  flat(2, 2) = std::nan("");
  EXPECT_EQ(failure(flat), "the mesh's transform has no inverse, allowed: a matrix with one");
  EXPECT_EQ(failure(matrix(Eigen::Affine3d(Eigen::Scaling(1e39)))),
            "a position comes to (1e+39, -1e+39, -1e+39) in the world, allowed: what binary32 holds");
  EXPECT_EQ(failure(matrix(Eigen::Translation3d(1e12, 1e12, 1e12) * Eigen::Affine3d(Eigen::Scaling(1e-3)))),
            "all 12 triangles of the mesh come to area 0, allowed: one that does not");
}

/// A latitude-longitude sphere without normals.
Mesh sphere(std::uint32_t n) {
  Mesh mesh;
  mesh.positions.push_back({0, 0, 1});
  for (std::uint32_t i = 1; i < n; ++i) {
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
      const double theta = std::numbers::pi * i / n, phi = std::numbers::pi * j / n;
      mesh.positions.push_back({static_cast<float>(std::sin(theta) * std::cos(phi)),
                                static_cast<float>(std::sin(theta) * std::sin(phi)),
                                static_cast<float>(std::cos(theta))});
    }
  }
  mesh.positions.push_back({0, 0, -1});
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * 2 * n + j % (2 * n); };
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (std::uint32_t j = 0; j < 2 * n; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({last, at(n - 1, j + 1), at(n - 1, j)});
    for (std::uint32_t i = 1; i + 1 < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TEST(VertexNormals, OfASpherePointOutwards) {
  // An inscribed polygon mesh's normals are off by the order of its squared angles.
  const Mesh mesh = transformed(sphere(32), Eigen::Matrix4d::Identity(), false, false);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    EXPECT_GT(vec(mesh.normals[i]).dot(vec(mesh.positions[i])), 1 - 1e-4) << i;
}

TEST(VertexNormals, AreWeightedByAngleNotByCountOrArea) {
  // A cube's corner with one face cut into thin and uneven triangles: each face has a right angle there.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {100, 1, 0}, {1, 1000, 0}, {1, 2, 0}};
  mesh.triangles = {{0, 3, 1}, {0, 2, 3}, {0, 1, 4}, {0, 4, 6}, {0, 6, 5}, {0, 5, 2}};
  const Vec3 normal = vec(vertex_normals(mesh)[0]);
  EXPECT_LT((normal - Vec3(1, 1, 1).normalized()).norm(), 1e-6) << normal.transpose();
}

TEST(VertexNormals, ThatCancelAreThoseOfATriangle) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  const auto normals = vertex_normals(mesh);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(vec(normals[static_cast<std::size_t>(i)]).cwiseAbs(), Vec3(0, 0, 1));
  EXPECT_EQ(vec(normals[3]), Vec3(0, 0, 1));  // no triangle is there
}

class MeshFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) { return folder_.write(name, text); }
  std::string failure(const std::filesystem::path& path) {
    try {
      load_mesh(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "no error";
  }
  const SceneFolder folder_;
};

TEST_F(MeshFile, DegenerateTrianglesAreCountedAndLeftOut) {
  const Mesh mesh = load_mesh(write("a.OBJ",
                                    "v 0 0 0\nv 1 0 0\nv 0.1 0.1 0.1\nv 0.3 0.3 0.3\nv 0 0 1\n"
                                    "f 1 2 5\nf 1 1 2\nf 1 3 4\nf 2 5 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_EQ(mesh.degenerate, 3U);
}

TEST_F(MeshFile, NormalsAreMadeUnitLengthAndAbsentOnesComputed) {
  const Mesh mesh =
      load_mesh(write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nvn 0 3 4\nvn 0 0 0\nf 1//1 2//1 3//2\nf 1 4 2\n"));
  EXPECT_LT((vec(mesh.normals[0]) - Vec3(0, 0.6, 0.8)).norm(), 1e-6);
  EXPECT_EQ(vec(mesh.normals[2]), Vec3(0, 0, 1));
  EXPECT_EQ(vec(mesh.normals[3]), Vec3(0, 0, 1));
}

TEST_F(MeshFile, WithoutAMeshIsAnError) {
  EXPECT_THAT(failure(folder_ / "none.ply"), HasSubstr("none.ply"));
  EXPECT_THAT(failure(folder_ / ""), HasSubstr("an unknown kind of mesh"));
  std::filesystem::create_directories(folder_ / "folder.ply");
  EXPECT_THAT(failure(folder_ / "folder.ply"), HasSubstr("folder.ply"));
  EXPECT_THAT(failure(write("a.stl", "solid")), HasSubstr("an unknown kind of mesh '.stl', allowed: .ply, .obj"));
  EXPECT_THAT(failure(write("b.obj", "v 0 0 0\n")), HasSubstr("b.obj: no face, allowed: one or more"));
  EXPECT_THAT(failure(write("c.obj", "v 0 0 0\nv 1 1 1\nf 1 2 1\nf 1 1 1\n")),
              HasSubstr("c.obj: all 2 triangles have area 0, allowed: one that does not"));
}

}  // namespace
}  // namespace halfslope
