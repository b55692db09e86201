#include "scenes/transform.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace halfslope {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

Matrix4d affine(const Eigen::Matrix3d& linear, const Vector3d& translation) {
  Matrix4d matrix = Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = linear;
  matrix.topRightCorner<3, 1>() = translation;
  return matrix;
}

/// Sines and cosines of whole quarter turns are exact, so that a floor turned by 90° stays level.
Eigen::Vector2d cos_sin_degrees(double degrees) {
  const double quarters = std::nearbyint(degrees / 90);
  const double rest = (degrees - 90 * quarters) * std::numbers::pi / 180;
  const double c = std::cos(rest), s = std::sin(rest);
  switch (static_cast<int>(std::fmod(quarters, 4) + 4) % 4) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

Matrix4d read_rotate(const Element& element) {
  element.allow_attributes({"x", "y", "z", "value", "angle"});
  const Vector3d given = element.vector(0);
  if (!(std::abs(given.norm() - 1) < 1e-3)) {
    element.error("the axis of <rotate> is ({}, {}, {}), allowed: a vector of unit length", given.x(), given.y(),
                  given.z());
  }
  const Vector3d axis = given.normalized();
  const Eigen::Vector2d turn = cos_sin_degrees(element.numbers("angle", 1)[0]);
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  // Rodrigues' formula.
  return affine(turn[0] * Eigen::Matrix3d::Identity() + turn[1] * cross + (1 - turn[0]) * axis * axis.transpose(),
                Vector3d::Zero());
}

/// Columns left, up, forward, origin as in Mitsuba: forward = (target − origin)/|…|, left = up × forward/|…|,
/// new up = forward × left.
Matrix4d read_lookat(const Element& element) {
  element.allow_attributes({"origin", "target", "up"});
  const auto point = [&](const char* name) -> Vector3d { return Vector3d(element.numbers(name, 3).data()); };
  const Vector3d origin = point("origin");
  const Vector3d forward = (point("target") - origin).stableNormalized();
  const Vector3d given = element.find("up") ? point("up") : Vector3d::Zero();
  // Without an up, any will do.
  const Vector3d up = given.isZero(0) && forward.norm() > 0.5 ? any_perpendicular(forward) : given;
  const Vector3d left = up.stableNormalized().cross(forward);
  // A zero vector stays zero when normalised, so this one test sees target = origin and up parallel to the view.
  if (!(left.norm() > 1e-8)) {
    element.error(
        "<lookat> has no direction, allowed: a target apart from the origin, and an up not parallel to the view");
  }
  Eigen::Matrix3d linear;
  linear << left.normalized(), forward.cross(left.normalized()), forward;
  return affine(linear, origin);
}

Matrix4d read_matrix(const Element& element) {
  element.allow_attributes({"value"});
  const std::string text = element.attribute("value");
  const auto numbers = parse_numbers(text);
  if (!numbers || (numbers->size() != 9 && numbers->size() != 16)) {
    element.error("<matrix> is '{}', allowed: 16 finite numbers, or 9, row by row", text);
  }
  if (numbers->size() == 9) {
    const Eigen::Matrix3d linear = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers->data());
    return affine(linear, Vector3d::Zero());
  }
  const Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers->data());
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) element.error("the last row of <matrix> must be 0 0 0 1");
  return matrix;
}

}  // namespace

Vector3d any_perpendicular(const Vector3d& n) {
  const double sign = std::copysign(1.0, n.z());
  const double a = -1 / (sign + n.z());
  return {1 + sign * n.x() * n.x() * a, sign * n.x() * n.y() * a, -sign * n.x()};
}

Matrix4d read_transform(const Element& transform) {
  transform.allow_attributes({"name"});
  Matrix4d matrix = Matrix4d::Identity();
  for (const Element& step : transform.children()) {
    const std::string tag = step.tag();
    if (!step.children().empty()) step.error("<{}> has elements inside, allowed: none", tag);
    if (tag == "translate") {
      step.allow_attributes({"x", "y", "z", "value"});
      matrix = affine(Eigen::Matrix3d::Identity(), step.vector(0)) * matrix;
    } else if (tag == "scale") {
      step.allow_attributes({"x", "y", "z", "value"});
      matrix = affine(step.vector(1).asDiagonal(), Vector3d::Zero()) * matrix;
    } else if (tag == "rotate") {
      matrix = read_rotate(step) * matrix;
    } else if (tag == "lookat") {
      matrix = read_lookat(step) * matrix;
    } else if (tag == "matrix") {
      matrix = read_matrix(step) * matrix;
    } else {
      step.unknown("element in <transform>", tag, {"translate", "scale", "rotate", "lookat", "matrix"});
    }
  }
  return matrix;
}

}  // namespace halfslope
