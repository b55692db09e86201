#include "estimators/occlusion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

namespace halfslope {
namespace {

struct Ball {
  Vec3 center;
  double radius;
};

// A rounding error's worth of slack, relative to the sizes at hand: a test that is unsure must say "perhaps".
constexpr double kSlack = 1e-9;

Ball bounding_ball(const Primitive& primitive) {
  if (const auto* sphere = std::get_if<Sphere>(&primitive.shape)) return {sphere->center, sphere->radius};
  const auto& r = std::get<Rectangle>(primitive.shape);
  return {r.center, std::sqrt(r.half_u.squaredNorm() + r.half_v.squaredNorm())};
}

std::array<Vec3, 4> corners(const Rectangle& r) {
  return {r.center - r.half_u - r.half_v, r.center + r.half_u - r.half_v, r.center - r.half_u + r.half_v,
          r.center + r.half_u + r.half_v};
}

// Whether any of the shape is above the plane through the receiver.
bool above_horizon(const Receiver& receiver, const Primitive& primitive) {
  const auto height = [&](const Vec3& p) { return receiver.normal.dot(p - receiver.position); };
  if (const auto* rectangle = std::get_if<Rectangle>(&primitive.shape)) {
    const auto points = corners(*rectangle);
    const double slack = kSlack * (bounding_ball(primitive).radius + (rectangle->center - receiver.position).norm());
    return std::any_of(points.begin(), points.end(), [&](const Vec3& p) { return height(p) > -slack; });
  }
  const Ball ball = bounding_ball(primitive);
  return height(ball.center) > -ball.radius * (1 + kSlack);
}

}  // namespace

bool inside_sphere(const Receiver& receiver, const Sphere& sphere, bool own) {
  const Vec3 offset = receiver.position - sphere.center;
  if (own) return offset.dot(receiver.normal) < 0;
  return offset.squaredNorm() < sphere.radius * sphere.radius;
}

bool light_reaches(const Receiver& receiver, const Primitive& light) {
  if (!light.emits || !above_horizon(receiver, light)) return false;
  if (const auto* r = std::get_if<Rectangle>(&light.shape)) {
    const Vec3 offset = receiver.position - r->center;
    return r->normal.dot(offset) > kSlack * offset.norm();
  }
  // A sphere shows its outside to points outside and its inside to points inside; it emits on its front.
  const auto& sphere = std::get<Sphere>(light.shape);
  return inside_sphere(receiver, sphere, false) == sphere.flip_normals;
}

bool can_occlude(const Receiver& receiver, const Primitive& light, const Primitive& shape) {
  if (!above_horizon(receiver, shape)) return false;
  const Ball target = bounding_ball(light), ball = bounding_ball(shape);
  const Vec3 to_target = target.center - receiver.position, to_ball = ball.center - receiver.position;
  const double target_distance = to_target.norm(), ball_distance = to_ball.norm();
  if (const auto* r = std::get_if<Rectangle>(&shape.shape)) {
    // A segment crosses the plane only if its ends are on different sides; the receiver may lie in the plane.
    const double slack = kSlack * (ball_distance + target_distance + ball.radius);
    const double here = r->normal.dot(receiver.position - r->center), there = r->normal.dot(target.center - r->center);
    const auto clear = [&](double side) { return side * here > -slack && side * there - target.radius > -slack; };
    if (clear(1) || clear(-1)) return false;
  } else if (ball_distance <= ball.radius) {
    return true;  // the receiver is inside
  }
  if (ball_distance - ball.radius > target_distance + target.radius) return false;
  // The cone around the light against the cone around the shape.
  if (ball_distance <= ball.radius || target_distance <= target.radius) return true;
  const double between = std::atan2(to_target.cross(to_ball).norm(), to_target.dot(to_ball));
  const double reach = std::asin(ball.radius / ball_distance) + std::asin(target.radius / target_distance);
  return between < reach + 1e-7;
}

}  // namespace halfslope
