// Where a ray first meets any scene: one ray at a time, in double precision.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>

#include "scenes/embree_scene.h"
#include "scenes/scene.h"

namespace halfslope {

/// The most pieces (shapes, and triangles of meshes) that are tried one by one. Measured by
/// benchmarks/rays_benchmark.cpp in binary32: trying each of 64 triangles is 1.7 to 4 times as fast as Embree by AVX2,
/// 3 to 6 times by AVX-512; of 256, 0.6 to 1.9 and 1 to 3.3 times. Packets of binary64 take twice as long to try.
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
  /// The hierarchy that is asked, for others to ask as well; null where each piece is tried.
  const std::shared_ptr<const EmbreeScene>& embree() const { return embree_; }
  std::string why() const { return why_traced(pieces_); }

 private:
  const Scene& scene_;
  std::size_t pieces_;
  std::shared_ptr<const EmbreeScene> embree_;
};

}  // namespace halfslope
