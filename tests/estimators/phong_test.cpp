// Light reflected by the Phong lobe, against figures computed outside this project.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/estimators/expect_radiance.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

/// One light over one plate of the classic scene: the radiance that a Phong lobe with k_s = 1 sends from p to the eye
/// at (0, 2, 15), nothing in between. By exact integration over the azimuth and one-dimensional Gauss quadrature.
struct PlatePoint {
  int plate, light;
  std::array<double, 3> p;
  double radiance;
};

constexpr PlatePoint kPlatePoints[] = {
    {2, 3, {2.0625, -3.0634050000000004, 0.9231280000000001}, 5.30436346004878e-06},
    {4, 0, {-2.0625, -3.90842, 3.574455}, 0.3123245780079836},
    {1, 0, {-3.254605606388175, -2.395128859541096, -0.13511793283106321}, 435.3058855534553},
    {2, 3, {3.089297929286643, -3.0633820920499355, 0.9230824997343312}, 0.8771246296660139},
    {3, 0, {-2.8793473611055904, -3.5823848389590722, 2.2230976766098074}, 8.63283138677955},
    {2, 2, {0.6875, -3.0634050000000004, 0.9231280000000001}, 0.3605125973252894},
    {1, 2, {1.084868535462725, -2.395128859541096, -0.13511793283106321}, 9.047994536959758},
    {2, 2, {1.029765976428881, -3.0633820920499355, 0.9230824997343312}, 8.040419806349496},
    {4, 0, {-2.6562485097563435, -3.908421971498763, 3.574466061899109}, 1.0392393921343361},
    {3, 1, {-0.6875, -3.58237, 2.22305}, 1.6582489705307921},
    {2, 0, {-3.089297929286643, -3.0633820920499355, 0.9230824997343312}, 63.397526177238596},
    {2, 1, {-1.029765976428881, -3.0633820920499355, 0.9230824997343312}, 45.04129939736766},
    {1, 3, {2.0625, -2.39513, -0.1351165}, 2.6938608014895435e-66},
    {4, 1, {-0.8854161699187812, -3.908421971498763, 3.574466061899109}, 1.0879872062084885},
    {4, 1, {-0.6875, -3.90842, 3.574455}, 0.9403602385837407},
    {1, 0, {-2.0625, -2.39513, -0.1351165}, 0.0},
};

Scene plate_under_light(const PlatePoint& c) {
  struct Light {
    double x, radius, radiance;
  };
  constexpr Light kLights[] = {
      {-3.75, 0.03333, 901.803}, {-1.25, 0.1, 100}, {1.25, 0.3, 11.1111}, {3.75, 0.9, 1.23457}};
  struct Plate {
    std::array<double, 3> normal;
    double exponent;
  };
  constexpr Plate kPlates[] = {{{0, 0.7824129529891104, 0.6227599625817802}, 10000},
                               {{0, 0.8931845564738021, 0.44969028016702495}, 2000},
                               {{0, 0.9548213440074698, 0.2971804183114512}, 500},
                               {{0, 0.9844866666814627, 0.17545940592177636}, 100}};
  const Light& light = kLights[c.light];
  const Plate& plate = kPlates[c.plate - 1];
  const Vec3 p(c.p.data()), n = Vec3(plate.normal.data()).normalized(), u = n.cross(Vec3::UnitX()).normalized();
  return scene_of({made_of(rectangle(p, u, n.cross(u)), phong(grey(0), grey(1), plate.exponent)),
                   emitting(sphere({light.x, 0, 0}, light.radius), grey(light.radiance))},
                  {looking({0, 2, 15}, p)});
}

/// The mean of 64 replicates within t⁻¹(1 − 5e-7) standard errors of `exact`: with as many rounds as put these within
/// `closeness` of it.
void expect_converged(const Scene& scene, double exact, double closeness, const std::string& what) {
  const DirectLighting source = lighting(scene);
  for (std::uint64_t rounds = 2048;; rounds *= 2) {
    ASSERT_LE(rounds, 1u << 20) << what << " does not converge";
    const Request request = {.estimator = "balance", .sampler = "halton-owen", .rounds = rounds, .seed = 3};
    const auto values = estimate<double>(source, 0, request)[0];
    if (kStudent64 * mean_of(values).standard_error > closeness * exact) continue;
    expect_mean(values, exact, 1e-9, what);
    return;
  }
}

/// Far out in a lobe's tail what a light sends is decided by a speck of it, which random points seldom meet.
bool in_the_tail(const PlatePoint& c) { return c.radiance < 1e-4; }

void expect_plates(double closeness) {
  for (const PlatePoint& c : kPlatePoints) {
    if (in_the_tail(c)) continue;
    expect_converged(plate_under_light(c), c.radiance, closeness,
                     "plate " + std::to_string(c.plate) + " light " + std::to_string(c.light));
  }
}
TEST(PhongLight, PlatesOfTheClassicScene) { expect_plates(1e-3); }
TEST(LongPhongLight, PlatesOfTheClassicScene) { expect_plates(1e-4); }

/// A part of the unit square.
struct Box {
  double lo[2] = {0, 0}, hi[2] = {1, 1};
};
struct Midpoints {
  double integral = 0;
  Box speck;  ///< where all but 1e-12 of the largest value is
};

/// The midpoint rule over a box of the two numbers that technique `light` makes a point of, where there is one light.
Midpoints integrate_light(const DirectLighting& source, const Box& box, int side) {
  const PixelIntegral pixel = source.pixel(0);
  const int samples = side / kLanes;
  const double step[2] = {(box.hi[0] - box.lo[0]) / side, (box.hi[1] - box.lo[1]) / side};
  std::vector<double> rows(static_cast<std::size_t>(side)), columns(rows.size());  // largest values
  PointBlock points;
  points.reset(2, samples, true);
  const auto set_coordinate = [&](int dim, std::size_t i, double u) {
    const double scaled = u * 0x1p32;
    points.high(dim)[i] = static_cast<std::uint32_t>(scaled);
    points.low(dim)[i] = static_cast<std::uint32_t>((scaled - std::floor(scaled)) * 0x1p21);
  };
  TermBlock<double> terms;
  terms.reset(1, 1, 1, samples);
  const std::vector<int> light = {0};
  Midpoints result;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      set_coordinate(0, i, box.lo[0] + (static_cast<double>(row) + 0.5) * step[0]);
      set_coordinate(1, i, box.lo[1] + (static_cast<double>(i) + 0.5) * step[1]);
    }
    pixel.integral->sample({0, 0, 0, light}, points, terms);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double value = terms.value(0, 0)[i];
      result.integral += value * step[0] * step[1];
      rows[row] = std::max(rows[row], value);
      columns[i] = std::max(columns[i], value);
    }
  }
  const double least = 1e-12 * *std::max_element(rows.begin(), rows.end());
  for (int dim = 0; dim < 2; ++dim) {
    const std::vector<double>& largest = dim == 0 ? rows : columns;
    double first = side, last = 0;
    for (std::size_t i = 0; i < largest.size(); ++i) {
      if (largest[i] <= least) continue;
      first = std::min(first, static_cast<double>(i));
      last = static_cast<double>(i);
    }
    result.speck.lo[dim] = std::max(box.lo[dim], box.lo[dim] + (first - 1) * step[dim]);
    result.speck.hi[dim] = std::min(box.hi[dim], box.lo[dim] + (last + 2) * step[dim]);
  }
  return result;
}

TEST(PhongLight, PlatesOfTheClassicSceneTailsAndAll) {
  for (const PlatePoint& c : kPlatePoints) {
    const DirectLighting source = lighting(plate_under_light(c));
    Box box;
    for (int zoom = 0; zoom < 4 && c.radiance > 0; ++zoom) box = integrate_light(source, box, 512).speck;
    const double found = integrate_light(source, box, 1024).integral;
    EXPECT_NEAR(found, c.radiance, 1e-5 * c.radiance) << "plate " << c.plate << " light " << c.light;
  }
}

TEST(PhongLight, PlatesOfTheClassicSceneInBinary32) {
  for (const PlatePoint& c : kPlatePoints) {
    const Request request = {.estimator = "power", .sampler = "halton-owen", .rounds = 4096, .seed = 3};
    const auto values = estimate<float>(lighting(plate_under_light(c)), 0, request)[0];
    if (c.radiance < 1e-30) {  // below what binary32 holds
      for (const double value : values) EXPECT_LT(value, 1e-30);
      continue;
    }
    // |ω_i − R| is known to 1e-7 beside a lobe whose width is √(1/n), and far out in its tail that counts √n times
    // more.
    expect_mean(values, c.radiance, c.radiance < 1e-3 ? 1e-3 : 1e-4, "plate " + std::to_string(c.plate) + " f32");
  }
}

/// Axial moments τ_m = ∫ (w·ω)^m dω of parallelograms (J. Arvo, "Applications of irradiance tensors", 1995). With the
/// receiver's normal and the eye along w, cos θ is cos α, and a lobe of exponent m − 1 reflects (m + 1)/(2π) τ_m.
struct Moment {
  int shape, m;
  double value;
};
struct Parallelogram {
  Vec3 corner, u, v, axis;
};

/// The light of a parallelogram: the rectangle around it, where masks halfway to the receiver at the origin hide what
/// is beyond each of its edges.
std::vector<Primitive> masked(const Parallelogram& p) {
  const Vec3 along = p.u.normalized(), across = p.v - p.v.dot(along) * along, normal = along.cross(across).normalized();
  const Vec3 center = p.corner + 0.5 * (p.u + p.v);
  const double half = 0.5 * (p.u.norm() + std::abs(p.v.dot(along)));
  const double facing = normal.dot(center) < 0 ? 1 : -1;
  std::vector<Primitive> all = {emitting(rectangle(center, half * along, facing * 0.5 * across), grey(1))};
  if (std::abs(p.u.dot(p.v)) < 1e-12) return all;
  for (const auto& [edge, other] : {std::pair(p.u, p.v), std::pair(p.v, p.u)}) {
    const Vec3 outward = (other - other.dot(edge) / edge.squaredNorm() * edge).normalized();
    for (const double side : {-1.0, 1.0}) {
      const Vec3 middle = center + side * 0.5 * other;
      all.push_back(rectangle(0.5 * middle + side * 0.7 * outward, 1.5 * edge, 0.7 * outward));
    }
  }
  return all;
}

void expect_axial_moments(double closeness) {
  const Parallelogram shapes[] = {
      {{-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
      {{-0.4, 0.6, 0.2},
       {1, 0.3, -0.1},
       {-0.1, 0.1, 0.9},
       {0.10540925533894598, 0.8432740427115678, 0.5270462766947298}},
      {{0.2, 1, -0.3}, {1.2, 0, 0}, {0, 0, 0.8}, {0.3144854510165755, 0.9434563530497265, 0.10482848367219183}}};
  for (const Moment& c :
       {Moment{0, 5, 0.5830953482067637}, Moment{0, 10, 0.44067944053758}, Moment{0, 50, 0.1230060214922267},
        Moment{1, 5, 0.45789572566751086}, Moment{1, 10, 0.356204434076473}, Moment{1, 200, 0.03125871675295675},
        Moment{2, 10, 0.2707002905573522}, Moment{2, 50, 0.09863430012906975}, Moment{2, 200, 0.03001633561519668}}) {
    const Parallelogram& shape = shapes[c.shape];
    const Vec3 u = 0.1 * shape.axis.unitOrthogonal(), v = shape.axis.cross(u);
    std::vector<Primitive> primitives = masked(shape);
    primitives.push_back(made_of(rectangle(Vec3::Zero(), u, v), phong(grey(0), grey(1), c.m - 1)));
    const Scene scene = scene_of(primitives, {looking(0.05 * shape.axis, Vec3::Zero())});
    const double radiance = (c.m + 1) / (2 * kPi) * c.value;
    expect_converged(scene, radiance, closeness, "shape " + std::to_string(c.shape) + " moment " + std::to_string(c.m));
  }
}

TEST(PhongLight, AxialMoments) { expect_axial_moments(1e-3); }
TEST(LongPhongLight, AxialMoments) { expect_axial_moments(1e-4); }

/// ∫ over the upper hemisphere of cosⁿα · g(θ), α from the direction R at angle `theta_r` from the normal, by
/// midpoints.
template <class G>
double lobe_integral(double n, double theta_r, const G& g) {
  constexpr int kHeights = 2000, kAzimuths = 1000;
  double sum = 0;
  for (int i = 0; i < kHeights; ++i) {
    const double z = (i + 0.5) / kHeights, ring = std::sqrt(1 - z * z);
    for (int j = 0; j < kAzimuths; ++j) {
      const double phi = kPi * (j + 0.5) / kAzimuths;
      const double cosine = z * std::cos(theta_r) + ring * std::sin(theta_r) * std::cos(phi);
      if (cosine > 0) sum += std::pow(cosine, n) * g(z);
    }
  }
  return sum * 2 * kPi / (kHeights * kAzimuths);
}

TEST(PhongLight, UnderADomeReflectsItsAlbedo) {
  // k_d + k_s (n + 2)/(2π) ∫ cosⁿα cos θ dω, by quadrature; along the normal that integral is 2π/(n + 2).
  const Primitive dome = emitting(sphere({0.4, 0.2, 0.1}, 2, true), Rgb(2, 1, 3));
  const Rgb k_d(0.3, 0.1, 0), k_s(0.2, 0, 0.6);
  for (const double n : {0.0, 1.0, 7.5, 60.0}) {
    for (const double degrees : {0.0, 40.0, 85.0}) {
      const double theta = degrees * kPi / 180;
      const double lobe = (n + 2) / (2 * kPi) * lobe_integral(n, theta, [](double z) { return z; });
      ASSERT_NEAR(lobe, 1, degrees == 0 ? 1e-4 : 1);
      Scene scene = floor_under({dome}, phong(k_d, k_s, n));
      scene.sensor.rays = {
          looking(0.01 * Vec3(0.6 * std::sin(theta), 0.8 * std::sin(theta), std::cos(theta)), Vec3::Zero())};
      const Rgb exact = dome.radiance * (k_d + k_s * lobe);
      expect_radiance(lighting(scene), 0, exact, "n = " + std::to_string(n) + " at " + std::to_string(degrees), 512,
                      2e-5, 2e-5);  // of the quadrature
    }
  }
}

TEST(PhongLight, EveryTechniqueAgreesUnderSeveralLightsInColour) {
  const Primitive square = ceiling_light(2, 1, 1, Rgb(1, 2, 3)),
                  ball = emitting(sphere({-1, -0.8, 1.5}, 0.5), Rgb(4, 0, 1)),
                  plate = emitting(disk({-1, 1, 1.2}, 0.5 * Vec3::UnitY(), 0.3 * Vec3::UnitX()), Rgb(0, 3, 1)),
                  screen = sphere({0.5, 0.2, 0.6}, 0.15);
  for (const double exponent : {0.0, 3.0, 40.0}) {
    Scene scene = floor_under({square, ball, plate, screen}, phong(Rgb(0.1, 0.3, 0), Rgb(0.5, 0, 0.4), exponent));
    scene.sensor.rays = {looking({0.02, 0.015, 0.02}, Vec3::Zero())};
    const DirectLighting source = lighting(scene);
    // The yardstick: one pass, from other numbers. Its own error is small beside any of the others'.
    const Request request = {.estimator = "power", .sampler = "halton-owen", .rounds = 65536, .seed = 99};
    const auto values = estimate<double>(source, 0, request);
    Rgb yardstick;
    double slack = 0;
    for (int c = 0; c < 3; ++c) {
      const MeanAndError found = mean_of(values[static_cast<std::size_t>(c)]);
      yardstick[c] = found.mean;
      slack = std::max(slack, kStudent64 * found.standard_error / found.mean);
    }
    EXPECT_LT(slack, 1e-3);
    expect_radiance(source, 0, yardstick, "exponent " + std::to_string(exponent), 2048, slack, slack + 4e-6);
  }
}

}  // namespace
}  // namespace halfslope
