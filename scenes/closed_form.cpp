#include "scenes/closed_form.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scenes/solid_angle.h"

namespace halfslope {
namespace {

using Vec2 = Eigen::Vector2d;
constexpr double kPi = std::numbers::pi, kEpsilon = std::numeric_limits<double>::epsilon();

/// The power of two that brings the largest of these coordinates to [1, 2): products of four lengths then stay in
/// binary64 whatever the unit of length, and no digit changes.
double unit_scale(std::span<const Vec3> vectors) {
  double largest = 0;
  for (const Vec3& vector : vectors) largest = std::max(largest, vector.cwiseAbs().maxCoeff());
  return largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1;
}

/// a b − c d to 1.5 ulp (Kahan).
double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

Vec3 exact_cross(const Vec3& a, const Vec3& b) {
  return {difference_of_products(a.y(), b.z(), a.z(), b.y()), difference_of_products(a.z(), b.x(), a.x(), b.z()),
          difference_of_products(a.x(), b.y(), a.y(), b.x())};
}

/// The part of a polygon where `height`, which is affine, is not negative (Sutherland & Hodgman 1974).
template <class V, class Height>
std::vector<V> clip_below(std::span<const V> vertices, const Height& height) {
  std::vector<V> kept;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const V &a = vertices[i], &b = vertices[(i + 1) % vertices.size()];
    const double height_a = height(a), height_b = height(b);
    if (height_a >= 0) kept.push_back(a);
    if ((height_a < 0) == (height_b < 0)) continue;
    kept.push_back(a + height_a / (height_a - height_b) * (b - a));
  }
  return kept;
}

/// A flat polygon { c + a u + b v } given by its corners (a, b): u and v keep their digits however far away it lies.
struct Patch {
  Vec3 c, u, v;
  std::vector<Vec2> corners;
};

/// ∫ z (n·x)/|x|⁴ dA over one triangle, up to the constant |det(u, v, c)| = (n·x) |u × v|. Every term is positive, so
/// nothing cancels. A triangle no wider than a quarter of its distance D keeps the poles |x|² = 0 eight half widths
/// away, where seven Gauss points a side are exact to 16⁻¹⁴; a wider one is halved across its longest side.
double integrate_triangle(const Patch& patch, const std::array<Vec2, 3>& corners, int depth) {
  const auto at = [&](const Vec2& p) -> Vec3 { return patch.c + p.x() * patch.u + p.y() * patch.v; };
  const auto side = [&](int k) -> Vec2 { return corners[(k + 1) % 3U] - corners[static_cast<std::size_t>(k)]; };
  double longest = 0;
  int split = 0;
  for (int k = 0; k < 3; ++k) {
    const double length = (side(k).x() * patch.u + side(k).y() * patch.v).norm();
    if (length > longest) longest = length, split = k;
  }
  const Vec2 middle = (corners[0] + corners[1] + corners[2]) / 3;
  if (longest > 0.25 * (at(middle).norm() - longest) && depth > 0) {
    const auto k = static_cast<std::size_t>(split);
    const Vec2 cut = 0.5 * (corners[k] + corners[(k + 1) % 3]);
    return integrate_triangle(patch, {corners[k], cut, corners[(k + 2) % 3]}, depth - 1) +
           integrate_triangle(patch, {cut, corners[(k + 1) % 3], corners[(k + 2) % 3]}, depth - 1);
  }
  const Vec2 edge = side(0), across = side(1);
  const double doubled_area = edge.x() * across.y() - edge.y() * across.x();
  using Gauss = boost::math::quadrature::gauss<double, 7>;
  const auto row = [&](double s) {
    const auto integrand = [&](double t) {
      const Vec3 x = at(corners[0] + s * (edge + t * across));
      const double squared = x.squaredNorm();
      return x.z() / (squared * squared);
    };
    return s * Gauss::integrate(integrand, 0.0, 1.0);
  };
  return doubled_area * Gauss::integrate(row, 0.0, 1.0);
}

/// π times the form factor of a patch above the horizon, signed by its orientation.
double integrate_patch(const Patch& patch) {
  const auto height = [&](const Vec2& p) { return patch.c.z() + p.x() * patch.u.z() + p.y() * patch.v.z(); };
  const std::vector<Vec2> corners = clip_below(std::span<const Vec2>(patch.corners), height);
  constexpr int kDeepest = 80;  // reached only by a triangle that touches the origin
  double sum = 0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum += integrate_triangle(patch, {corners[0], corners[i - 1], corners[i]}, kDeepest);
  }
  return sum * exact_cross(patch.u, patch.v).dot(patch.c);
}

/// Lambert's sum, or where its terms cancel (small, narrow and grazing polygons) the integral that it is.
double polygon_sum(std::span<const Vec3> vertices, std::span<const Patch> patches) {
  const std::vector<Vec3> kept = clip_below(vertices, [](const Vec3& x) { return x.z(); });
  double sum = 0, magnitude = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Vec3 &a = kept[i], &b = kept[(i + 1) % kept.size()];
    const Vec3 cross = exact_cross(a, b - a);
    const double sine = cross.norm();
    if (sine == 0) continue;
    const double term = std::atan2(sine, a.dot(b)) * (cross.z() / sine);
    sum += term;
    magnitude += std::abs(term);
  }
  constexpr double kCancellation = 64;
  if (kCancellation * std::abs(sum) >= magnitude) return std::min(std::abs(sum) / (2 * kPi), 1.0);
  sum = 0;
  for (const Patch& patch : patches) sum += integrate_patch(patch);
  return std::min(std::abs(sum) / kPi, 1.0);
}

/// Seen from the origin with normal +z.
double rectangle_form_factor(const Vec3& c, const Vec3& u, const Vec3& v) {
  const std::array<Vec3, 4> vertices = {c - u - v, c + u - v, c + u + v, c - u + v};
  const Patch patch = {c, u, v, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  return polygon_sum(vertices, {&patch, 1});
}

/// The vector irradiance of a cone of directions whose cross-section is an ellipse, with tangents a and b of its half
/// angles, is π L ab/√((1 + a²)(1 + b²)) along its axis (E. Heitz & S. Hill, "Real-Time Line- and Disk-Light Shading
/// with Linearly Transformed Cosines", 2017). The directions c + a u + b v on the rim satisfy dᵀ A⁻¹ d = 0 with A = u
/// uᵀ + v vᵀ − c cᵀ, whose eigenvalues μ₁ ≥ μ₂ > 0 > −μ₃ have a² = μ₁/μ₃, b² = μ₂/μ₃, the last's eigenvector being the
/// axis: |E|/(πL) = √(μ₁μ₂ / ((μ₃ + μ₁)(μ₃ + μ₂))). An eigenvalue that is small beside μ₁ or μ₃ has lost its digits;
/// μ₁μ₂μ₃ = det(u, v, c)², exact, gives them back.
double disk_form_factor(const Vec3& c, const Vec3& u, const Vec3& v) {
  const Eigen::Matrix3d quadric = u * u.transpose() + v * v.transpose() - c * c.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(quadric);  // in increasing order
  const Vec3 axis = solver.eigenvectors().col(0);
  const double mu1 = solver.eigenvalues()[2], mu2 = solver.eigenvalues()[1];
  const double determinant = exact_cross(u, v).dot(c), squared = determinant * determinant;
  double mu3 = -solver.eigenvalues()[0], product = mu1 * mu2;
  if (mu3 >= mu2) {
    product = squared / mu3;
  } else {
    mu3 = squared / product;
  }
  const double cosine = axis.dot(c) > 0 ? axis.z() : -axis.z();
  return std::clamp(cosine * std::sqrt(product / ((mu3 + mu1) * (mu3 + mu2))), 0.0, 1.0);
}

/// arctan t − t for t ≥ 0, by its series where the difference would cancel.
double atan_minus_self(double t) {
  if (t > 0.5) return std::atan(t) - t;
  double power = -t * t * t, sum = 0;
  for (int k = 3; sum + power / k != sum; k += 2) {
    sum += power / k;
    power *= -t * t;
  }
  return sum;
}

/// A sphere of sine s = R/d whose horizon is cut so that only a sliver stands above it: the elevations e from 0 to that
/// of its top, β, each seen over 2φ of azimuth: 1/π ∫ 2φ sin e cos e de. With σ the sphere's half-angle and τ = σ − β
/// the depression of its centre, cos φ = (cos σ + sin τ sin e)/(cos τ cos e), so sin²(φ/2) = sin((σ + τ + e)/2) sin((β
/// − e)/2) / (cos τ cos e); e = β (1 − w²) takes away the root at the top.
double sphere_sliver(double sigma, double tau) {
  const double beta = sigma - tau;
  const auto integrand = [&](double w) {
    const double below = beta * w * w, e = beta - below;
    const double squared = std::sin(0.5 * (sigma + tau + e)) * std::sin(0.5 * below) / (std::cos(tau) * std::cos(e));
    const double phi = 2 * std::asin(std::min(std::sqrt(squared), 1.0));
    return w * phi * std::sin(e) * std::cos(e);
  };
  return 4 * beta / kPi * boost::math::quadrature::gauss<double, 20>::integrate(integrand, 0.0, 1.0);
}

/// A sphere around c, seen from the origin, outside it, with normal +z. Where the horizon cuts it (J. M. Snyder, "Area
/// Light Sources for Real-Time Graphics", 1996), with k = cos θ/s, q = √(1 − k²), c_σ = √(1 − s²), t = q s/c_σ:
/// F = 1/π [ s³ k arccos(−c_σ k/√(1 − s²k²)) − s c_σ q + arctan t ]. For small s the last two cancel down to s³:
/// arctan t − s c_σ q = (arctan t − t) + t s².
double sphere_form_factor(const Vec3& c, double radius) {
  const double distance = c.norm(), s = radius / distance, cosine = c.z() / distance, k = cosine / s;
  if (k >= 1) return s * s * cosine;
  if (k <= -1) return 0;
  if (k < -0.5) return sphere_sliver(std::asin(s), std::asin(-cosine));
  const double q = std::sqrt((1 - k) * (1 + k)), cos_sigma = sphere_cos_half_angle(radius, distance);
  const double t = q * s / cos_sigma, angle = std::atan2(q, -cos_sigma * k);
  const double rest = t < 0.5 ? t * s * s + atan_minus_self(t) : std::atan(t) - s * cos_sigma * q;
  return std::clamp((s * s * s * k * angle + rest) / kPi, 0.0, 1.0);
}

std::optional<double> sphere_light(const Sphere& sphere, const Vec3& position, const Eigen::Matrix3d& to_local) {
  const Vec3 offset = sphere.center - position;
  const double scale = unit_scale(std::array{offset, Vec3(Vec3::Constant(sphere.radius))});
  const Vec3 center = scale * (to_local * offset);
  const double radius = scale * sphere.radius, distance = center.norm();
  const double reach = scale * std::max(position.cwiseAbs().maxCoeff(), sphere.center.cwiseAbs().maxCoeff());
  if (std::abs(distance - radius) <= 4 * kEpsilon * std::max(reach, radius)) return std::nullopt;
  const bool inside = distance < radius;
  if (inside != sphere.flip_normals) return 0;
  return inside ? 1 : sphere_form_factor(center, radius);
}

std::optional<double> flat_light(const Flat& flat, const Vec3& position, const Eigen::Matrix3d& to_local) {
  const Vec3 offset = flat.center - position;
  const double scale = unit_scale(std::array{offset, flat.half_u, flat.half_v});
  const Vec3 c = scale * (to_local * offset), u = scale * (to_local * flat.half_u),
             v = scale * (to_local * flat.half_v);
  const bool disk = flat.outline == Flat::Outline::kDisk;
  const double height = -scale * flat.normal.dot(offset);  // of the position, on the front
  const double reach = scale * std::max(position.cwiseAbs().maxCoeff(), flat.center.cwiseAbs().maxCoeff());
  if (std::abs(height) <= 4 * kEpsilon * std::max(reach, 1.0)) {
    const double a = c.dot(u) / u.squaredNorm(), b = c.dot(v) / v.squaredNorm();
    const bool outside = disk ? a * a + b * b > 1 : std::max(std::abs(a), std::abs(b)) > 1;
    if (!outside) return std::nullopt;
    return 0;
  }
  if (height < 0) return 0;
  if (!disk) return rectangle_form_factor(c, u, v);
  const double rise = std::hypot(u.z(), v.z()), rounding = 4 * kEpsilon * c.norm();
  if (c.z() + rise <= 0) return 0;
  if (c.z() - rise < -rounding) return std::nullopt;
  return disk_form_factor(c, u, v);
}

}  // namespace

double polygon_form_factor(std::span<const Vec3> vertices) {
  const double scale = unit_scale(vertices);
  std::vector<Vec3> scaled;
  for (const Vec3& vertex : vertices) scaled.emplace_back(scale * vertex);
  std::vector<Patch> fan;
  for (std::size_t i = 2; i < scaled.size(); ++i) {
    fan.push_back({scaled[0], scaled[i - 1] - scaled[0], scaled[i] - scaled[0], {{0, 0}, {1, 0}, {0, 1}}});
  }
  return polygon_sum(scaled, fan);
}

std::optional<double> form_factor(const Primitive& light, const Vec3& position, const Vec3& normal) {
  Eigen::Matrix3d to_local;
  const Vec3 tangent = normal.unitOrthogonal();
  to_local << tangent.transpose(), normal.cross(tangent).transpose(), normal.transpose();
  if (const auto* sphere = std::get_if<Sphere>(&light.shape)) return sphere_light(*sphere, position, to_local);
  return flat_light(std::get<Flat>(light.shape), position, to_local);
}

}  // namespace halfslope
