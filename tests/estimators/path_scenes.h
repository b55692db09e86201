// Scenes for tests of paths.
#pragma once

#include <string>
#include <vector>

#include "estimators/path_transport.h"
#include "tests/estimators/scene_builder.h"

namespace halfslope {

/// A diffuse surface.
inline Primitive diffuse(Primitive primitive, const Rgb& albedo) {
  primitive.bsdf.reflectance = albedo;
  return primitive;
}

/// A sensor of one ray.
inline Sensor one_ray(const Vec3& origin, const Vec3& direction) {
  Sensor sensor;
  sensor.kind = Sensor::Kind::kRays;
  sensor.rays = {{origin, direction.normalized()}};
  sensor.width = sensor.height = 1;
  return sensor;
}

/// The inside of the cube [-1, 1]³, diffuse and emitting alike all over, seen from within.
inline Scene closed_box(double albedo, const Rgb& radiance = Rgb::Ones()) {
  Scene scene;
  scene.name = "closed-box";
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vec3 u = Vec3::Unit((axis + 1) % 3), v = Vec3::Unit((axis + 2) % 3);
      // The front of a rectangle is on the side of u × v, the axis.
      const Vec3 middle = side * Vec3::Unit(axis);
      scene.primitives.push_back(
          emitting(diffuse(side < 0 ? rectangle(middle, u, v) : rectangle(middle, v, u), grey(albedo)), radiance));
    }
  }
  scene.sensor = one_ray(Vec3(0.1, 0.2, 0.3), Vec3(0.3, -0.5, 1));
  return scene;
}

/// Every light technique of paths.
inline std::vector<std::string> light_techniques() {
  return {"light", "light-power", "light-bvh", "light-solid-angle", "light-power-solid-angle", "light-bvh-solid-angle"};
}

/// The estimators that one light technique's paths serve.
inline std::vector<std::string> path_estimators(const std::string& light) {
  const std::string with = "@" + light + "+bsdf";
  std::vector<std::string> names = {"path-" + light};
  for (const char* heuristic : {"average", "balance", "power", "power:3", "cutoff", "maximum"}) {
    names.push_back(std::string("path-") + heuristic + with);
  }
  return names;
}

}  // namespace halfslope
