// Form factors of disks, ellipses and spheres against published values, limits and quadrature of their definition.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scenes/closed_form.h"
#include "tests/scenes/form_factor_helpers.h"

namespace halfslope {
namespace {

double disk_by_quadrature(const Flat& flat) {
  const double jacobian = flat.half_u.norm() * flat.half_v.norm();
  return jacobian * integrate(
                        [&](double r) {
                          return r * integrate(
                                         [&](double phi) {
                                           return density(flat.center + r * std::cos(phi) * flat.half_u +
                                                              r * std::sin(phi) * flat.half_v,
                                                          flat.normal);
                                         },
                                         0, 2 * kPi, 24);
                        },
                        0, 1, 16);
}

TEST(DiskFormFactor, ParallelDisks) {
  const auto at = [](double r, double h, double a) { return factor(disk({a, 0, h}, {r, 0, 0}, {0, r, 0})); };
  close(at(1, 2, 0), 0.2, 1e-15);
  close(at(2, 0.3, 1.5), 0.9052108391896465, 1e-14);
  close(at(1, 1, 3), 0.011906469908023687, 1e-13);
  for (const double h : {0.05, 0.5, 3.0, 40.0}) {
    for (const double a : {0.1, 0.5, 2.0, 7.0}) {
      // ½ (1 − p/q), p = Z − 2R², q = √(Z² − 4R²), Z = 1 + H² + R²; q² − p² = 4R²H², so ½ (q − p)/q is also
      // 2R²H²/(q (q + p)).
      const double H = h / a, R = 1 / a, Z = 1 + H * H + R * R, p = Z - 2 * R * R,
                   q = std::sqrt(std::pow(1 + H * H - R * R, 2) + 4 * R * R * H * H);
      close(at(1, h, a), p > 0 ? 2 * R * R * H * H / (q * (q + p)) : 0.5 * (1 - p / q), 1e-12);
    }
  }
}

TEST(DiskFormFactor, TiltedAndEllipticalDisksAgreeWithQuadrature) {
  const std::array<Flat, 5> lights = {
      disk({0.4, -0.7, 1.5}, {1, 0.2, 0.3}, {-0.06, 0.6, -0.2}), disk({2, 1, 3}, {0, 0.5, 0.5}, {1.2, 0, 0}),
      disk({-3, 4, 2.5}, {2, 0, 1}, {-0.5, 0.3, 1}), disk({0.1, 0.2, 0.6}, {3, 0, 0}, {0, 2, 0}),
      disk({5, 0, 1}, {0, 0, 1}, {0, 0.1, 0})};  // the last stands on the horizon
  for (const Flat& light : lights) {
    ASSERT_NEAR(light.half_u.dot(light.half_v), 0, 1e-15);
    close(factor(light), disk_by_quadrature(light), 1e-12);
  }
}

TEST(DiskFormFactor, SmallAndNearDisksKeepTheirDigits) {
  for (const double size : {1e-3, 1e-6, 1e-12}) {
    const Vec3 c(0.3, -0.4, 1.2), u = size * Vec3(1, 0, 0.5), v = size * Vec3(-0.5, 2, 1);
    const double r2 = c.squaredNorm();
    const double point = kPi * u.norm() * v.norm() * c.z() * std::fabs(disk(c, u, v).normal.dot(c)) / (kPi * r2 * r2);
    close(factor(disk(c, u, v)), point, 1e-14 + 10 * size * size);
  }
  for (const double h : {1e-2, 1e-5, 1e-9}) {  // on the axis, 1 − F = h²/(1 + h²)
    EXPECT_NEAR(*factor(disk({0, 0, h}, {1, 0, 0}, {0, 1, 0})), 1 / (1 + h * h), 1e-15);
  }
}

TEST(DiskFormFactor, ACutDiskHasNone) {
  EXPECT_EQ(factor(disk({2, 0, 0.5}, {0, 1, 0}, {0, 0, 1})), std::nullopt);
  EXPECT_EQ(factor(disk({2, 0, -0.5}, {0, 1, 0}, {0, 0, 1})), std::nullopt);
  EXPECT_EQ(factor(disk({2, 0, -1.5}, {0, 1, 0}, {0, 0, 1})), 0);
  EXPECT_TRUE(factor(disk({2, 0, 1.5}, {0, 1, 0}, {0, 0, 1})).has_value());
}

/// Rings at the angle α from the sphere's direction: ∫ (A + B cos φ)⁺ dφ = 2 (A φ₀ + B sin φ₀), A = cos θ cos α,
/// B = sin θ sin α, cos φ₀ = −A/B; whole and empty rings end at α₀ = |π/2 − θ|, behind which the integrand has a
/// root.
double sphere_by_quadrature(double theta, double sigma) {
  const auto ring = [&](double alpha) {
    const double a = std::cos(theta) * std::cos(alpha), b = std::sin(theta) * std::sin(alpha);
    if (a >= b) return 2 * kPi * a * std::sin(alpha);
    if (a <= -b) return 0.0;
    const double phi = std::acos(-a / b);
    return 2 * (a * phi + b * std::sin(phi)) * std::sin(alpha);
  };
  const double bend = std::min(std::fabs(kPi / 2 - theta), sigma);
  const auto behind = [&](double w) { return 2 * w * ring(bend + (sigma - bend) * w * w); };
  return (integrate(ring, 0, bend, 8) + (sigma - bend) * integrate(behind, 0, 1, 8)) / kPi;
}

TEST(SphereFormFactor, PublishedValues) {
  const auto at = [](double r, double d, double degrees) {
    const double theta = degrees * kPi / 180;
    return factor(sphere(d * Vec3(std::sin(theta), 0, std::cos(theta)), r));
  };
  close(at(1, 2, 45), 0.17677669529663692, 1e-15);
  close(at(1, 2, 70), 0.08765460334902503, 2e-15);
  close(at(1, 2, 110), 0.0021495675176077954, 1e-14);
  close(at(0.9, 4.0, 85), 0.005185693420762436, 2e-15);
}

TEST(SphereFormFactor, AgreesWithQuadratureAcrossTheHorizon) {
  for (const double s : {0.02, 0.3, 0.7, 0.99}) {
    const double sigma = std::asin(s);
    for (const double part : {-0.95, -0.7, -0.51, -0.49, -0.2, 0.0, 0.3, 0.8, 0.999, 1.2}) {
      const double theta = std::fabs(kPi / 2 - part * sigma);
      const auto found = factor(sphere(Vec3(std::sin(theta), 0, std::cos(theta)), s));
      close(found, sphere_by_quadrature(theta, sigma), part < -0.9 ? 1e-9 : 1e-11);
    }
  }
}

TEST(SphereFormFactor, FarSpheresAndSliversKeepTheirDigits) {
  for (const double s : {1e-3, 1e-5, 1e-8, 1e-12}) {
    const auto at = [&](double k) {  // cos θ = k s
      const double cosine = k * s;
      return *factor(sphere(Vec3(std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine), s));
    };
    // As s → 0 the sphere is a disk of radius s at height ks: F/s³ → 1/π ∫ (k + y)⁺ over the unit disk
    // = (k arccos(−k) + √(1 − k²)(2 + k²)/3)/π.
    for (const double k : {-0.6, -0.4, 0.0, 0.5, 0.9}) {
      const double root = std::sqrt(1 - k * k);
      close(at(k), s * s * s * (k * std::acos(-k) + root * (2 + k * k) / 3) / kPi, 1e-13 + s * s);
    }
    // Just below its rising, k = −1 + δ: ∫₀^δ (δ − t) 2√(2t) dt = (8√2/15) δ^(5/2), the circle being its parabola.
    const double delta = 1e-4;
    close(at(-1 + delta), s * s * s * 8 * std::sqrt(2) / 15 / kPi * std::pow(delta, 2.5), delta + 1e-12 / delta + s);
  }
  // From the surface's neighbourhood all of one side of the sky is lit.
  close(factor(sphere({0, 0, 1 + 1e-12}, 1)), 1, 1e-11);
  close(factor(sphere({1 + 1e-12, 0, 0}, 1)), 0.5, 1e-5);
}

}  // namespace
}  // namespace halfslope
