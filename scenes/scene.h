// A rendered scene as data: shapes, what they are made of, which of them emit, and the rays to follow.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenes/bsdf.h"
#include "scenes/emitters.h"
#include "scenes/mesh.h"
#include "scenes/sensor.h"

namespace halfslope {

/// A sphere; its outside is its front unless `flip_normals`.
struct Sphere {
  Vec3 center = Vec3::Zero();
  double radius = 1;
  bool flip_normals = false;
  /// A rotation: (x, y, z) = from_world · (p − center)/radius has u = φ/(2π), φ = atan2(y, x) in [0, 2π), and v = θ/π,
  /// θ = acos z.
  Eigen::Matrix3d from_world = Eigen::Matrix3d::Identity();
};

/// A flat shape { center + a·half_u + b·half_v } with half_u ⟂ half_v: of all a, b ∈ [−1, 1], a rectangle; of those
/// with a² + b² ≤ 1, a disk (an ellipse where the half axes differ). `normal` is unit length and points to the front.
/// The rectangle has u = (a + 1)/2, v = (b + 1)/2; the disk u = √(a² + b²), v = φ/(2π), φ = atan2(b, a) in [0, 2π).
struct Flat {
  enum class Outline : std::uint8_t { kRectangle, kDisk };
  Vec3 center = Vec3::Zero(), half_u = Vec3::UnitX(), half_v = Vec3::UnitY(), normal = Vec3::UnitZ();
  Outline outline = Outline::kRectangle;
};

/// The side of a cylinder around the segment from p0 to p1; its outside is its front unless `flip_normals`. Open at
/// both ends. u is the angle around the axis over 2π, counted from `start` (which need not be perpendicular to it) by
/// the right hand; v goes from 0 at p0 to 1 at p1.
struct Cylinder {
  Vec3 p0 = Vec3::Zero(), p1 = Vec3::UnitZ();
  double radius = 1;
  bool flip_normals = false;
  Vec3 start = Vec3::UnitX();
};

using Shape = std::variant<Sphere, Flat, Cylinder, std::shared_ptr<const Mesh>>;

struct Primitive {
  Shape shape;
  Bsdf bsdf;  ///< of the front; of a dielectric, both sides
  bool emits = false;
  Rgb radiance = Rgb::Zero();     ///< emitted from the front, where `emits`
  std::string id;                 ///< the file's id, or "shape<k>" by position, from 1
  std::optional<Bsdf> back = {};  ///< of a two-sided surface's back, seen from there as if it were a front
};

struct Scene {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<DeltaLight> delta_lights;
  std::optional<Environment> environment;
  Sensor sensor;
  std::optional<int> max_depth;  ///< of the file's integrator, in Mitsuba's count: 1 sees emitters only; −1: no bound
  std::optional<int> rr_depth;   ///< likewise: Russian roulette from this depth on
};

/// Where a ray first meets the scene.
struct Hit {
  int primitive = -1;  ///< −1 where it leaves the scene
  double distance = 0;
  Vec3 position = Vec3::Zero(), normal = Vec3::UnitZ();  ///< the front's normal, whichever side was hit
  bool front = false;                                    ///< whether the ray met the front
};

/// Whether every surface is a sphere, rectangle or disk, one-sided, untextured and of kind kDiffuse, kRoughConductor
/// (isotropic GGX) or kPhong, and every light a surface: what the functions below and direct lighting's own kernels are
/// made for.
bool is_plain(const Scene& scene);

/// Of a plain scene: the nearest intersection with distance > 0, in double precision by the stable forms (the sphere's
/// discriminant from the closest approach; the hit point projected back onto the shape).
Hit first_hit(const Scene& scene, const Ray& ray);

/// Where a ray that goes on from `hit`, on the side it came from, may start: the hit point moved along the normal by 16
/// roundings of the largest coordinate that made it, so that it is off the surface however far from the origin that
/// lies (a fixed offset would be lost there, or show elsewhere).
Vec3 leave_surface(const Primitive& primitive, const Hit& hit);

/// Of one side of a sphere, rectangle, disk, cylinder or mesh, with every length multiplied by `scale` first: the
/// squares of the file's may leave binary64.
double area(const Primitive& primitive, double scale = 1);

/// The middle of a shape; of a mesh, of its bounding box.
Vec3 middle(const Primitive& primitive);

/// The largest length that makes it: a radius, a half axis, a cylinder's length, the diagonal of a mesh's box.
double extent(const Primitive& primitive);

/// Whether two channels can ever differ: any colour in a radiance, reflectance, eta or k.
bool is_grey(const Scene& scene);

}  // namespace halfslope
