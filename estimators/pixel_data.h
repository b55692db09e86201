// A pixel as its kernels see it: the point it looks at is the origin and that point's normal is the z axis.
#pragma once

#include <cstdint>

#include "scenes/bsdf_kind.h"

namespace halfslope {

/// The ways to draw a direction or a point of light that plain scenes have kernels of their own for: the first of
/// DirectLighting's techniques, in their order.
enum class LightingTechnique : std::uint8_t { kLight, kBsdf, kHemisphere, kCosine, kSurface };
inline constexpr int kLightingTechniques = 5;

enum class ShapeKind : std::uint8_t { kSphere, kRectangle, kDisk };

/// A sphere, rectangle or disk relative to the receiving point, in its local frame. Positions are differences taken in
/// double precision before they are rounded to T, so binary32 kernels lose nothing to the scene's distance from its
/// origin. Lengths are in a unit near the scene's size, so that their squares stay in T's range whatever unit the file
/// is in.
template <class T>
struct LocalShape {
  ShapeKind kind = ShapeKind::kSphere;
  T center[3] = {};
  T radius = 0;              ///< of a sphere
  T u[3] = {}, v[3] = {};    ///< a flat shape's half axes
  T inv_u2 = 0, inv_v2 = 0;  ///< 1/|half axis|²
  T normal[3] = {};          ///< a flat shape's front
  T plane = 0;               ///< normal · center: its sign tells on which side a close receiver is
  bool inside = false;       ///< the receiver is inside the sphere: rays meet the far side
  int light = -1;            ///< its index among the scene's lights, or −1
};

template <class T>
struct LocalLight {
  LocalShape<T> shape;
  T radiance[3] = {};      ///< 0 where it cannot reach the receiver
  T pdf_area = 0;          ///< of technique `light`: 1/area over the number of lights
  T pdf_area_surface = 0;  ///< of technique `surface`: the probability of its light over the light's area
  bool reaches = false;
};

/// All that the kernels of one pixel read. Pointers are to arrays that live as long as the pixel's Integral.
template <class T>
struct PixelData {
  T wo[3];              ///< towards the eye, local; wo[2] > 0
  T world_to_local[9];  ///< rows: the local axes in world space
  BsdfKind bsdf = BsdfKind::kDiffuse;
  bool unit_fresnel = true;
  T alpha = 1;
  T reflectance[3], eta[3], k[3];
  T specular[3] = {}, exponent = 0;  ///< of a Phong lobe
  T specular_share = 0;              ///< of the `bsdf` technique's samples, that go to that lobe
  const LocalLight<T>* lights = nullptr;
  int light_count = 0;
  /// Technique `surface` chooses light l where the choice's high word is above surface_last[l − 1] and not above
  /// surface_last[l]; a word above the last is a surface that does not emit.
  const std::uint32_t* surface_last = nullptr;
  const LocalShape<T>* occluders = nullptr;  ///< shapes that may come between the receiver and some light
  int occluder_count = 0;
};

}  // namespace halfslope
