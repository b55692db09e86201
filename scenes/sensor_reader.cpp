#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "scenes/readers.h"

namespace halfslope {
namespace {

struct Film {
  int width = 768, height = 576;
};

/// The film's size. How Mitsuba stores the image does not touch what is integrated: those names pass unread.
Film read_film(const Element& element) {
  const std::string type = element.attribute("type");
  if (type != "hdrfilm") element.unknown("film", type, {"hdrfilm"});
  Properties properties(element, {"rfilter"});
  Film film;
  const auto size = [&](const std::string& name, int absent) {
    const int value = properties.integer(name).value_or(absent);
    if (value < 1 || value > 65536) properties.reject(name, fmt::format("{}", value), "1 to 65536");
    return value;
  };
  film.width = size("width", film.width);
  film.height = size("height", film.height);
  properties.know({"file_format", "pixel_format", "component_format"});
  properties.finish();
  return film;
}

/// The film must be as wide as there are rays, and 1 high; so it is where the file has none.
void set_rays(Sensor& sensor, std::vector<Ray> rays, const std::optional<Element>& film) {
  sensor.kind = Sensor::Kind::kRays;
  sensor.rays = std::move(rays);
  sensor.width = static_cast<int>(sensor.rays.size());
  sensor.height = 1;
  if (!film) return;
  if (const Film found = read_film(*film); found.width != sensor.width || found.height != 1) {
    film->error("the film is {} x {}, allowed: {} x 1, a pixel for each ray", found.width, found.height, sensor.width);
  }
}

Ray make_ray(const Properties& properties, const std::string& name, const Vec3& origin, const Vec3& direction) {
  const Vec3 unit = direction.stableNormalized();
  if (!(unit.norm() > 0.5)) properties.reject(name, "a direction of length 0", "directions of any other length");
  return {origin, unit};
}

Sensor read_perspective(Properties& properties) {
  Sensor sensor;
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  const auto fov = properties.number("fov");
  const std::string axis = properties.string("fov_axis").value_or("x");
  properties.finish();

  using FovAxis = Sensor::FovAxis;
  const std::map<std::string, FovAxis> axes = {{"x", FovAxis::kX},
                                               {"y", FovAxis::kY},
                                               {"diagonal", FovAxis::kDiagonal},
                                               {"smaller", FovAxis::kSmaller},
                                               {"larger", FovAxis::kLarger}};
  if (!axes.contains(axis)) properties.reject("fov_axis", fmt::format("'{}'", axis), "x, y, diagonal, smaller, larger");
  sensor.fov_axis = axes.at(axis);
  if (!fov) properties.reject("fov", "absent", "degrees, above 0 and below 180");
  if (!(*fov > 0 && *fov < 180)) properties.reject("fov", fmt::format("{}", *fov), "degrees, above 0 and below 180");
  sensor.fov_degrees = *fov;

  const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  if (!((linear.transpose() * linear - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-6)) {
    properties.reject("to_world", "a transform that scales or shears", "rotations, translations and lookat");
  }
  sensor.origin = to_world.topRightCorner<3, 1>();
  sensor.left = linear.col(0).normalized();
  sensor.up = linear.col(1).normalized();
  sensor.forward = linear.col(2).normalized();
  if (const auto film = properties.object("film")) {
    const Film size = read_film(*film);
    sensor.width = size.width;
    sensor.height = size.height;
  }
  return sensor;
}

Sensor read_radiancemeter(Properties& properties) {
  const auto to_world = properties.transform("to_world");
  const auto origin = properties.vector("origin", "point");
  const auto direction = properties.vector("direction", "vector");
  properties.finish();
  if (to_world && (origin || direction)) {
    properties.reject("to_world", "given beside origin or direction", "one or the other");
  }
  if (origin.has_value() != direction.has_value()) {
    properties.reject(origin ? "origin" : "direction", "alone", "both origin and direction");
  }
  Sensor sensor;
  const Eigen::Matrix4d matrix = to_world.value_or(Eigen::Matrix4d::Identity());
  const Ray ray = origin ? make_ray(properties, "direction", *origin, *direction)
                         : make_ray(properties, "to_world", matrix.block<3, 1>(0, 3), matrix.block<3, 1>(0, 2));
  set_rays(sensor, {ray}, properties.object("film"));
  return sensor;
}

/// `origins` and `directions`: strings of 3 n numbers.
Sensor read_mradiancemeter(Properties& properties) {
  const auto origins_text = properties.string("origins"), directions_text = properties.string("directions");
  properties.finish();
  const auto triples = [&](const std::string& name, const std::optional<std::string>& text) {
    const auto numbers = parse_numbers(text.value_or(""));
    if (!numbers || numbers->empty() || numbers->size() % 3 != 0) {
      properties.reject(name, text ? fmt::format("'{}'", *text) : "absent", "x, y, z of each ray, finite numbers");
    }
    return *numbers;
  };
  const std::vector<double> origins = triples("origins", origins_text),
                            directions = triples("directions", directions_text);
  if (origins.size() != directions.size()) {
    properties.reject("directions", fmt::format("{} of them", directions.size() / 3),
                      fmt::format("as many as origins, {}", origins.size() / 3));
  }
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < origins.size(); i += 3) {
    rays.push_back(make_ray(properties, "directions", Vec3(&origins[i]), Vec3(&directions[i])));
  }
  Sensor sensor;
  set_rays(sensor, std::move(rays), properties.object("film"));
  return sensor;
}

}  // namespace

Sensor read_sensor(const Element& element) {
  const std::string type = element.attribute("type");
  const std::vector<std::string> types = {"perspective", "radiancemeter", "mradiancemeter"};
  if (std::find(types.begin(), types.end(), type) == types.end()) element.unknown("sensor", type, types);
  Properties properties(element, {"film", "sampler"});
  if (type == "radiancemeter") return read_radiancemeter(properties);
  if (type == "mradiancemeter") return read_mradiancemeter(properties);
  return read_perspective(properties);
}

}  // namespace halfslope
