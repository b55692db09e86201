#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/readers.h"

namespace halfslope {
namespace {

/// Directions that agree to this are parallel, or perpendicular: files carry six digits or more.
constexpr double kAngleTolerance = 1e-6;

Sphere read_sphere(Properties& properties) {
  Sphere sphere;
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  const Vec3 center = properties.vector("center", "point").value_or(Vec3::Zero());
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
  // A mirrored sphere is turned inside out (Mitsuba, sphere.cpp).
  sphere.flip_normals = flip_normals != (linear.determinant() < 0);
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
  flat.normal = ((determinant < 0) != flip_normals ? -1.0 : 1.0) * cross.normalized();
  return flat;
}

Rgb read_area_emitter(const Element& element) {
  const std::string type = element.attribute("type");
  if (type != "area") element.unknown("emitter", type, {"area"});
  Properties properties(element, {});
  const auto radiance = properties.colour("radiance");
  properties.finish();
  if (!radiance) properties.reject("radiance", "absent", "<rgb>, <spectrum>, <float>");
  if (!(*radiance >= 0).all()) {
    properties.reject("radiance", fmt::format("({}, {}, {})", (*radiance)[0], (*radiance)[1], (*radiance)[2]),
                      "0 or more in each channel");
  }
  return *radiance;
}

Bsdf find_bsdf(const Element& reference, const std::map<std::string, Bsdf>& bsdfs) {
  reference.allow_attributes({"id", "name"});
  const std::string id = reference.attribute("id");
  const auto found = bsdfs.find(id);
  if (found != bsdfs.end()) return found->second;
  std::vector<std::string> ids;
  for (const auto& entry : bsdfs) ids.push_back(entry.first);
  reference.unknown("bsdf id", id, ids);
}

}  // namespace

Primitive read_shape(const Element& shape, const std::map<std::string, Bsdf>& bsdfs, std::size_t position) {
  const std::string type = shape.attribute("type");
  const std::vector<std::string> types = {"sphere", "rectangle", "disk"};
  if (std::find(types.begin(), types.end(), type) == types.end()) shape.unknown("shape", type, types);
  Properties properties(shape, {"bsdf", "ref", "emitter"});
  Primitive primitive;
  primitive.id = shape.find("id").value_or(fmt::format("shape{}", position));
  if (type == "sphere") {
    primitive.shape = read_sphere(properties);
  } else {
    primitive.shape = read_flat(properties, type == "disk" ? Flat::Outline::kDisk : Flat::Outline::kRectangle);
  }
  const auto emitter = properties.object("emitter"), bsdf = properties.object("bsdf"), ref = properties.object("ref");
  if (bsdf && ref) ref->error("a <ref> beside a <bsdf> in one shape, allowed: one or the other");
  if (emitter) {
    primitive.emits = true;
    primitive.radiance = read_area_emitter(*emitter);
    primitive.bsdf.reflectance = Rgb::Zero();  // Mitsuba's bsdf of an emitter that is given none
  }
  if (bsdf) primitive.bsdf = read_bsdf(*bsdf);
  if (ref) primitive.bsdf = find_bsdf(*ref, bsdfs);
  return primitive;
}

}  // namespace halfslope
