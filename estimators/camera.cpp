#include "estimators/camera.h"

#include <algorithm>
#include <cmath>

namespace halfslope {
namespace {

/// Of points of the inverse distribution function; between them it is a line, whose density is off by 1e-6 of itself.
constexpr int kFilterPoints = 2049;

template <class T>
void copy(const Vec3& from, T (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(from[i]);
}

/// The filter's integral from −radius to x, over the whole.
double filter_distribution(const ReconstructionFilter& filter, double x) {
  const double r = filter.radius;
  switch (filter.kind) {
    case ReconstructionFilter::Kind::kBox:
      return (x + r) / (2 * r);
    case ReconstructionFilter::Kind::kTent: {
      const double t = 1 - std::abs(x) / r;
      return x < 0 ? 0.5 * t * t : 1 - 0.5 * t * t;
    }
    case ReconstructionFilter::Kind::kGaussian: {
      // ∫ exp(−t²/2σ²) dt − (x + r) exp(−r²/2σ²), over the same at x = r.
      const double s = filter.stddev, floor = std::exp(-r * r / (2 * s * s));
      const auto bell = [&](double t) {
        return s * std::sqrt(std::numbers::pi / 2) * std::erf(t / (s * std::sqrt(2.0)));
      };
      return (bell(x) + bell(r) - (x + r) * floor) / (2 * (bell(r) - r * floor));
    }
  }
  return 0;
}

}  // namespace

std::vector<float> inverse_filter(const Sensor& sensor) {
  if (sensor.kind == Sensor::Kind::kRays) return {};
  const ReconstructionFilter& filter = sensor.filter;
  if (filter.kind == ReconstructionFilter::Kind::kBox) {
    return {static_cast<float>(-filter.radius), static_cast<float>(filter.radius)};  // a line is all there is to it
  }
  std::vector<float> inverse(kFilterPoints);
  for (int i = 0; i < kFilterPoints; ++i) {
    const double target = static_cast<double>(i) / (kFilterPoints - 1);
    double low = -filter.radius, high = filter.radius;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (filter_distribution(filter, middle) < target ? low : high) = middle;
    }
    inverse[static_cast<std::size_t>(i)] = static_cast<float>(0.5 * (low + high));
  }
  return inverse;
}

Camera camera_of(const Sensor& sensor, const Tracing& tracing, int x, int y, int width, int height) {
  Camera camera;
  const Ray centre = sensor.ray(x, y, width, height);
  camera.origin = tracing.to_kernel(centre.origin);
  camera.direction = centre.direction;
  if (sensor.kind == Sensor::Kind::kRays) return camera;
  // Where rays cross the plane at distance 1 along `forward` is linear in the pixel's place, and so are the origins of
  // parallel ones; an image of twice the size has half the steps, whatever its size.
  const auto at = [&](int column, int row) { return sensor.ray(column, row, 2 * width, 2 * height); };
  const auto crossing = [&](const Ray& ray) -> Vec3 { return ray.direction / ray.direction.dot(sensor.forward); };
  const Ray corner = at(0, 0), right = at(1, 0), below = at(0, 1);
  if (sensor.kind == Sensor::Kind::kOrthographic) {
    camera.origin_x = 2 * tracing.unit * (right.origin - corner.origin);
    camera.origin_y = 2 * tracing.unit * (below.origin - corner.origin);
    return camera;
  }
  camera.direction = crossing(centre);
  camera.direction_x = 2 * (crossing(right) - crossing(corner));
  camera.direction_y = 2 * (crossing(below) - crossing(corner));
  if (sensor.kind != Sensor::Kind::kThinLens || !(sensor.aperture_radius > 0)) return camera;
  camera.lens = true;
  camera.lens_u = tracing.unit * sensor.aperture_radius * sensor.left;
  camera.lens_v = tracing.unit * sensor.aperture_radius * sensor.up;
  camera.focus = tracing.unit * sensor.focus_distance;
  return camera;
}

template <class T>
CameraData<T> camera_data(const Camera& camera, std::span<const float> filter) {
  CameraData<T> data;
  copy(camera.origin, data.origin), copy(camera.origin_x, data.origin_x), copy(camera.origin_y, data.origin_y);
  copy(camera.direction, data.direction), copy(camera.direction_x, data.direction_x);
  copy(camera.direction_y, data.direction_y);
  copy(camera.lens_u, data.lens_u), copy(camera.lens_v, data.lens_v);
  data.focus = static_cast<T>(camera.focus);
  data.lens = camera.lens;
  data.filter = filter.data();
  data.filter_size = static_cast<std::int32_t>(filter.size());
  return data;
}
template CameraData<float> camera_data<float>(const Camera&, std::span<const float>);
template CameraData<double> camera_data<double>(const Camera&, std::span<const float>);

}  // namespace halfslope
