// A rendered scene as data: shapes, what they are made of, which of them emit, and the rays to follow.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "scenes/bsdf_kind.h"

namespace halfslope {

using Vec3 = Eigen::Vector3d;
using Rgb = Eigen::Array3d;

/// A sphere; its outside is its front unless `flip_normals`.
struct Sphere {
  Vec3 center = Vec3::Zero();
  double radius = 1;
  bool flip_normals = false;
};

/// A flat shape { center + a·half_u + b·half_v } with half_u ⟂ half_v: of all a, b ∈ [−1, 1], a rectangle; of those
/// with a² + b² ≤ 1, a disk (an ellipse where the half axes differ). `normal` is unit length and points to the front.
struct Flat {
  enum class Outline : std::uint8_t { kRectangle, kDisk };
  Vec3 center = Vec3::Zero(), half_u = Vec3::UnitX(), half_v = Vec3::UnitY(), normal = Vec3::UnitZ();
  Outline outline = Outline::kRectangle;
};

/// Reflection at a surface, one-sided: it reflects only where both directions are on the front.
struct Bsdf {
  BsdfKind kind = BsdfKind::kDiffuse;
  Rgb reflectance = Rgb::Constant(0.5);    ///< diffuse albedo, or the conductor's specular_reflectance
  double alpha = 0.1;                      ///< GGX roughness, isotropic, in (0, 1]
  Rgb specular = Rgb::Zero();              ///< of the Phong lobe; `reflectance` is then the diffuse part
  double exponent = 30;                    ///< of the Phong lobe, ≥ 0
  bool unit_fresnel = true;                ///< material "none": F = 1
  Rgb eta = Rgb::Zero(), k = Rgb::Zero();  ///< complex index of refraction per channel, where F is not 1
};

struct Primitive {
  std::variant<Sphere, Flat> shape;
  Bsdf bsdf;
  bool emits = false;
  Rgb radiance = Rgb::Zero();  ///< emitted from the front, where `emits`
  std::string id;              ///< the file's id, or "shape<k>" by position, from 1
};

struct Ray {
  Vec3 origin = Vec3::Zero(), direction = Vec3::UnitZ();  ///< direction is unit length
};

/// perspective: a pinhole camera, one ray through the centre of each pixel. radiancemeter and mradiancemeter: rays
/// given one by one, each a pixel of a 1 × n image.
struct Sensor {
  enum class Kind : std::uint8_t { kPerspective, kRays } kind = Kind::kPerspective;
  Vec3 origin = Vec3::Zero();
  Vec3 left = Vec3::UnitX(), up = Vec3::UnitY(), forward = Vec3::UnitZ();  ///< orthonormal; left is the image's left
  double fov_degrees = 45;
  enum class FovAxis : std::uint8_t { kX, kY, kDiagonal, kSmaller, kLarger } fov_axis = FovAxis::kX;
  std::vector<Ray> rays;  ///< where kind is kRays
  int width = 768, height = 576;

  /// The ray of pixel (x, y) of a width × height image; y grows downwards. For kRays, y is 0 and x the ray's index.
  Ray ray(int x, int y, int image_width, int image_height) const;
};

struct Scene {
  std::string name;
  std::vector<Primitive> primitives;
  Sensor sensor;
};

/// Where a ray first meets the scene.
struct Hit {
  int primitive = -1;  ///< −1 where it leaves the scene
  double distance = 0;
  Vec3 position = Vec3::Zero(), normal = Vec3::UnitZ();  ///< the front's normal, whichever side was hit
  bool front = false;                                    ///< whether the ray met the front
};

/// The nearest intersection with distance > 0, in double precision by the stable forms (the sphere's discriminant from
/// the closest approach; the hit point projected back onto the shape).
Hit first_hit(const Scene& scene, const Ray& ray);

/// Where a ray that goes on from `hit`, on the side it came from, may start: the hit point moved along the normal by 16
/// roundings of the largest coordinate that made it, so that it is off the surface however far from the origin that
/// lies (a fixed offset would be lost there, or show elsewhere).
Vec3 leave_surface(const Primitive& primitive, const Hit& hit);

/// Of one side, with every length multiplied by `scale` first: the squares of the file's may leave binary64.
double area(const Primitive& primitive, double scale = 1);

/// Whether nothing is reflected.
bool is_black(const Bsdf& bsdf);

/// Whether two channels can ever differ: any colour in a radiance, reflectance, eta or k.
bool is_grey(const Scene& scene);

}  // namespace halfslope
