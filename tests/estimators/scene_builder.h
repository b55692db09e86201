// Scenes built in code.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "estimators/direct_lighting.h"
#include "scenes/scene.h"

namespace halfslope {

inline Rgb grey(double value) { return Rgb::Constant(value); }

/// A shape that neither reflects nor emits.
inline Primitive sphere(const Vec3& center, double radius, bool flip_normals = false) {
  Primitive primitive;
  primitive.shape = Sphere{center, radius, flip_normals};
  primitive.bsdf.reflectance = Rgb::Zero();
  return primitive;
}

/// A shape that neither reflects nor emits; its front is on the side of half_u × half_v.
inline Primitive rectangle(const Vec3& center, const Vec3& half_u, const Vec3& half_v) {
  Primitive primitive;
  primitive.shape = Flat{center, half_u, half_v, half_u.cross(half_v).normalized()};
  primitive.bsdf.reflectance = Rgb::Zero();
  return primitive;
}

/// A disk, or an ellipse where the half axes differ, that neither reflects nor emits; its front as a rectangle's.
inline Primitive disk(const Vec3& center, const Vec3& half_u, const Vec3& half_v) {
  Primitive primitive = rectangle(center, half_u, half_v);
  std::get<Flat>(primitive.shape).outline = Flat::Outline::kDisk;
  return primitive;
}

inline Primitive emitting(Primitive primitive, const Rgb& radiance) {
  primitive.emits = true;
  primitive.radiance = radiance;
  return primitive;
}

inline Primitive made_of(Primitive primitive, const Bsdf& bsdf) {
  primitive.bsdf = bsdf;
  return primitive;
}

inline Primitive named(Primitive primitive, std::string id) {
  primitive.id = std::move(id);
  return primitive;
}

inline Bsdf diffuse(const Rgb& albedo) {
  Bsdf bsdf;
  bsdf.reflectance = albedo;
  return bsdf;
}

/// A GGX conductor with F = 1.
inline Bsdf conductor(double alpha) {
  Bsdf bsdf;
  bsdf.kind = BsdfKind::kRoughConductor;
  bsdf.reflectance = Rgb::Ones();
  bsdf.alpha = alpha;
  return bsdf;
}

inline Bsdf conductor(double alpha, const Rgb& eta, const Rgb& k) {
  Bsdf bsdf = conductor(alpha);
  bsdf.unit_fresnel = false;
  bsdf.eta = eta;
  bsdf.k = k;
  return bsdf;
}

inline Bsdf phong(const Rgb& diffuse, const Rgb& specular, double exponent) {
  Bsdf bsdf;
  bsdf.kind = BsdfKind::kPhong;
  bsdf.reflectance = diffuse;
  bsdf.specular = specular;
  bsdf.exponent = exponent;
  return bsdf;
}

/// The same scene elsewhere: turned about the origin, made larger by `scale`, then moved. Radiances do not change.
inline Scene moved(Scene scene, const Eigen::Matrix3d& turn, double scale, const Vec3& by) {
  const auto point = [&](Vec3& p) { p = scale * (turn * p) + by; };
  const auto direction = [&](Vec3& d) { d = turn * d; };
  for (Primitive& primitive : scene.primitives) {
    if (auto* s = std::get_if<Sphere>(&primitive.shape)) {
      point(s->center);
      s->radius *= scale;
    } else {
      auto& r = std::get<Flat>(primitive.shape);
      point(r.center), direction(r.normal);
      r.half_u = scale * (turn * r.half_u);
      r.half_v = scale * (turn * r.half_v);
    }
  }
  for (Ray& ray : scene.sensor.rays) point(ray.origin), direction(ray.direction);
  return scene;
}

/// Some turn that leaves no axis alone.
inline Eigen::Matrix3d some_turn() { return Eigen::AngleAxisd(1.1, Vec3(2, -3, 4).normalized()).toRotationMatrix(); }

/// The ray from an eye through a point.
inline Ray looking(const Vec3& eye, const Vec3& at) { return {eye, (at - eye).normalized()}; }

/// A scene with a pixel for each ray.
inline Scene scene_of(std::vector<Primitive> primitives, std::vector<Ray> rays) {
  Scene scene;
  scene.name = "built in a test";
  scene.primitives = std::move(primitives);
  scene.sensor.kind = Sensor::Kind::kRays;
  scene.sensor.rays = std::move(rays);
  return scene;
}

inline DirectLighting lighting(Scene scene) {
  const int pixels = static_cast<int>(scene.sensor.rays.size());
  return DirectLighting(std::move(scene), pixels, 1);
}

}  // namespace halfslope
