// Random scenes with much in the way of much else, and random points on them.
#pragma once

#include <cmath>
#include <random>
#include <variant>
#include <vector>

#include "tests/estimators/scene_builder.h"

namespace halfslope {

class RandomScenes {
 public:
  explicit RandomScenes(std::uint64_t seed) : random_(seed) {}

  double uniform(double lo = 0, double hi = 1) {
    return lo + (hi - lo) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  Vec3 in_box(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }
  Vec3 direction() {
    while (true) {
      const Vec3 v = in_box(1);
      if (v.norm() < 1 && v.norm() > 0.1) return v.normalized();
    }
  }

  /// Spheres, rectangles and ellipses of all sizes in a box, inside each other and through each other; spheres that
  /// show their inside, sometimes one around everything; about half of them emit, the first always. `rays` that meet
  /// the front of something that reflects.
  Scene scene(int rays, double least_alpha) {
    std::vector<Primitive> primitives;
    const int count = 3 + static_cast<int>(uniform(0, 7));
    for (int i = 0; i < count; ++i) {
      Primitive shape;
      if (uniform() < 0.5) {
        shape = sphere(in_box(2), std::pow(10, uniform(-1.5, 0.3)), uniform() < 0.3);
      } else {
        const Vec3 u = direction(), v = u.cross(direction()).normalized();
        shape = rectangle(in_box(2), std::pow(10, uniform(-1, 0.5)) * u, std::pow(10, uniform(-1, 0.5)) * v);
        if (uniform() < 0.5) std::get<Flat>(shape.shape).outline = Flat::Outline::kDisk;
      }
      primitives.push_back(finish(shape, least_alpha));
    }
    if (uniform() < 0.25) primitives.push_back(finish(sphere(in_box(0.5), uniform(5, 9), true), least_alpha));
    primitives[0] = emitting(primitives[0], colour(0.5, 2));
    Scene scene = scene_of(primitives, {});
    for (int tries = 0; static_cast<int>(scene.sensor.rays.size()) < rays && tries < 100 * rays; ++tries) {
      const Ray ray = looking(in_box(3), in_box(2));
      const Hit hit = first_hit(scene, ray);
      if (hit.primitive < 0 || !hit.front || ray.direction.dot(hit.normal) > -0.05) continue;
      if (is_black(scene.primitives[static_cast<std::size_t>(hit.primitive)].bsdf)) continue;
      scene.sensor.rays.push_back(ray);
    }
    return scene;
  }

 private:
  Rgb colour(double lo, double hi) {
    const double r = uniform(lo, hi), g = uniform(lo, hi), b = uniform(lo, hi);
    return {r, g, b};
  }

  Primitive finish(Primitive shape, double least_alpha) {
    if (uniform() < 0.45) shape = emitting(shape, colour(0.5, 2));
    const double kind = uniform();
    if (kind < 0.2) return made_of(shape, diffuse(colour(0.1, 0.9)));
    // The rougher the conductors, the wider the lobes: α = 0.1 with n ≤ 20, α = 0.03 with n ≤ 222.
    const double exponent = std::pow(0.2 / (least_alpha * least_alpha), uniform()) - 1;
    if (kind < 0.4) return made_of(shape, phong(colour(0.1, 0.5), colour(0, 0.5), exponent));
    const double alpha = least_alpha * std::pow(1 / least_alpha, uniform());
    if (kind < 0.6) return made_of(shape, conductor(alpha));
    if (kind < 0.85) return made_of(shape, conductor(alpha, colour(0.1, 2), colour(0.1, 5)));
    return shape;
  }

  std::mt19937_64 random_;
};

}  // namespace halfslope
