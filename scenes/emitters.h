// Lights that are no surface.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <variant>

#include "scenes/texture.h"

namespace halfslope {

using Vec3 = Eigen::Vector3d;

struct PointLight {
  Vec3 position = Vec3::Zero();
  Rgb intensity = Rgb::Ones();  ///< W/sr
};

/// From infinitely far away; `direction` is unit length and the way that the light travels.
struct DirectionalLight {
  Vec3 direction = Vec3::UnitZ();
  Rgb irradiance = Rgb::Ones();  ///< on a surface that faces it
};

/// A point light in a cone about the unit vector `axis`: full intensity up to beam_width from it, falling linearly in
/// the angle to 0 at cutoff_angle (radians, 0 < beam_width ≤ cutoff_angle ≤ π/2).
struct SpotLight {
  Vec3 position = Vec3::Zero(), axis = Vec3::UnitZ();
  Rgb intensity = Rgb::Ones();
  double cutoff_angle = 0.349065850398866, beam_width = 0.261799387799149;
};

/// Lights that only a connection finds: no direction drawn at random ever meets them.
using DeltaLight = std::variant<PointLight, DirectionalLight, SpotLight>;

/// Radiance from all around: `radiance`, or a latitude-longitude map of it times `scale`. Seen along the unit vector d
/// in world space, with l = from_world · d, the map shows u = atan2(l.x, −l.z)/(2π) (modulo 1) and v = acos(l.y)/π,
/// rows from the top, as Mitsuba's envmap.
struct Environment {
  Rgb radiance = Rgb::Ones();
  std::shared_ptr<const Bitmap> map;  ///< null: constant
  double scale = 1;
  Eigen::Matrix3d from_world = Eigen::Matrix3d::Identity();  ///< a rotation, perhaps mirrored
  bool mis_compensation = false;  ///< sampled by the map less its mean (Karlík and others 2019)
};

/// The solid angle in sr that a light of a spot's full intensity would fill to emit the spot's power: power over
/// intensity.
double solid_angle(const SpotLight& spot);

/// The mean over all directions, scale included; of a map, exactly as it is interpolated.
Rgb mean_radiance(const Environment& environment);

}  // namespace halfslope
