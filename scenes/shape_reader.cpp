#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/readers.h"
#include "scenes/transform.h"

namespace halfslope {
namespace {

/// Directions that agree to this are parallel, or perpendicular: a matrix in a file carries six digits or more, and a
/// product sums some roundings of them.
constexpr double kAngleTolerance = 1e-5;

Sphere read_sphere(Properties& properties) {
  Sphere sphere;
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  const Vec3 center = properties.vector("center").value_or(Vec3::Zero());
  const double radius = properties.number("radius").value_or(1);
  const bool flip_normals = properties.boolean("flip_normals").value_or(false);
  properties.finish();
  if (!(radius > 0)) properties.reject("radius", fmt::format("{}", radius), "above 0");

  const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  const double scale = linear.col(0).norm();
  const Eigen::Matrix3d difference = linear.transpose() * linear - scale * scale * Eigen::Matrix3d::Identity();
  if (!(scale > 0 && difference.cwiseAbs().maxCoeff() <= kAngleTolerance * scale * scale)) {
    properties.reject("to_world", "not a uniform scale", "rotations, translations and one scale for all axes");
  }
  sphere.radius = radius * scale;
  sphere.center = linear * center + to_world.topRightCorner<3, 1>();
  // A mirrored sphere is turned inside out (Mitsuba, sphere.cpp): −1 is taken for its scale, the rest for its rotation.
  const bool mirrored = linear.determinant() < 0;
  sphere.flip_normals = flip_normals != mirrored;
  sphere.from_world = (mirrored ? -1 : 1) / scale * linear.transpose();
  if (!(sphere.radius > 0 && std::isfinite(sphere.radius) && sphere.center.allFinite())) {
    properties.reject("radius", fmt::format("{} in the world", sphere.radius), "a finite size above 0");
  }
  return sphere;
}

Flat read_flat(Properties& properties, Flat::Outline outline) {
  Flat flat;
  flat.outline = outline;
  const bool disk = outline == Flat::Outline::kDisk;
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  const bool flip_normals = properties.boolean("flip_normals").value_or(false);
  properties.finish();
  flat.half_u = to_world.block<3, 1>(0, 0);
  flat.half_v = to_world.block<3, 1>(0, 1);
  flat.center = to_world.block<3, 1>(0, 3);

  const double length_u = flat.half_u.norm(), length_v = flat.half_v.norm();
  const Vec3 cross = flat.half_u.cross(flat.half_v);
  // Normals go by the inverse transpose, whose third column is u × v / det: a mirrored shape keeps its front on the
  // side to which +z is taken.
  const double determinant = cross.dot(to_world.block<3, 1>(0, 2));
  if (!(length_u > 0 && length_v > 0 && determinant != 0 && cross.norm() > 0) || !to_world.allFinite() ||
      !std::isfinite(determinant)) {
    properties.reject(
        "to_world", "degenerate",
        fmt::format("a matrix with a finite inverse, which leaves the {} its area", disk ? "disk" : "rectangle"));
  }
  if (!(std::abs(flat.half_u.dot(flat.half_v)) <= kAngleTolerance * length_u * length_v)) {
    properties.reject(
        "to_world", "a shear",
        fmt::format("transforms that keep the {} perpendicular", disk ? "disk's axes" : "rectangle's sides"));
  }
  // What the file's digits leave of a shear; none where there are enough.
  if (const double along = flat.half_u.dot(flat.half_v); std::abs(along) > 1e-12 * length_u * length_v) {
    flat.half_v -= along / (length_u * length_u) * flat.half_u;
  }
  flat.normal = ((determinant < 0) != flip_normals ? -1.0 : 1.0) * cross.normalized();
  return flat;
}

/// A cylinder stays one where the circle about its axis stays a circle, at right angles to it.
Cylinder read_cylinder(Properties& properties) {
  Cylinder cylinder;
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  const Vec3 p0 = properties.vector("p0").value_or(Vec3::Zero()), p1 = properties.vector("p1").value_or(Vec3::UnitZ());
  const double radius = properties.number("radius").value_or(1);
  const bool flip_normals = properties.boolean("flip_normals").value_or(false);
  properties.finish();
  if (!(radius > 0)) properties.reject("radius", fmt::format("{}", radius), "above 0");
  if (!((p1 - p0).stableNorm() > 0)) properties.reject("p1", "equal to p0", "two points apart from each other");

  const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  const Vec3 along = (p1 - p0).stableNormalized(), across = any_perpendicular(along);
  const Vec3 u = linear * across, v = linear * along.cross(across), w = linear * along;
  const double scale = u.norm(), length = w.norm();
  const bool circular =
      std::abs(v.norm() - scale) <= kAngleTolerance * scale && std::abs(u.dot(v)) <= kAngleTolerance * scale * scale &&
      std::abs(u.dot(w)) <= kAngleTolerance * scale * length && std::abs(v.dot(w)) <= kAngleTolerance * scale * length;
  if (!(scale > 0 && length > 0 && circular)) {
    properties.reject("to_world", "one that leaves no circular cylinder",
                      "rotations, translations, and scales that are equal across its axis");
  }
  cylinder.p0 = linear * p0 + to_world.topRightCorner<3, 1>();
  cylinder.p1 = linear * p1 + to_world.topRightCorner<3, 1>();
  cylinder.radius = radius * scale;
  cylinder.start = u / scale;
  // A mirrored cylinder is turned inside out (Mitsuba, cylinder.cpp).
  cylinder.flip_normals = flip_normals != (linear.determinant() < 0);
  const bool apart = (cylinder.p1 - cylinder.p0).stableNorm() > 0;
  if (!(apart && cylinder.radius > 0 && std::isfinite(cylinder.radius) && cylinder.p0.allFinite() &&
        cylinder.p1.allFinite())) {
    properties.reject("to_world", "one that leaves the cylinder no size in the world", "a finite size above 0");
  }
  return cylinder;
}

Shape read_geometry(Properties& properties, const std::string& type, Reading& reading) {
  if (type == "sphere") return read_sphere(properties);
  if (type == "rectangle") return read_flat(properties, Flat::Outline::kRectangle);
  if (type == "disk") return read_flat(properties, Flat::Outline::kDisk);
  if (type == "cylinder") return read_cylinder(properties);
  return read_mesh(properties, type, reading);
}

}  // namespace

Primitive read_shape(const Element& shape, std::size_t position, Reading& reading) {
  const std::string type = shape.attribute("type");
  const std::vector<std::string> types = {"sphere", "rectangle", "disk", "cylinder", "cube", "obj", "ply"};
  if (std::find(types.begin(), types.end(), type) == types.end()) shape.unknown("shape", type, types);
  Properties properties(shape, {"bsdf", "ref", "emitter"});
  Primitive primitive;
  primitive.id = shape.find("id").value_or(fmt::format("shape{}", position));
  primitive.shape = read_geometry(properties, type, reading);
  reading.ignore(properties);
  if (const auto emitter = properties.object("emitter")) {
    primitive.emits = true;
    primitive.radiance = read_area_emitter(*emitter, reading);
    primitive.bsdf.reflectance = Rgb::Zero();  // Mitsuba's bsdf of an emitter that is given none
  }
  if (const auto bsdf = properties.object("bsdf")) {
    Material material = read_bsdf(*bsdf, reading);
    primitive.bsdf = std::move(material.front);
    primitive.back = std::move(material.back);
  }
  return primitive;
}

}  // namespace halfslope
