#include "estimators/occlusion.h"

#include <Eigen/Geometry>
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
  const auto& r = std::get<Flat>(primitive.shape);
  return {r.center, std::sqrt(r.half_u.squaredNorm() + r.half_v.squaredNorm())};
}

/// How far the primitive reaches along the unit vector n: the largest n · (p − from) of its points p.
double reach(const Primitive& primitive, const Vec3& n, const Vec3& from) {
  if (const auto* sphere = std::get_if<Sphere>(&primitive.shape)) return n.dot(sphere->center - from) + sphere->radius;
  const auto& r = std::get<Flat>(primitive.shape);
  return n.dot(r.center - from) + std::abs(n.dot(r.half_u)) + std::abs(n.dot(r.half_v));
}

// Whether any of the shape is above the plane through the receiver.
bool above_horizon(const Receiver& receiver, const Primitive& primitive) {
  const Ball ball = bounding_ball(primitive);
  const double slack = kSlack * (ball.radius + (ball.center - receiver.position).norm());
  return reach(primitive, receiver.normal, receiver.position) > -slack;
}

}  // namespace

bool inside_sphere(const Receiver& receiver, const Sphere& sphere, bool own) {
  const Vec3 offset = receiver.position - sphere.center;
  if (own) return offset.dot(receiver.normal) < 0;
  return offset.squaredNorm() < sphere.radius * sphere.radius;
}

bool light_reaches(const Receiver& receiver, const Primitive& light, bool own) {
  if (!light.emits || !above_horizon(receiver, light)) return false;
  if (const auto* r = std::get_if<Flat>(&light.shape)) {
    const Vec3 offset = receiver.position - r->center;
    return r->normal.dot(offset) > kSlack * offset.norm();
  }
  // A sphere shows its outside to points outside and its inside to points inside; it emits on its front.
  const auto& sphere = std::get<Sphere>(light.shape);
  const bool inside = inside_sphere(receiver, sphere, own);
  return inside == sphere.flip_normals && (inside || !own);
}

bool can_occlude(const Receiver& receiver, const Primitive& light, const Primitive& shape) {
  if (!above_horizon(receiver, shape)) return false;
  const Ball target = bounding_ball(light), ball = bounding_ball(shape);
  const Vec3 to_target = target.center - receiver.position, to_ball = ball.center - receiver.position;
  const double target_distance = to_target.norm(), ball_distance = to_ball.norm();
  if (const auto* r = std::get_if<Flat>(&shape.shape)) {
    // A segment crosses the plane only if its ends are on different sides of it; an end in the plane is on neither.
    const double slack = kSlack * (ball_distance + target_distance + ball.radius);
    const double here = r->normal.dot(receiver.position - r->center);
    if (std::abs(here) <= slack) return false;
    if (reach(light, here > 0 ? Vec3(-r->normal) : r->normal, r->center) <= slack) return false;
  } else if (ball_distance <= ball.radius) {
    // From inside, a ball blocks what is not inside it as well.
    return (target.center - ball.center).norm() + target.radius > ball.radius * (1 - kSlack);
  }
  if (ball_distance - ball.radius > target_distance + target.radius) return false;
  // The cone around the light against the cone around the shape.
  if (ball_distance <= ball.radius || target_distance <= target.radius) return true;
  const double between = std::atan2(to_target.cross(to_ball).norm(), to_target.dot(to_ball));
  const double touching = std::asin(ball.radius / ball_distance) + std::asin(target.radius / target_distance);
  return between < touching + 1e-7;
}

}  // namespace halfslope
