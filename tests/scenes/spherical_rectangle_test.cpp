// Rectangles drawn by solid angle: the stated density by chi-squared, the map itself by what it cuts off, the mean of a
// cosine against Lambert's formula, and what packets and rectangles seen edge-on do.
#include "scenes/spherical_rectangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/closed_form.h"
#include "tests/scenes/chi_squared.h"

namespace halfslope {
namespace {

/// [x0, x1] × [y0, y1] at height z; all numbers have few binary digits.
struct Case {
  std::string name;
  double x0, x1, y0, y1, z;
};

/// From 4e-14 sr to a hemisphere; the foot of the perpendicular inside, beside sides, beside corners, and far away.
const std::vector<Case>& rectangles() {
  static const std::vector<Case> kCases = {
      {"a cube's face", -1, 1, -1, 1, 1},
      {"small and near", 1, 1 + 0x1p-20, 2, 2 + 0x1p-20, 0.5},
      {"small and far", 4096, 4096.5, 1, 1.5, 4096},
      {"below its foot", -0x1p-10, 0x1p-10, -0x1p-10, 0x1p-10, 1},
      {"grazing", 1, 2, 1, 2, 0x1p-17},
      {"grazing and far", 1000, 1001, -1, 1, 1},
      {"almost a hemisphere", -100, 100, -100, 100, 0x1p-7},
      {"wider still", -8192, 8192, -8192, 8192, 1},
      {"beside a corner", 1, 2, 3, 5, 0.5},
      {"beside the other corner", -2, -1, -5, -3, 0.5},
      {"beside a side", 1, 2, -3, 1, 0.25},
      {"beside the other side", -1, 2, 3, 4, 0.25},
      {"near a side", 0x1p-10, 1, -1, 1, 0x1p-10},
      {"near a corner", 0x1p-10, 1, 0x1p-10, 1, 0x1p-10},
      {"over a corner", -0x1p-10, 1, -0x1p-10, 1, 0x1p-10},
      {"a strip", -100, 100, 1, 1 + 0x1p-10, 1},
      {"a strip the other way", 1, 1 + 0x1p-10, -100, 100, 0x1p-7},
      {"a grazing strip", -100, 100, 1, 1 + 0x1p-10, 0x1p-7},
  };
  return kCases;
}

double solid_angle(double x0, double x1, double y0, double y1, double z) {
  return rectangle_solid_angle<double>({x0, y0, z}, {x1 - x0, 0, 0}, {0, y1 - y0, 0});
}
double solid_angle(const Case& c) { return solid_angle(c.x0, c.x1, c.y0, c.y1, c.z); }

template <class T>
RectanglePoint<T> draw(const Case& c, T u1, T u2) {
  const auto t = [](double x) { return static_cast<T>(x); };
  return sample_rectangle_solid_angle<T>({t(c.x0), t(c.y0), t(c.z)}, {t(c.x1 - c.x0), T(0), T(0)},
                                         {T(0), t(c.y1 - c.y0), T(0)}, u1, u2);
}

/// x and y of the point drawn: by its direction, or by its shares where their roundings are the smaller.
template <class T>
std::array<double, 2> place(const Case& c, const RectanglePoint<T>& p) {
  const double by_ray = c.z / double{p.position.z}, x = double{p.position.x} * by_ray,
               y = double{p.position.y} * by_ray;
  const double width = c.x1 - c.x0, height = c.y1 - c.y0;
  return {std::fabs(x) < width ? x : c.x0 + double{p.a} * width,
          std::fabs(y) < height ? y : c.y0 + double{p.b} * height};
}

template <class T>
class SphericalRectangle : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(SphericalRectangle, Numbers);

/// Where to cut [low, high] for bins: evenly, or where it is wide around 0 beside the height also there.
std::vector<double> cuts(double low, double high, double height) {
  std::vector<double> out;
  for (int k = 0; k <= 6; ++k) out.push_back(k == 6 ? high : low + k * (high - low) / 6);
  for (const double t : {-3.0, -1.0, -0.5, 0.0, 0.5, 1.0, 3.0}) {
    if (t * height > low && t * height < high) out.push_back(t * height);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

TYPED_TEST(SphericalRectangle, DirectionsAreUniformInSolidAngle) {
  using T = TypeParam;
  for (const Case& c : rectangles()) {
    const std::vector<double> xs = cuts(c.x0, c.x1, c.z), ys = cuts(c.y0, c.y1, c.z);
    const double all = solid_angle(c);
    std::vector<double> probabilities;
    for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
      for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
        probabilities.push_back(solid_angle(xs[i], xs[i + 1], ys[j], ys[j + 1], c.z) / all);
      }
    }
    std::vector<double> counts(probabilities.size());
    const auto bin = [](const std::vector<double>& edges, double x) {
      const auto above = std::upper_bound(edges.begin(), edges.end(), x) - edges.begin();
      return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(edges) - 2));
    };
    Coordinates<T> random(17);
    for (int s = 0; s < 20000; ++s) {
      const T u1 = random(), u2 = random();
      const RectanglePoint<T> p = draw(c, u1, u2);
      ASSERT_NEAR(p.solid_angle / all, 1, 8 * std::numeric_limits<T>::epsilon()) << c.name;
      const auto [x, y] = place(c, p);
      counts[bin(xs, x) * (ys.size() - 1) + bin(ys, y)] += 1;
    }
    expect_distribution(counts, probabilities, 1e-6 / static_cast<double>(rectangles().size()), c.name);
  }
}

// Ureña's map, not only its distribution: left of the point drawn lies a share u₁ of the solid angle, and of the arc
// through it a share u₂ is below, to a few roundings. (The check itself is in binary64.)
TYPED_TEST(SphericalRectangle, TheMapIsUrenasToAFewRoundings) {
  using T = TypeParam;
  const double eps = std::numeric_limits<T>::epsilon();
  for (const Case& c : rectangles()) {
    const double all = solid_angle(c);
    // The check's own coordinates have roundings beside a small far rectangle or one that is close.
    const double reach = std::max({std::fabs(c.x0), std::fabs(c.x1), std::fabs(c.y0), std::fabs(c.y1), c.z});
    const double coarse = sizeof(T) == 8 ? reach / std::min({c.x1 - c.x0, c.y1 - c.y0, c.z}) : 0;
    const double tolerance = (16 + coarse) * eps;
    Coordinates<T> random(23);
    for (int s = 0; s < 2000; ++s) {
      const T u1 = random(), u2 = random();
      const auto [x, y] = place(c, draw(c, u1, u2));
      EXPECT_NEAR(solid_angle(c.x0, x, c.y0, c.y1, c.z) / all, u1, tolerance) << c.name << ' ' << u1 << ' ' << u2;
      const double d2 = x * x + c.z * c.z;
      const auto below = [&](double y1) {  // sin of the latitude at y1 less that at y0, multiplied out
        const double r0 = std::sqrt(d2 + c.y0 * c.y0), r1 = std::sqrt(d2 + y1 * y1);
        if (c.y0 * y1 <= 0) return y1 / r1 - c.y0 / r0;
        return d2 * (y1 - c.y0) * (y1 + c.y0) / ((y1 * r0 + c.y0 * r1) * r0 * r1);
      };
      EXPECT_NEAR(below(y) / below(c.y1), u2, tolerance) << c.name << ' ' << u1 << ' ' << u2;
    }
  }
}

TYPED_TEST(SphericalRectangle, PointsLieInTheRectangle) {
  using T = TypeParam;
  const T eps = std::numeric_limits<T>::epsilon(), last = 1 - eps / 2;
  for (const Case& c : rectangles()) {
    for (const T u1 : {T(0), eps, T(0.25), T(0.5), T(0.75), last}) {
      for (const T u2 : {T(0), eps, T(0.25), T(0.5), T(0.75), last}) {
        const RectanglePoint<T> p = draw(c, u1, u2);
        EXPECT_GE(p.a, 0) << c.name;
        EXPECT_LE(p.a, 1) << c.name;
        EXPECT_GE(p.b, 0) << c.name;
        EXPECT_LE(p.b, 1) << c.name;
        const double reach =
            std::hypot(std::max(std::fabs(c.x0), std::fabs(c.x1)), std::max(std::fabs(c.y0), std::fabs(c.y1)), c.z);
        EXPECT_NEAR(p.position.x, c.x0 + double{p.a} * (c.x1 - c.x0), 8 * eps * reach) << c.name;
        EXPECT_NEAR(p.position.y, c.y0 + double{p.b} * (c.y1 - c.y0), 8 * eps * reach) << c.name;
        EXPECT_NEAR(p.position.z, c.z, 4 * eps * c.z) << c.name;
      }
    }
  }
}

TYPED_TEST(SphericalRectangle, TheMeanCosineIsLamberts) {
  using T = TypeParam;
  for (const Case& c : rectangles()) {
    const std::vector<Vec3> vertices = {{c.x0, c.y0, c.z}, {c.x1, c.y0, c.z}, {c.x1, c.y1, c.z}, {c.x0, c.y1, c.z}};
    // A receiver that the rectangle faces, and one that it is upright before.
    for (const bool upright : {false, true}) {
      std::vector<Vec3> seen = vertices;
      if (upright) {
        for (Vec3& v : seen) v = Vec3(v.y(), v.z(), v.x());
      }
      constexpr int kSamples = 8000;
      double sum = 0, squares = 0, all = 0, first = -1;
      Coordinates<T> random(29);
      for (int s = 0; s < kSamples; ++s) {
        const T u1 = random(), u2 = random();
        const RectanglePoint<T> p = draw(c, u1, u2);
        const Vec<double> position = {double{p.position.x}, double{p.position.y}, double{p.position.z}};
        const double cosine = std::max(0.0, (upright ? position.x : position.z) / length(position));
        if (first < 0) first = cosine;  // a small rectangle's cosines differ in their last digits only
        sum += cosine - first, squares += (cosine - first) * (cosine - first), all = p.solid_angle;
      }
      const double shift = sum / kSamples, mean = first + shift;
      const double se = std::sqrt(std::max(0.0, squares / kSamples - shift * shift) / kSamples);
      const double exact = polygon_form_factor(seen) * std::numbers::pi / all;
      EXPECT_NEAR(mean, exact, 5.5 * se + 16 * std::numeric_limits<T>::epsilon() * exact) << c.name << ' ' << upright;
    }
  }
}

TYPED_TEST(SphericalRectangle, TurnsAndUnitsOfLengthDoNotMatter) {
  using T = TypeParam;
  const T eps = std::numeric_limits<T>::epsilon();
  const Vec<T> c = {T(1), T(2), T(0.5)}, e1 = {T(3), T(4), T(0)}, e2 = {T(-0.8), T(0.6), T(0)};
  const T once = rectangle_solid_angle(c, e1, e2);
  // The same in its own axes: x from (1, 2)·(3, 4)/5 = 2.2 on, y from (1, 2)·(−0.8, 0.6) = 0.4 on.
  EXPECT_NEAR(once / solid_angle(2.2, 7.2, 0.4, 1.4, 0.5), 1, 16 * eps);
  EXPECT_NEAR(rectangle_solid_angle(c, e2, e1) / once, 1, 4 * eps);
  EXPECT_NEAR(rectangle_solid_angle(c + e1, -e1, e2) / once, 1, 16 * eps);
  for (const T unit : {T(0x1p-40), T(0x1p40)}) EXPECT_EQ(rectangle_solid_angle(unit * c, unit * e1, unit * e2), once);
  const RectanglePoint<T> p = sample_rectangle_solid_angle(c, e1, e2, T(0.3), T(0.8));
  const Vec<T> same = c + p.a * e1 + p.b * e2;
  EXPECT_NEAR(length(p.position - same), 0, 16 * eps);
}

TYPED_TEST(SphericalRectangle, EdgeOnItIsSeenUnderNoAngle) {
  using T = TypeParam;
  const T zero = 0, one = 1;
  for (const T x : {T(-0.5), T(1), T(0)}) {  // the receiver inside it, beside it, on its side
    const RectanglePoint<T> p =
        sample_rectangle_solid_angle<T>({x, T(-0.5), zero}, {one, zero, zero}, {zero, one, zero}, T(0.3), T(0.6));
    EXPECT_EQ(p.solid_angle, 0);
    for (const T number : {p.position.x, p.position.y, p.position.z, p.a, p.b}) EXPECT_TRUE(std::isfinite(number));
  }
}

// However near to the plane the receiver is, inside the rectangle or out, all numbers are finite and of the rectangle.
TYPED_TEST(SphericalRectangle, AtAllHeightsPointsAreOfTheRectangle) {
  using T = TypeParam;
  const T last = 1 - std::numeric_limits<T>::epsilon() / 2;
  Coordinates<T> random(13);
  for (int exponent = 3; exponent > -110; --exponent) {
    const T z = std::ldexp(T(1), exponent);
    for (int k = 0; k < 60; ++k) {
      const Vec<T> corner = {2 * random() - T(1.5), 2 * random() - T(1.5), z};
      const Vec<T> edge_1 = {std::ldexp(random() + T(0.5), -(k % 7)), T(0), T(0)},
                   edge_2 = {T(0), random() + T(0.5), T(0)};
      const T u1 = k % 3 == 0 ? last : k % 4 == 0 ? T(0) : random(), u2 = k % 5 == 0 ? last : random();
      const RectanglePoint<T> p = sample_rectangle_solid_angle(corner, edge_1, edge_2, u1, u2);
      EXPECT_GE(p.solid_angle, 0);
      EXPECT_LE(p.solid_angle, T(6.2831855));
      for (const T share : {p.a, p.b}) {
        EXPECT_GE(share, 0) << z;
        EXPECT_LE(share, 1) << z;
      }
      const T rounding = 16 * std::numeric_limits<T>::epsilon();
      EXPECT_NEAR(p.position.x, corner.x + p.a * edge_1.x, rounding) << z << ' ' << k;
      EXPECT_NEAR(p.position.y, corner.y + p.b * edge_2.y, rounding) << z << ' ' << k;
      EXPECT_NEAR(p.position.z, z, rounding * z);
    }
  }
}

TYPED_TEST(SphericalRectangle, PacketsDrawWhatScalarsDo) {
  using T = TypeParam;
  using F = NativePacket<T>;
  constexpr auto kLanes = static_cast<std::size_t>(kWidth<F>);
  alignas(64) std::array<T, kLanes> x0, x1, y0, y1, z, u1, u2, a, b, all;
  Coordinates<T> random(5);
  // A lane's neighbours are other rectangles.
  for (std::size_t first = 0; first < rectangles().size(); ++first) {
    const auto of_lane = [&](std::size_t l) { return rectangles()[(first + l) % rectangles().size()]; };
    for (std::size_t l = 0; l < kLanes; ++l) {
      const Case c = of_lane(l);
      x0[l] = static_cast<T>(c.x0), x1[l] = static_cast<T>(c.x1 - c.x0), y0[l] = static_cast<T>(c.y0);
      y1[l] = static_cast<T>(c.y1 - c.y0), z[l] = static_cast<T>(c.z), u1[l] = random(), u2[l] = random();
    }
    const F zero(T(0));
    const RectanglePoint<F> p = sample_rectangle_solid_angle<F>(
        {load<F>(x0.data()), load<F>(y0.data()), load<F>(z.data())}, {load<F>(x1.data()), zero, zero},
        {zero, load<F>(y1.data()), zero}, load<F>(u1.data()), load<F>(u2.data()));
    store(a.data(), p.a), store(b.data(), p.b), store(all.data(), p.solid_angle);
    for (std::size_t l = 0; l < kLanes; ++l) {
      const RectanglePoint<T> alone = draw(of_lane(l), u1[l], u2[l]);
      EXPECT_EQ(a[l], alone.a) << of_lane(l).name;
      EXPECT_EQ(b[l], alone.b) << of_lane(l).name;
      EXPECT_EQ(all[l], alone.solid_angle) << of_lane(l).name;
    }
  }
}

}  // namespace
}  // namespace halfslope
