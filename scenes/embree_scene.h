// A scene's geometry in Embree.
#pragma once

#include <cstdint>
#include <memory>

#include "scenes/ray_packet.h"
#include "scenes/scene.h"

namespace halfslope {

/// The shapes of a scene in a bounding volume hierarchy: meshes as Embree's triangles in its robust mode, the others
/// by our own double-precision code (scenes/shape_hits.h). It keeps its own copy of them. Between triangles that share
/// an edge no ray passes but, now and then, one that is aimed at a corner to the last bit.
///
/// Results are the same bits for any number of threads and on every machine of one instruction set class: Embree is
/// held to AVX2 where the class is "fma", to SSE2 for the baseline, and finds the primitive alone; the distance and the
/// barycentrics are then computed here, from the corners, in double precision. (Embree divides by the processor's
/// approximate reciprocal, which is not the same everywhere. Where two surfaces are as near to each other as its
/// rounding, which of them comes first may still depend on it.)
///
/// Thread-safe once made. Built by the threads of oneTBB's arena that the constructor is called in.
class EmbreeScene {
 public:
  /// Builds in milliseconds, or about half a second for a million triangles. Throws Error(kBadInput) with Embree's
  /// reason where it fails, for want of memory or for coordinates beyond 1e18.
  explicit EmbreeScene(const Scene& scene);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene();

  /// As scenes/ray_packet.h says. A ray with a coordinate of 1e18 or more, or one that is not a number, meets nothing.
  void first(RayPacket& packet) const;
  void occluded(RayPacket& packet) const;

  /// The same as functions that kernels call; `scene` is an EmbreeScene.
  static void first_of(const void* scene, RayPacket* packet);
  static void occluded_of(const void* scene, RayPacket* packet);

  /// Of one ray: what it meets at distances above 0, in binary32.
  struct Found {
    std::int32_t primitive = -1, triangle = 0;  ///< −1 where nothing is met
    double distance = 0, u = 0, v = 0;
  };
  Found first(const Ray& ray) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace halfslope
