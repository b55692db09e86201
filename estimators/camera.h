// The rays of a sensor's pixels, for kernels.
#pragma once

#include <span>
#include <vector>

#include "estimators/transport_calls.h"
#include "estimators/transport_data.h"
#include "scenes/scene.h"

namespace halfslope {

/// CameraData in double precision.
struct Camera {
  Vec3 origin = Vec3::Zero(), origin_x = Vec3::Zero(), origin_y = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ(), direction_x = Vec3::Zero(), direction_y = Vec3::Zero();
  Vec3 lens_u = Vec3::Zero(), lens_v = Vec3::Zero();
  double focus = 1;
  bool lens = false;
};

/// The rays of pixel (x, y) of a width × height image, y downwards, in the kernels' lengths.
Camera camera_of(const Sensor& sensor, const Tracing& tracing, int x, int y, int width, int height);

template <class T>
CameraData<T> camera_data(const Camera& camera, std::span<const float> filter);

/// The filter's inverse distribution function at i/(n − 1): offsets from the pixel's centre, in pixels. Drawn so, every
/// sample has the same weight (M. Ernst, M. Stamminger, G. Greiner, "Filter importance sampling", 2006). Empty for
/// sensors whose rays are given one by one.
std::vector<float> inverse_filter(const Sensor& sensor);

}  // namespace halfslope
