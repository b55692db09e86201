#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/readers.h"

namespace halfslope {
namespace {

/// The film must be as wide as there are rays, and 1 high; so it is where the file has none.
void set_rays(Sensor& sensor, std::vector<Ray> rays, const std::optional<Element>& film, Reading& reading) {
  sensor.kind = Sensor::Kind::kRays;
  sensor.rays = std::move(rays);
  sensor.width = static_cast<int>(sensor.rays.size());
  sensor.height = 1;
  if (!film) return;
  if (const Film found = read_film(*film, reading); found.width != sensor.width || found.height != 1) {
    film->error("the film is {} x {}, allowed: {} x 1, a pixel for each ray", found.width, found.height, sensor.width);
  }
}

Ray make_ray(const Properties& properties, const std::string& name, const Vec3& origin, const Vec3& direction) {
  const Vec3 unit = direction.stableNormalized();
  if (!(unit.norm() > 0.5)) properties.reject(name, "a direction of length 0", "directions of any other length");
  return {origin, unit};
}

void read_film_of(const Properties& properties, Reading& reading, Sensor& sensor) {
  Film film;
  if (const auto element = properties.object("film")) film = read_film(*element, reading);
  sensor.width = film.width;
  sensor.height = film.height;
  sensor.filter = film.filter;
}

/// The field of view: `fov`, or a focal length in millimetres of the full-frame format 36 × 24, of which Mitsuba's
/// default is 50: the angle of its diagonal (Mitsuba, parse_fov).
void read_field_of_view(Properties& properties, Sensor& sensor) {
  const auto fov = properties.number("fov");
  const auto focal_length = properties.string("focal_length");
  const std::string axis = properties.string("fov_axis").value_or("x");
  using FovAxis = Sensor::FovAxis;
  const std::map<std::string, FovAxis> axes = {{"x", FovAxis::kX},
                                               {"y", FovAxis::kY},
                                               {"diagonal", FovAxis::kDiagonal},
                                               {"smaller", FovAxis::kSmaller},
                                               {"larger", FovAxis::kLarger}};
  if (!axes.contains(axis)) properties.reject("fov_axis", fmt::format("'{}'", axis), "x, y, diagonal, smaller, larger");
  if (fov && focal_length) properties.reject("focal_length", "given beside fov", "one or the other");
  if (fov) {
    if (!(*fov > 0 && *fov < 180)) properties.reject("fov", fmt::format("{}", *fov), "degrees, above 0 and below 180");
    sensor.fov_degrees = *fov;
    sensor.fov_axis = axes.at(axis);
    return;
  }
  const std::string text = focal_length.value_or("50mm");
  const auto length = parse_numbers(std::string_view(text).substr(0, text.size() - (text.ends_with("mm") ? 2 : 0)));
  if (!length || length->size() != 1 || !(length->front() > 0)) {
    properties.reject("focal_length", fmt::format("'{}'", text), "millimetres above 0, such as 50mm");
  }
  sensor.fov_degrees = 2 * std::atan(std::hypot(36, 24) / (2 * length->front())) * 180 / std::numbers::pi;
  sensor.fov_axis = FovAxis::kDiagonal;
}

/// near_clip and far_clip bound what Mitsuba sees; here all that a ray meets is seen, and nothing moves while a shutter
/// is open. Cameras without a lens take a focus_distance too.
void know_unused(Properties& properties) {
  properties.know({"near_clip", "far_clip", "focus_distance", "shutter_open", "shutter_close"});
}

void place_camera(const Properties& properties, const Eigen::Matrix4d& to_world, Sensor& sensor) {
  const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  // Mitsuba's own tolerance, for matrices with few digits.
  if (!((linear.transpose() * linear - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-3)) {
    properties.reject("to_world", "a transform that scales or shears", "rotations, translations and lookat");
  }
  sensor.origin = to_world.topRightCorner<3, 1>();
  sensor.left = linear.col(0).normalized();
  sensor.up = linear.col(1).normalized();
  sensor.forward = linear.col(2).normalized();
}

/// perspective, or thinlens with a lens.
Sensor read_perspective(Properties& properties, bool lens, Reading& reading) {
  Sensor sensor;
  properties.know({"to_world", "fov", "fov_axis", "focal_length"});
  if (lens) properties.know({"aperture_radius"});
  know_unused(properties);
  properties.finish();
  read_field_of_view(properties, sensor);
  if (lens) {
    sensor.kind = Sensor::Kind::kThinLens;
    const auto radius = properties.number("aperture_radius"), distance = properties.number("focus_distance");
    const auto far_clip = properties.number("far_clip");
    if (!radius) properties.reject("aperture_radius", "absent", "above 0");
    if (!(*radius > 0)) properties.reject("aperture_radius", fmt::format("{}", *radius), "above 0");
    sensor.aperture_radius = *radius;
    sensor.focus_distance = distance.value_or(far_clip.value_or(10'000));  // as Mitsuba
    if (!(sensor.focus_distance > 0)) {
      properties.reject("focus_distance", fmt::format("{}", sensor.focus_distance), "above 0");
    }
  }
  place_camera(properties, properties.transform("to_world").value_or(Eigen::Matrix4d::Identity()), sensor);
  read_film_of(properties, reading, sensor);
  return sensor;
}

/// The image is 2 wide before to_world scales it, and as high as the film's aspect then wants.
Sensor read_orthographic(Properties& properties, Reading& reading) {
  Sensor sensor;
  sensor.kind = Sensor::Kind::kOrthographic;
  properties.know({"to_world"});
  know_unused(properties);
  properties.finish();
  const Eigen::Matrix4d to_world = properties.transform("to_world").value_or(Eigen::Matrix4d::Identity());
  read_film_of(properties, reading, sensor);
  const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
  const Vec3 left = linear.col(0), up = linear.col(1), forward = linear.col(2);
  const bool square = std::abs(left.dot(up)) <= 1e-3 * left.norm() * up.norm() &&
                      std::abs(left.dot(forward)) <= 1e-3 * left.norm() * forward.norm() &&
                      std::abs(up.dot(forward)) <= 1e-3 * up.norm() * forward.norm();
  if (!(linear.allFinite() && left.norm() > 0 && up.norm() > 0 && forward.norm() > 0 && square)) {
    properties.reject("to_world", "a transform that shears or leaves no image",
                      "rotations, translations, lookat and scales before them");
  }
  sensor.origin = to_world.topRightCorner<3, 1>();
  sensor.left = left;
  sensor.up = up * (static_cast<double>(sensor.height) / sensor.width);
  sensor.forward = forward.normalized();
  return sensor;
}

Sensor read_radiancemeter(Properties& properties, Reading& reading) {
  const auto to_world = properties.transform("to_world");
  const auto origin = properties.vector("origin");
  const auto direction = properties.vector("direction");
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
  set_rays(sensor, {ray}, properties.object("film"), reading);
  return sensor;
}

/// `origins` and `directions`: strings of 3 n numbers.
Sensor read_mradiancemeter(Properties& properties, Reading& reading) {
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
  set_rays(sensor, std::move(rays), properties.object("film"), reading);
  return sensor;
}

}  // namespace

Sensor read_sensor(const Element& element, Reading& reading) {
  const std::string type = element.attribute("type");
  const std::vector<std::string> types = {"perspective", "thinlens", "orthographic", "radiancemeter", "mradiancemeter"};
  if (std::find(types.begin(), types.end(), type) == types.end()) element.unknown("sensor", type, types);
  Properties properties(element, {"film", "sampler"});
  const auto read = [&] {
    if (type == "radiancemeter") return read_radiancemeter(properties, reading);
    if (type == "mradiancemeter") return read_mradiancemeter(properties, reading);
    if (type == "orthographic") return read_orthographic(properties, reading);
    return read_perspective(properties, type == "thinlens", reading);
  };
  const Sensor sensor = read();
  reading.ignore(properties);
  if (properties.object("sampler")) ++reading.ignored["<sampler>"];
  return sensor;
}

}  // namespace halfslope
