// A whole scene as the transport kernels see it: plain data, in one precision.
//
// Every surface is made of pieces: flat ones (rectangles, disks and the triangles of meshes), then spheres, then
// cylinders, in one numbering. Lengths are the scene's own where Embree intersects it (meshes are binary32 there, and
// stay exactly what they are); where our own shapes do, they are about the scene's middle and in a unit near its size,
// so that squares stay in T's range.
#pragma once

#include <cstdint>

#include "core/point_block.h"
#include "scenes/environment_map.h"
#include "scenes/light_bvh.h"
#include "scenes/material_data.h"
#include "scenes/ray_packet.h"

namespace halfslope {

/// The points p0 + a u + b v: a triangle or parallelogram from its corner (a, b ≥ 0), or an ellipse from its middle.
template <class T>
struct FlatPiece {
  T p0[3], u[3], v[3];
  T normal[3];   ///< of the front, unit length
  T tangent[3];  ///< where its first texture coordinate grows
  T outline;     ///< its LightKind
};

/// What finds a and b of a point p on a flat piece's plane: a = dual_u · p − offset_u.
template <class T>
struct FlatTest {
  T normal[3], plane;
  T dual_u[3], offset_u;
  T dual_v[3], offset_v;
  std::int32_t piece;
};

template <class T>
struct SpherePiece {
  T center[3], radius;
  T side;              ///< +1 where the front is outside, −1 where it is inside
  T x[3], y[3], z[3];  ///< its own axes, for texture coordinates and tangents
};

template <class T>
struct CylinderPiece {
  T p0[3], axis[3], length, radius;  ///< axis is unit length
  T side;
  T start[3];  ///< across the axis, unit length: where its texture begins
};

/// Normals and texture coordinates of a flat piece at p0, p0 + u and p0 + v; the normals are 0 where it is flat.
struct TriangleAttributes {
  float normals[3][3];
  float uvs[3][2];
};

/// A colour over (u, v); scenes/texture.h says what it means.
template <class T>
struct TextureData {
  std::int32_t bitmap;  ///< 0: checkerboard
  std::int32_t nearest, wrap, width, height;
  T color0[3], color1[3], to_uv[6];
  const float* rgb;
};

/// What a piece is made of: indices of materials, −1 where a side only absorbs; and the light element that its front
/// is, −1 where it does not emit.
struct PieceSides {
  std::int32_t front, back;
  std::int32_t two_sided;  ///< 1: the back is seen as a front of its own; 0: front and back are one dielectric
  std::int32_t light;
};

inline constexpr int kTextured = 4;  ///< reflectance, specular, transmittance, opacity
struct MaterialTextures {
  std::int32_t texture[kTextured];
};

enum class LightKind : std::uint8_t {
  kRectangle,
  kTriangle,
  kDisk,
  kSphere,
  kCylinder,
  kEnvironment,
  kPoint,
  kSpot,
  kDirectional
};

/// A light of one piece, or none.
template <class T>
struct LightElement {
  LightKind kind;
  std::int32_t piece;          ///< −1: no surface
  T radiance[3];               ///< intensity of point and spot lights, irradiance of directional ones
  T pdf_area;                  ///< 1 / area of the piece
  T position[3];               ///< of point and spot lights
  T axis[3];                   ///< of spot and directional lights: the way that light travels
  T beam_width, inverse_fade;  ///< of a spot light; 1/(cutoff − beam width), 0 where they are equal
  T cutoff;
};

/// How a light is chosen. Element l where the choice's high word is above last[l − 1] and not above last[l].
template <class T>
struct LightTable {
  const std::uint32_t* last;
  const T* probability;  ///< exactly its words · 2⁻³²
};

template <class T>
struct TransportScene {
  const FlatPiece<T>* flats;
  bool framed_flats;         ///< whether some flat piece is no triangle
  const FlatTest<T>* tests;  ///< parallelograms, then triangles, then disks; none where Embree intersects
  std::int32_t parallelograms, triangles, disks;
  const SpherePiece<T>* spheres;
  const CylinderPiece<T>* cylinders;
  std::int32_t flat_count, sphere_count, cylinder_count;
  const PieceSides* sides;               ///< one a piece
  const TriangleAttributes* attributes;  ///< one a flat piece; null where no mesh has any
  const MaterialData<T>* materials;
  const std::int32_t* material_class;  ///< one a material: those of one BSDF class (scenes/bsdf_classes.h) have one
  std::int32_t only_class;             ///< of all materials; −1 where there are several
  const T* opacities;                  ///< one a material
  const MaterialTextures* material_textures;  ///< null where nothing is textured
  const TextureData<T>* textures;
  bool masked;       ///< some material's opacity is not 1
  bool transmits;    ///< some material scatters to its other side
  bool two_sided;    ///< some surface has a back of its own
  bool anisotropic;  ///< some material needs the surface's tangent
  // Embree, where it intersects the scene: it names primitives, whose pieces begin at first_piece.
  const void* embree;
  void (*embree_first)(const void* embree, RayPacket* rays);
  void (*embree_occluded)(const void* embree, RayPacket* rays);
  const std::int32_t* first_piece;
  T reach;  ///< the largest coordinate of all, whose roundings a ray's start must leave
  const LightElement<T>* lights;
  std::int32_t light_count;               ///< that are chosen from
  std::int32_t certain_count;             ///< delta lights after them, which are not
  LightTable<T> uniform, power, surface;  ///< a word above surface.last chooses what does not emit
  LightBvhData<T> bvh;
  const EnvironmentMapData<T>* environment;  ///< null: nothing beyond the shapes
  std::int32_t environment_light;            ///< its element, or −1
};

}  // namespace halfslope
