// Form factors of polygons, and what every form factor must satisfy: published and independent values, quadrature.
#include "scenes/closed_form.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/scenes/form_factor_helpers.h"

namespace halfslope {
namespace {

double rectangle_by_quadrature(const Flat& flat, double lowest_b = -1) {
  const double jacobian = flat.half_u.norm() * flat.half_v.norm();
  return jacobian *
         integrate(
             [&](double b) {
               return integrate(
                   [&](double a) { return density(flat.center + a * flat.half_u + b * flat.half_v, flat.normal); }, -1,
                   1, 24);
             },
             lowest_b, 1, 24);
}

TEST(PolygonFormFactor, TriangleLights) {
  // Receiver normal +y in the data: a turn about x takes y to z. L_o = ρ/π · L · E/(πL) · π with ρ = 1/2.
  struct Case {
    std::array<Vec3, 3> vertices;
    double radiance;
  };
  const std::array<Case, 3> cases = {{
      {{{{-0.17487, 0.447916, 0.367201}, {-0.405259, 0.249607, -0.354079}, {0.356029, 0.0918984, -0.132271}}},
       0.2617398588913051},
      {{{{-0.443432, 0.596366, 0.495985}, {-0.320397, 0.0677699, -0.229359}, {0.0341197, 0.11415, -0.343049}}},
       0.08983925851739037},
      {{{{-0.17575, 0.639397, 0.151268}, {0.318604, 0.732996, 0.459771}, {0.139095, 0.294498, 0.478556}}},
       0.020531391486139028},
  }};
  for (const Case& c : cases) {
    std::vector<Vec3> turned;
    for (const Vec3& v : c.vertices) turned.emplace_back(v.x(), -v.z(), v.y());
    close(0.5 * polygon_form_factor(turned), c.radiance, 1e-14);
    const std::vector<Vec3> reversed(turned.rbegin(), turned.rend());
    close(0.5 * polygon_form_factor(reversed), c.radiance, 1e-14);
  }
}

TEST(PolygonFormFactor, NothingBelowTheHorizonOrOfNoArea) {
  const std::array<Vec3, 3> below = {{{0, 0, -1}, {1, 0, -1}, {0, 1, -2}}};
  EXPECT_EQ(polygon_form_factor(below), 0);
  EXPECT_EQ(polygon_form_factor({}), 0);
  const std::array<Vec3, 3> edge_on = {{{1, 0, 0.5}, {2, 0, 1.5}, {3, 0, 1}}};
  EXPECT_LE(polygon_form_factor(edge_on), 1e-15);
}

TEST(RectangleFormFactor, ParallelAboveACorner) {
  // a × b at height c, a corner above the receiver; and four of them around it.
  close(factor(rectangle({1, 0.5, 0.5}, {1, 0, 0}, {0, 0.5, 0})), 0.2207776223347616, 1e-14);
  close(factor(rectangle({2, 2, 0.1}, {2, 0, 0}, {0, 2, 0})), 0.24987220674946534, 1e-14);
  close(factor(rectangle({0, 0, 0.5}, {2, 0, 0}, {0, 1, 0})), 4 * 0.2207776223347616, 1e-14);
}

TEST(RectangleFormFactor, AgreesWithQuadrature) {
  const std::array<Flat, 4> lights = {
      rectangle({0.4, -0.7, 1.5}, {1, 0.2, 0.3}, {-0.06, 0.6, -0.2}), rectangle({2, 1, 3}, {0, 0.5, 0.5}, {1.2, 0, 0}),
      rectangle({-3, 4, 2.5}, {2, 0, 1}, {-0.5, 0.3, 1}), rectangle({0.1, 0.2, 0.6}, {3, 0, 0}, {0, 2, 0})};
  for (const Flat& light : lights) {
    ASSERT_NEAR(light.half_u.dot(light.half_v), 0, 1e-15);
    close(factor(light), rectangle_by_quadrature(light), 1e-13);
  }
}

TEST(RectangleFormFactor, TheHorizonCutsIt) {
  // half_u is level, so that the cut is at b = −z/(half_v)_z.
  const Flat light = rectangle({1, 0.5, 0.3}, {0, 2, 0}, {0.4, 0, 0.9});
  close(factor(light), rectangle_by_quadrature(light, -0.3 / 0.9), 1e-13);
  // Cut corner-wise: the halves beside a vertical line are mirror images.
  const Flat standing = rectangle({1, 0, 0}, {0, 1, 1}, {0, 1, -1});
  const std::array<Vec3, 3> upper = {{{1, -2, 0}, {1, 2, 0}, {1, 0, 2}}};
  close(factor(standing), polygon_form_factor(upper), 1e-14);
  // A wall from the ground up, half of which is below: its infinite limit is a quarter sphere's cosine, F = 1/2.
  close(factor(rectangle({1, 0, 0}, {0, 1e9, 0}, {0, 0, 1e9})), 0.5, 1e-8);
  close(factor(rectangle({1, 0, -0.5}, {0, 1, 0}, {0, 0, 1})),
        *factor(rectangle({1, 0, 0.25}, {0, 1, 0}, {0, 0, 0.25})), 1e-14);
}

TEST(RectangleFormFactor, ParametersFarFromOneHold) {
  // A hundredth, a thousandth, … of the distance: Lambert's sum in 64-bit mantissas against it in 53.
  for (const double size : {3e-2, 1e-3, 3e-5, 1e-7, 1e-10, 1e-14}) {
    const Vec3 c(0.3, -0.4, 1.2), u = size * Vec3(1, 0, 0.5), v = size * Vec3(-0.5, 2, 1);
    const Flat light = rectangle(c, u, v);
    const double area = 4 * u.norm() * v.norm(), r2 = c.squaredNorm();
    const double point = area * c.z() * std::fabs(light.normal.dot(c)) / (kPi * r2 * r2);
    close(factor(light), point, 1e-14 + 20 * size * size);  // the next term is of second order
    if (size < 1e-4) continue;
    const auto corner = [&](int i) -> Eigen::Matrix<long double, 3, 1> {
      const long double a = i == 1 || i == 2 ? 1 : -1, b = i >= 2 ? 1 : -1;
      return c.cast<long double>() + a * u.cast<long double>() + b * v.cast<long double>();
    };
    long double sum = 0;
    for (int i = 0; i < 4; ++i) {
      const auto p = corner(i), q = corner((i + 1) % 4);
      const Eigen::Matrix<long double, 3, 1> cross = p.cross(q - p);
      sum += std::atan2(cross.norm(), p.dot(q)) * cross.z() / cross.norm();
    }
    close(factor(light), static_cast<double>(std::fabs(sum) / (2 * std::numbers::pi_v<long double>)),
          1e-14 + 1e-18 / size);
  }
}

TEST(RectangleFormFactor, NarrowAndGrazingLightsKeepTheirDigits) {
  // A tube 2 long and 2w wide, one above the other: F = w · dF/dw at w = 0, from the closed form of the parallel strip
  // ∫ h² / (h² + x²)² dx = x/(2(h² + x²)) + atan(x/h)/(2h).
  const double h = 0.7;
  for (const double w : {1e-4, 1e-6, 1e-9}) {
    const double line = 2 * w * 2 * (1 / (2 * (h * h + 1)) + std::atan(1 / h) / (2 * h)) / kPi;
    close(factor(rectangle({0, 0, h}, {1, 0, 0}, {0, w, 0})), line, 3 * w * w + 1e-13);
  }
  // Beside the receiver, a little above its plane: F → h²/π ∫ dA/|x|⁴.
  for (const double low : {1e-3, 1e-5, 1e-7}) {
    const Flat light = rectangle({3, 0, low}, {1, 0, 0}, {0, 1, 0});
    const double flat = integrate(
        [&](double x) { return integrate([&](double y) { return std::pow(x * x + y * y, -2); }, -1, 1, 4); }, 2, 4, 4);
    close(factor(light), low * low * flat / kPi, low * low + 1e-13);
  }
}

TEST(RectangleFormFactor, ALightOverTheWholeSkyIsOne) {
  close(factor(rectangle({0.3, 0.1, 1e-9}, {1, 0, 0}, {0, 1, 0})), 1, 1e-15);
  EXPECT_LE(*factor(rectangle({0, 0, 1e-12}, {1, 0, 0}, {0, 1, 0})), 1);
}

TEST(FormFactor, SplitLightsAddUp) {
  const Vec3 c(0.5, 1, 0.4), u(1, 0.2, 0.3), v(-0.06, 0.6, -0.2);
  for (const double shift : {0.0, -0.4, -0.6}) {  // above, across and mostly below the horizon
    const Vec3 center = c + shift * kUp;
    double sum = 0;
    for (const double side : {-1.0, 1.0}) {
      for (const double end : {-1.0, 1.0}) {
        const Flat part = rectangle(center + 0.5 * side * u + 0.5 * end * v, 0.5 * u, 0.5 * v);
        sum += *factor(part);
      }
    }
    close(factor(rectangle(center, u, v)), sum, 1e-13);
  }
}

TEST(FormFactor, SidesThatDoNotEmitGiveNothing) {
  for (const auto outline : {Flat::Outline::kRectangle, Flat::Outline::kDisk}) {
    Flat light = flat_of({0.2, 0.1, 1}, {1, 0, 0}, {0, 1, 0}, outline);
    EXPECT_GT(*factor(light), 0.4);
    light.normal = -light.normal;
    EXPECT_EQ(factor(light), 0);
    const Flat below = flat_of({0.2, 0.1, -1}, {1, 0, 0}, {0, 1, 0}, outline);
    EXPECT_EQ(factor(below), 0);
    const Flat beside = flat_of({3, 0, 0}, {1, 0, 0}, {0, 1, 0}, outline);  // the receiver is in its plane
    EXPECT_EQ(factor(beside), 0);
    const Flat touching = flat_of({0.5, 0, 0}, {1, 0, 0}, {0, 1, 0}, outline);
    EXPECT_EQ(factor(touching), std::nullopt);
  }
  EXPECT_EQ(factor(sphere({0, 0, 3}, 1, true)), 0);
  EXPECT_EQ(factor(sphere({0, 0, 0.5}, 1)), 0);
  EXPECT_EQ(factor(sphere({0, 0, 0.5}, 1, true)), 1);
  EXPECT_EQ(factor(sphere({0, 0, -0.5}, 1, true)), 1);
  EXPECT_EQ(factor(sphere({0, 0, 1}, 1)), std::nullopt);
  EXPECT_EQ(factor(sphere({0, 0, -3}, 1)), 0);
  EXPECT_EQ(factor(sphere({0, 3, -1}, 1)), 0);  // it touches the horizon from below
}

TEST(FormFactor, NoTurnOrMoveChangesIt) {
  const std::array<Shape, 5> lights = {rectangle({0.4, -0.7, 1.5}, {1, 0.2, 0.3}, {-0.06, 0.6, -0.2}),
                                       rectangle({1, 0.5, 0.3}, {0, 2, 0}, {0.4, 0, 0.9}),
                                       disk({0.4, -0.7, 1.5}, {1, 0.2, 0.3}, {-0.06, 0.6, -0.2}), sphere({1, 2, 3}, 1),
                                       sphere({1, 2, 0.3}, 1)};
  const Vec3 move(3, -1, 2);
  for (const auto& light : lights) {
    const double at_home = *factor(light);
    for (int i = 1; i <= 6; ++i) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(1.1 * i, Vec3(0.3 * i, 1, 0.7 - 0.2 * i).normalized()).toRotationMatrix();
      Shape moved = light;
      if (auto* round = std::get_if<Sphere>(&moved)) {
        round->center = turn * round->center + move;
      } else {
        auto& flat = std::get<Flat>(moved);
        flat.center = turn * flat.center + move, flat.half_u = turn * flat.half_u, flat.half_v = turn * flat.half_v;
        flat.normal = turn * flat.normal;
      }
      close(factor(moved, move, turn * kUp), at_home, 2e-14);
    }
  }
}

TEST(FormFactor, AnyUnitOfLengthWillDo) {
  for (const double unit : {1e-100, 1e-30, 1e30, 1e100}) {
    const Vec3 c = unit * Vec3(0.4, -0.7, 1.5), u = unit * Vec3(1, 0.2, 0.3), v = unit * Vec3(-0.06, 0.6, -0.2);
    close(factor(rectangle(c, u, v)), *factor(rectangle({0.4, -0.7, 1.5}, {1, 0.2, 0.3}, {-0.06, 0.6, -0.2})), 1e-14);
    close(factor(disk(c, u, v)), *factor(disk({0.4, -0.7, 1.5}, {1, 0.2, 0.3}, {-0.06, 0.6, -0.2})), 1e-14);
    close(factor(sphere(c, unit)), *factor(sphere({0.4, -0.7, 1.5}, 1)), 1e-14);
    const std::array<Vec3, 3> triangle = {c, c + u, c + v};
    const std::array<Vec3, 3> one = {Vec3(c / unit), Vec3((c + u) / unit), Vec3((c + v) / unit)};
    close(polygon_form_factor(triangle), polygon_form_factor(one), 1e-14);
  }
}

}  // namespace
}  // namespace halfslope
