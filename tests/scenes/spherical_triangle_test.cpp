// Triangles drawn by solid angle: the stated density by chi-squared, the map itself against long double, the mean of a
// cosine against Lambert's formula, and what packets and degenerate triangles do.
#include "scenes/spherical_triangle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/closed_form.h"
#include "tests/scenes/chi_squared.h"

namespace halfslope {
namespace {

using Corners = std::array<Vec<double>, 3>;
struct Case {
  std::string name;
  Corners corners;
};

/// Sizes from 1e-17 sr to almost a hemisphere; grazing, thin, around and beside the foot of the perpendicular.
const std::vector<Case>& triangles() {
  static const std::vector<Case> kCases = {
      {"an octant", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
      {"a sixteenth", {{{0, 0, 1}, {0.0625, 0, 1}, {0, 0.0625, 1}}}},
      {"4.5e-13 sr", {{{0, 0, 1}, {0x1p-20, 0, 1}, {0, 0x1p-20, 1}}}},
      {"2.8e-17 sr", {{{0, 0, 1}, {0x1p-27, 0, 1}, {0, 0x1p-27, 1}}}},
      {"grazing and far", {{{1000, 0, 1}, {1001, 0, 1}, {1000, 1, 1}}}},
      {"almost a hemisphere", {{{1000000, 0, 1}, {-500000, 866025.375, 1}, {-500000, -866025.375, 1}}}},
      {"wide", {{{100, 0, 1}, {-50, 86, 1}, {-50, -87, 1}}}},
      {"wide, clockwise", {{{-50, -87, 1}, {-50, 86, 1}, {100, 0, 1}}}},
      {"beside an edge", {{{-1, 0x1p-10, 0x1p-10}, {1, 0x1p-10, 0x1p-10}, {0, 1, 0x1p-10}}}},
      {"beside a corner", {{{0.0625, 0.0625, 0.0625}, {1, 0, 0.0625}, {0, 1, 0.0625}}}},
      {"a sliver", {{{0, 0, 1}, {1, 0, 1}, {0.5, 0x1p-13, 1}}}},
      {"askew", {{{1, 2, 0.25}, {3, 1, 0.125}, {2, 5, 0.5}}}},
      {"small and far", {{{1e10, 1e10, 1e10}, {10000002048.0, 1e10, 1e10}, {1e10, 10000002048.0, 1e10}}}},
  };
  return kCases;
}

template <class T>
Vec<T> as(const Vec<double>& v) {
  return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

/// From here on in double, with the corners as T has them.
template <class T>
Corners rounded(const Corners& corners) {
  Corners out;
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = as<double>(Vec<double>{static_cast<double>(static_cast<T>(corners[i].x)),
                                    static_cast<double>(static_cast<T>(corners[i].y)),
                                    static_cast<double>(static_cast<T>(corners[i].z))});
  return out;
}

template <class T>
TrianglePoint<T> draw(const Corners& c, T u1, T u2) {
  const Vec<T> corner = as<T>(c[0]);
  return sample_triangle_solid_angle(corner, as<T>(c[1] - c[0]), as<T>(c[2] - c[0]), u1, u2);
}

double solid_angle(const Vec<double>& a, const Vec<double>& b, const Vec<double>& c) {
  return triangle_solid_angle(a, b - a, c - a);
}

/// Barycentric coordinates of the ray to `position`, which for wide triangles has digits that weights cannot have.
std::array<double, 3> weights(const Corners& c, const Vec<double>& position) {
  const double w0 = dot(position, cross(c[1], c[2])), w1 = dot(position, cross(c[2], c[0])),
               w2 = dot(position, cross(c[0], c[1])), sum = w0 + w1 + w2;
  return {w0 / sum, w1 / sum, w2 / sum};
}

template <class T>
class SphericalTriangle : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(SphericalTriangle, Numbers);

Vec<double> position_of(const auto& point) {
  return {double{point.position.x}, double{point.position.y}, double{point.position.z}};
}

bool is_wide(const Corners& c) { return length(c[1] - c[0]) > length(c[0]); }

/// 8 × 8 pieces of equal area, by barycentric coordinates.
struct EqualPieces {
  static constexpr int kCuts = 8;
  const Corners& c;

  Vec<double> at(int i, int j) const {
    return c[0] + (static_cast<double>(i) / kCuts) * (c[1] - c[0]) + (static_cast<double>(j) / kCuts) * (c[2] - c[0]);
  }
  static std::size_t bin(int i, int j, bool upper) {
    return static_cast<std::size_t>(2 * (i * kCuts + j) + (upper ? 1 : 0));
  }
  std::vector<double> solid_angles() const {
    std::vector<double> out(2 * kCuts * kCuts);
    for (int i = 0; i < kCuts; ++i) {
      for (int j = 0; i + j < kCuts; ++j) {
        out[bin(i, j, false)] = solid_angle(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < kCuts) out[bin(i, j, true)] = solid_angle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
    return out;
  }
  std::size_t operator()(const auto& p) const {
    const double x = double{p.b1} * kCuts, y = double{p.b2} * kCuts;
    const int i = std::clamp(static_cast<int>(x), 0, kCuts - 1), j = std::clamp(static_cast<int>(y), 0, kCuts - 1 - i);
    return bin(i, j, i + j + 1 < kCuts && (x - i) + (y - j) > 1);
  }
};

/// Of a wide triangle around the foot (0, 0, z) of the perpendicular: sectors of the foot and pieces of the edges, cut
/// at polar angles that the triangle reaches everywhere.
struct SectorsOfFoot {
  static constexpr std::size_t kPieces = 8, kRings = 4;
  const Corners& c;

  double height() const { return c[0].z; }
  Vec<double> rim(std::size_t k) const {
    const std::size_t side = (k / kPieces) % 3;
    return c[side] + (static_cast<double>(k % kPieces) / kPieces) * (c[(side + 1) % 3] - c[side]);
  }
  /// The share of the way from the foot to the rim where ring r begins.
  double ring(std::size_t r, const Vec<double>& rim) const {
    constexpr std::array<double, kRings + 1> kTangents = {0, 0.5, 1, 3, 0};
    return r == kRings ? 1 : std::min(1.0, kTangents[r] * height() / std::hypot(rim.x, rim.y));
  }
  std::vector<double> solid_angles() const {
    std::vector<double> out;
    const Vec<double> foot = {0, 0, height()};
    for (std::size_t k = 0; k < 3 * kPieces; ++k) {
      const Vec<double> a = rim(k), b = rim(k + 1);
      double inner = 0;
      for (std::size_t r = 1; r <= kRings; ++r) {
        // Rings are straight between their ends, so that a piece is a difference of triangles.
        const double outer = solid_angle(foot, foot + ring(r, a) * (a - foot), foot + ring(r, b) * (b - foot));
        out.push_back(outer - inner);
        inner = outer;
      }
    }
    return out;
  }
  std::size_t operator()(const auto& p) const {
    const Vec<double> position = position_of(p);
    const double x = position.x * (height() / position.z), y = position.y * (height() / position.z);
    for (std::size_t k = 0; k < 3 * kPieces; ++k) {
      const Vec<double> a = rim(k), b = rim(k + 1);
      const double turn = a.x * b.y - a.y * b.x, along_a = (x * b.y - y * b.x) / turn,
                   along_b = (a.x * y - a.y * x) / turn;
      if (along_a < 0 || along_b < 0) continue;
      for (std::size_t r = 1; r < kRings; ++r) {
        if (along_a / ring(r, a) + along_b / ring(r, b) <= 1) return k * kRings + r - 1;
      }
      return k * kRings + kRings - 1;
    }
    ADD_FAILURE() << "in no sector";
    return 0;
  }
};

template <class T, class Pieces>
void expect_uniform(const Case& of, const Corners& c, const Pieces& pieces) {
  std::vector<double> probabilities = pieces.solid_angles(), counts(probabilities.size());
  const double all = solid_angle(c[0], c[1], c[2]);
  for (double& p : probabilities) p /= all;
  Coordinates<T> random(7);
  for (int s = 0; s < 40000; ++s) {
    const T u1 = random(), u2 = random();
    const TrianglePoint<T> p = draw(c, u1, u2);
    ASSERT_NEAR(p.solid_angle / all, 1, 512 * std::numeric_limits<T>::epsilon()) << of.name;
    counts[pieces(p)] += 1;
  }
  expect_distribution(counts, probabilities, 1e-6 / static_cast<double>(triangles().size()), of.name);
}

TYPED_TEST(SphericalTriangle, DirectionsAreUniformInSolidAngle) {
  for (const Case& of : triangles()) {
    const Corners c = rounded<TypeParam>(of.corners);
    if (of.name.starts_with("wide") || of.name == "almost a hemisphere") {
      expect_uniform<TypeParam>(of, c, SectorsOfFoot{c});
    } else {
      expect_uniform<TypeParam>(of, c, EqualPieces{c});
    }
  }
}

TYPED_TEST(SphericalTriangle, PointsLieInTheTriangle) {
  using T = TypeParam;
  const T eps = std::numeric_limits<T>::epsilon(), last = 1 - eps / 2;
  for (const Case& of : triangles()) {
    const Corners c = rounded<T>(of.corners);
    const Vec<double> normal = cross(c[1] - c[0], c[2] - c[0]);
    for (const T u1 : {T(0), eps, T(0.25), T(0.5), T(0.75), last}) {
      for (const T u2 : {T(0), eps, T(0.25), T(0.5), T(0.75), last}) {
        const TrianglePoint<T> p = draw(c, u1, u2);
        EXPECT_GE(p.b0, 0) << of.name;
        EXPECT_GE(p.b1, 0) << of.name;
        EXPECT_GE(p.b2, 0) << of.name;
        EXPECT_NEAR(p.b0 + p.b1 + p.b2, 1, 4 * eps) << of.name;
        const Vec<double> position = position_of(p);
        const Vec<double> same = double{p.b0} * c[0] + double{p.b1} * c[1] + double{p.b2} * c[2];
        const double size = std::max({length(c[0]), length(c[1]), length(c[2])});
        EXPECT_LE(length(position - same), 16 * eps * size) << of.name << ' ' << u1 << ' ' << u2;
        // The position is on the plane to a few roundings of its own length, however wide the triangle.
        const double off = dot(normal, position - c[0]) / dot(normal, position);
        EXPECT_LE(std::fabs(off), 8 * eps * length(position) * length(normal) / std::fabs(dot(normal, position)))
            << of.name << ' ' << u1 << ' ' << u2;
      }
    }
  }
}

// The map, not only its distribution: at the point drawn, the triangle cut off by the meridian through it has a share
// u₁ of the solid angle, and the cap through it a share u₂.
TYPED_TEST(SphericalTriangle, TheMapIsArvosToAFewRoundings) {
  using T = TypeParam;
  const double eps = std::numeric_limits<T>::epsilon();
  // 1 − cos of the angle, without cancellation.
  const auto versine = [](const Vec<double>& a, const Vec<double>& b) {
    const Vec<double> difference = (1 / length(a)) * a - (1 / length(b)) * b;
    return 0.5 * dot(difference, difference);
  };
  for (const Case& of : triangles()) {
    if (of.name == "beside an edge") continue;  // there its solid angle has lost ten digits to the receiver's place
    const Corners c = rounded<T>(of.corners);
    if (sizeof(T) == 8 && (of.name == "almost a hemisphere" || length(c[1] - c[0]) < 1e-3 * length(c[0]))) continue;
    Coordinates<T> random(3);
    for (int s = 0; s < 2000; ++s) {
      const T u1 = random(), u2 = random();
      const TrianglePoint<T> p = draw(c, u1, u2);
      Vec<double> position = double{p.b0} * c[0] + double{p.b1} * c[1] + double{p.b2} * c[2];
      if (is_wide(c)) position = position_of(p);
      const std::array<double, 3> w = weights(c, position);
      if (w[0] + w[2] < 0.05) continue;  // all meridians meet in c₁
      const Vec<double> end = (w[0] / (w[0] + w[2])) * c[0] + (w[2] / (w[0] + w[2])) * c[2];
      const double conditioned = sizeof(T) == 8 ? 1e5 : 64;  // the check is in binary64 itself
      EXPECT_NEAR(solid_angle(c[0], c[1], end) / solid_angle(c[0], c[1], c[2]), u1, conditioned * eps) << of.name;
      EXPECT_NEAR(versine(c[1], position) / versine(c[1], end), u2, conditioned * eps) << of.name;
    }
  }
}

TYPED_TEST(SphericalTriangle, TheMeanCosineIsLamberts) {
  using T = TypeParam;
  for (const Case& of : triangles()) {
    const Corners c = rounded<T>(of.corners);
    const std::vector<Vec3> vertices = {{c[0].x, c[0].y, c[0].z}, {c[1].x, c[1].y, c[1].z}, {c[2].x, c[2].y, c[2].z}};
    constexpr int kSamples = 20000;
    double sum = 0, squares = 0, all = 0, first = -1;
    Coordinates<T> random(11);
    for (int s = 0; s < kSamples; ++s) {
      const T u1 = random(), u2 = random();
      const TrianglePoint<T> p = draw(c, u1, u2);
      const double cosine = std::max(0.0, double{p.position.z} / length(position_of(p)));
      if (first < 0) first = cosine;  // a small triangle's cosines differ in their last digits only
      sum += cosine - first, squares += (cosine - first) * (cosine - first), all = p.solid_angle;
    }
    const double shift = sum / kSamples, mean = first + shift;
    const double se = std::sqrt(std::max(0.0, squares / kSamples - shift * shift) / kSamples);
    const double exact = polygon_form_factor(vertices) * std::numbers::pi / all;
    EXPECT_NEAR(mean, exact, 5.5 * se + 512 * std::numeric_limits<T>::epsilon() * exact) << of.name;
  }
}

TYPED_TEST(SphericalTriangle, NeitherTurningNorUnitOfLengthMatters) {
  using T = TypeParam;
  const Vec<T> a = {T(1), T(2), T(0.5)}, e1 = {T(0.25), T(-1), T(0)}, e2 = {T(1), T(1), T(-0.125)};
  const T once = triangle_solid_angle(a, e1, e2);
  EXPECT_NEAR(triangle_solid_angle(a, e2, e1) / once, 1, 4 * std::numeric_limits<T>::epsilon());
  for (const T unit : {T(0x1p-40), T(0x1p40)}) EXPECT_EQ(triangle_solid_angle(unit * a, unit * e1, unit * e2), once);
}

TYPED_TEST(SphericalTriangle, EdgeOnOrWithoutAreaItIsSeenUnderNoAngle) {
  using T = TypeParam;
  const T zero = 0, one = 1;
  const struct {
    Vec<T> corner, edge_1, edge_2;
  } cases[] = {{{one, zero, zero}, {one, zero, zero}, {zero, one, zero}},  // the receiver in its plane, beside it
               {{-one, -one, zero}, {one + one, zero, zero}, {one, 3 * one, zero}},    // in the middle of it
               {{-one, zero, zero}, {one + one, zero, zero}, {one, one, zero}},        // on its edge
               {{-one, zero, one}, {one + one, zero, zero}, {one + one, zero, zero}},  // no area
               {{one, zero, one}, {zero, zero, zero}, {zero, one, zero}},
               {{zero, zero, zero}, {one, zero, zero}, {zero, one, zero}}};  // the receiver in its corner
  for (const auto& c : cases) {
    const TrianglePoint<T> p = sample_triangle_solid_angle(c.corner, c.edge_1, c.edge_2, T(0.3), T(0.6));
    EXPECT_EQ(p.solid_angle, 0);
    for (const T x : {p.position.x, p.position.y, p.position.z, p.b0, p.b1, p.b2}) EXPECT_TRUE(std::isfinite(x));
  }
}

// However near to the plane the receiver is, inside the triangle or out, all numbers are finite and of the triangle.
TYPED_TEST(SphericalTriangle, AtAllHeightsPointsAreOfTheTriangle) {
  using T = TypeParam;
  const T last = 1 - std::numeric_limits<T>::epsilon() / 2;
  Coordinates<T> random(13);
  for (int exponent = 0; exponent > -110; --exponent) {
    const T z = std::ldexp(T(1), exponent);
    for (int k = 0; k < 60; ++k) {
      const Vec<T> corner = {random() - T(0.8), random() - T(0.8), z};
      const Vec<T> edge_1 = {random() + T(0.5), random(), T(0)}, edge_2 = {-random(), random() + T(0.5), T(0)};
      const T u1 = k % 3 == 0 ? last : random(), u2 = k % 5 == 0 ? last : random();
      const TrianglePoint<T> p = sample_triangle_solid_angle(corner, edge_1, edge_2, u1, u2);
      EXPECT_GE(p.solid_angle, 0);
      EXPECT_LE(p.solid_angle, T(6.2831855));
      for (const T b : {p.b0, p.b1, p.b2}) {
        EXPECT_GE(b, 0) << z;
        EXPECT_LE(b, 1) << z;
      }
      for (const T x : {p.position.x, p.position.y, p.position.z}) EXPECT_LE(std::fabs(x), 4) << z << ' ' << k;
    }
  }
}

TYPED_TEST(SphericalTriangle, PacketsDrawWhatScalarsDo) {
  using T = TypeParam;
  using F = NativePacket<T>;
  constexpr auto kLanes = static_cast<std::size_t>(kWidth<F>);
  struct alignas(64) Lanes : std::array<T, kLanes> {};
  std::array<Lanes, 9> in;
  alignas(64) std::array<T, kLanes> u1, u2, x, b1;
  Coordinates<T> random(5);
  // A lane's neighbours are other triangles.
  for (std::size_t first = 0; first < triangles().size(); ++first) {
    std::array<std::array<Vec<T>, 3>, kLanes> of_lane;
    for (std::size_t l = 0; l < kLanes; ++l) {
      const Corners& c = triangles()[(first + l) % triangles().size()].corners;
      of_lane[l] = {as<T>(c[0]), as<T>(c[1]) - as<T>(c[0]), as<T>(c[2]) - as<T>(c[0])};
      for (std::size_t k = 0; k < 3; ++k) {
        in[3 * k][l] = of_lane[l][k].x, in[3 * k + 1][l] = of_lane[l][k].y, in[3 * k + 2][l] = of_lane[l][k].z;
      }
      u1[l] = random(), u2[l] = random();
    }
    const auto packet = [&](std::size_t k) {
      return Vec<F>{load<F>(in[3 * k].data()), load<F>(in[3 * k + 1].data()), load<F>(in[3 * k + 2].data())};
    };
    const TrianglePoint<F> p =
        sample_triangle_solid_angle(packet(0), packet(1), packet(2), load<F>(u1.data()), load<F>(u2.data()));
    store(x.data(), p.position.x), store(b1.data(), p.b1);
    for (std::size_t l = 0; l < kLanes; ++l) {
      const TrianglePoint<T> alone =
          sample_triangle_solid_angle(of_lane[l][0], of_lane[l][1], of_lane[l][2], u1[l], u2[l]);
      EXPECT_EQ(x[l], alone.position.x) << triangles()[(first + l) % triangles().size()].name;
      EXPECT_EQ(b1[l], alone.b1) << triangles()[(first + l) % triangles().size()].name;
    }
  }
}

}  // namespace
}  // namespace halfslope
