// Where a ray first meets any scene: one ray at a time, in double precision.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>

#include "scenes/embree_scene.h"
#include "scenes/scene.h"

namespace halfslope {

/// The most pieces (shapes, and triangles of meshes) among which trying each is faster than Embree's hierarchy, in
/// packets: measured by benchmarks/rays_benchmark.cpp.
inline constexpr std::size_t kHandful = 64;

/// Shapes that are no mesh, and triangles of those that are.
std::size_t count_pieces(const Scene& scene);

/// Why a scene of so many pieces is traced as it is, for people: "14 pieces, at most 64: each is tried".
std::string why_traced(std::size_t pieces);

/// A point of a surface, as a ray meets it.
struct SurfaceHit {
  int primitive = -1;  ///< −1 where the ray leaves the scene
  int triangle = 0;    ///< of a mesh
  double distance = 0;
  Vec3 position = Vec3::Zero();         ///< on the shape
  Vec3 normal = Vec3::UnitZ();          ///< geometric, the front's, whichever side was hit
  Vec3 shading_normal = Vec3::UnitZ();  ///< of a mesh with normals: theirs, interpolated; else `normal`
  Eigen::Vector2d uv =
      Eigen::Vector2d::Zero();  ///< as scenes/scene.h has them; of a mesh without, (u, v) of the triangle
  bool front = false;           ///< whether the ray met the front of `normal`
};

/// Tries each piece of a scene with a handful of them, in double precision throughout; asks Embree which is first in a
/// larger one, with the ray rounded to binary32, and computes the hit from that piece in double precision. Keeps a
/// reference to the scene, which must outlive it.
class Intersector {
 public:
  /// Errors as EmbreeScene's.
  explicit Intersector(const Scene& scene);

  /// The nearest hit with distance > 0. Thread-safe.
  SurfaceHit first(const Ray& ray) const;

  bool uses_embree() const { return embree_ != nullptr; }
  std::string why() const { return why_traced(pieces_); }

 private:
  const Scene& scene_;
  std::size_t pieces_;
  std::unique_ptr<EmbreeScene> embree_;
};

}  // namespace halfslope
