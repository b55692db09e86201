#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/readers.h"

namespace halfslope {
namespace {

std::string spelled(const Rgb& colour) { return fmt::format("({}, {}, {})", colour[0], colour[1], colour[2]); }

/// Of power: 1 where it is not given, as in Mitsuba.
Rgb read_power(Properties& properties, const std::string& name) {
  const Rgb power = properties.colour(name).value_or(Rgb::Ones());
  if (!(power >= 0).all()) properties.reject(name, spelled(power), "0 or more in each channel");
  return power;
}

Vec3 unit(const Properties& properties, const std::string& name, const Vec3& direction) {
  const Vec3 found = direction.stableNormalized();
  if (!(found.norm() > 0.5)) properties.reject(name, "a direction of length 0", "directions of any other length");
  return found;
}

PointLight read_point(Properties& properties) {
  PointLight light;
  properties.know({"intensity", "position", "to_world"});
  properties.finish();
  light.intensity = read_power(properties, "intensity");
  const auto position = properties.vector("position");
  const auto to_world = properties.transform("to_world");
  if (position && to_world) properties.reject("to_world", "given beside position", "one or the other");
  if (position) light.position = *position;
  if (to_world) light.position = to_world->topRightCorner<3, 1>();
  return light;
}

DirectionalLight read_directional(Properties& properties) {
  DirectionalLight light;
  properties.know({"irradiance", "direction", "to_world"});
  properties.finish();
  light.irradiance = read_power(properties, "irradiance");
  const auto direction = properties.vector("direction");
  const auto to_world = properties.transform("to_world");
  if (direction && to_world) properties.reject("to_world", "given beside direction", "one or the other");
  if (direction) light.direction = unit(properties, "direction", *direction);
  if (to_world) light.direction = unit(properties, "to_world", to_world->block<3, 1>(0, 2));
  return light;
}

SpotLight read_spot(Properties& properties) {
  SpotLight light;
  properties.know({"intensity", "cutoff_angle", "beam_width", "to_world"});
  properties.finish();
  light.intensity = read_power(properties, "intensity");
  const double cutoff = properties.number("cutoff_angle").value_or(20);
  const double beam = properties.number("beam_width").value_or(0.75 * cutoff);
  if (!(cutoff > 0 && cutoff <= 90)) {
    properties.reject("cutoff_angle", fmt::format("{}", cutoff), "degrees, above 0, up to 90");
  }
  if (!(beam > 0 && beam <= cutoff)) {
    properties.reject("beam_width", fmt::format("{}", beam), fmt::format("above 0, up to cutoff_angle, {}", cutoff));
  }
  light.cutoff_angle = cutoff * std::numbers::pi / 180;
  light.beam_width = beam * std::numbers::pi / 180;
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  light.position = to_world.topRightCorner<3, 1>();
  light.axis = unit(properties, "to_world", to_world.block<3, 1>(0, 2));
  return light;
}

/// A light from infinitely far away does not see where it is moved to, nor how large its sphere is made.
Eigen::Matrix3d read_rotation(Properties& properties) {
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  const double scale = linear.col(0).norm();
  const Eigen::Matrix3d rotation = linear / scale;
  const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(scale > 0 && error <= 1e-3)) {
    properties.reject("to_world", "no rotation", "rotations, translations and one scale for all axes");
  }
  return rotation.transpose();
}

Environment read_environment_map(Properties& properties, Reading& reading) {
  Environment environment;
  properties.know({"filename", "scale", "to_world", "mis_compensation"});
  properties.finish();
  environment.scale = properties.number("scale").value_or(1);
  if (!(environment.scale >= 0)) properties.reject("scale", fmt::format("{}", environment.scale), "0 or more");
  environment.from_world = read_rotation(properties);
  environment.mis_compensation = properties.boolean("mis_compensation").value_or(false);
  environment.map = read_image(properties, reading, false);
  if (environment.map->width < 2 || environment.map->height < 3) {
    properties.reject("filename",
                      fmt::format("an image of {} x {} pixels", environment.map->width, environment.map->height),
                      "2 x 3 or more, as in Mitsuba");
  }
  return environment;
}

Environment read_constant(Properties& properties) {
  Environment environment;
  properties.know({"radiance"});
  properties.finish();
  environment.radiance = read_power(properties, "radiance");
  return environment;
}

}  // namespace

std::variant<DeltaLight, Environment> read_emitter(const Element& element, Reading& reading) {
  const std::string type = element.attribute("type");
  const std::vector<std::string> types = {"point", "directional", "spot", "constant", "envmap"};
  if (type == "area") element.error("emitter 'area' outside of a shape, allowed: inside the shape that emits");
  if (std::find(types.begin(), types.end(), type) == types.end()) element.unknown("emitter in <scene>", type, types);
  Properties properties(element, {});
  // It says how often Mitsuba chooses the light, not what it emits.
  properties.know({"sampling_weight"});
  const auto read = [&]() -> std::variant<DeltaLight, Environment> {
    if (type == "point") return read_point(properties);
    if (type == "directional") return read_directional(properties);
    if (type == "spot") return read_spot(properties);
    if (type == "constant") return read_constant(properties);
    return read_environment_map(properties, reading);
  };
  auto light = read();
  reading.ignore(properties);
  return light;
}

Rgb read_area_emitter(const Element& element, Reading& reading) {
  const std::string type = element.attribute("type");
  if (type != "area") element.unknown("emitter", type, {"area"});
  Properties properties(element, {});
  const auto radiance = properties.colour("radiance");
  properties.know({"sampling_weight"});
  properties.finish();
  reading.ignore(properties);
  if (!radiance) properties.reject("radiance", "absent", "<rgb>, <spectrum>, <float>");
  if (!(*radiance >= 0).all()) properties.reject("radiance", spelled(*radiance), "0 or more in each channel");
  return *radiance;
}

}  // namespace halfslope
