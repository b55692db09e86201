// Analytic scenes by name: what each sample of a technique is worth against the formula, and exact integrals.
#include "scenes/integrand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/kernel_library.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
constexpr int kSamples = 64;

PointBlock random_points(int dims, int count = kSamples) {
  PointBlock points;
  points.reset(dims, count, true);
  std::mt19937_64 random(static_cast<std::uint64_t>(dims));
  for (int d = 0; d < dims; ++d) {
    for (std::size_t i = 0; i < points.stride(); ++i) {
      points.high(d)[i] = static_cast<std::uint32_t>(random());
      points.low(d)[i] = static_cast<std::uint32_t>(random() >> 43);
    }
  }
  // The ends of the interval too.
  for (int d = 0; d < dims; ++d) {
    points.high(d)[0] = points.low(d)[0] = 0;
    points.high(d)[1] = 0xffffffffu;
    points.low(d)[1] = (1u << 21) - 1;
  }
  return points;
}

template <class T>
double coordinate_as(const PointBlock& points, int dim, std::size_t i) {
  const double u = points.coordinate(dim, static_cast<int>(i / kLanes), static_cast<int>(i % kLanes));
  return std::is_same_v<T, float> ? std::floor(u * 0x1p24) * 0x1p-24 : u;
}

/// Value and densities of one technique at random points, with every density of the set.
template <class T>
struct Samples {
  PointBlock points;
  TermBlock<T> terms;
  Samples(const IntegralSource& scene, int technique)
      : points(random_points(scene.techniques()[static_cast<std::size_t>(technique)].layout.dims())) {
    std::vector<int> set;
    for (std::size_t k = 0; k < scene.techniques().size(); ++k) set.push_back(static_cast<int>(k));
    terms.reset(1, 1, static_cast<int>(set.size()), kSamples);
    scene.pixel(0).integral->sample({technique, 0, 0, set}, points, terms);
  }
  double u(int dim, std::size_t i) const { return coordinate_as<T>(points, dim, i); }
  std::size_t size() const { return points.stride(); }
  double value(std::size_t i) { return terms.value(0, 0)[i]; }
  double pdf(int k, std::size_t i) { return terms.pdf(0, k)[i]; }
};

template <class T>
class Integrands : public testing::Test {
 protected:
  static constexpr double kUlps = 16 * std::numeric_limits<T>::epsilon();
  static void close(double found, double exact) { ASSERT_LE(std::fabs(found - exact), kUlps * std::fabs(exact)); }
};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(Integrands, Numbers);

TYPED_TEST(Integrands, QuarterDisk) {
  const auto scene = make_analytic_scene("quarterdisk");
  EXPECT_EQ((*scene->closed_form(0))[0], 0.5);
  Samples<TypeParam> samples(*scene, 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double x = samples.u(0, i), y = samples.u(1, i), r2 = x * x + y * y;
    if (std::fabs(r2 - 2 / kPi) < 1e-6) continue;
    ASSERT_EQ(samples.value(i), r2 < 2 / kPi ? 1 : 0);
    ASSERT_EQ(samples.pdf(0, i), 1);
  }
}

TYPED_TEST(Integrands, QuarterGaussian) {
  const auto scene = make_analytic_scene("quartergaussian");
  EXPECT_NEAR((*scene->closed_form(0))[0], 0.5577462853510337, 1e-15);
  Samples<TypeParam> samples(*scene, 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double x = samples.u(0, i), y = samples.u(1, i);
    this->close(samples.value(i), std::exp(-x * x - y * y));
    ASSERT_EQ(samples.pdf(0, i), 1);
  }
}

TYPED_TEST(Integrands, MisToy) {
  const auto scene = make_analytic_scene("mis-toy");
  EXPECT_EQ((*scene->closed_form(0))[0], 0.5);
  Samples<TypeParam> light(*scene, 0), bsdf(*scene, 1);
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double u = light.u(0, i);
    this->close(light.value(i), u);  // x = u, f/p₁ = x
    this->close(light.pdf(0, i), 1);
    this->close(light.pdf(1, i), 2 * u);
    this->close(bsdf.value(i), 0.5);  // x = √u, f/p₂ = 1/2
    this->close(bsdf.pdf(0, i), 1);
    this->close(bsdf.pdf(1, i), 2 * std::sqrt(u));
  }
}

TYPED_TEST(Integrands, StepX) {
  Samples<TypeParam> samples(*make_analytic_scene("stepx"), 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_GT(std::fabs(samples.u(0, i) * kPi - 1), 1e-6) << "on the edge";
    ASSERT_EQ(samples.value(i), samples.u(0, i) * kPi < 1 ? 1 : 0);
    ASSERT_EQ(samples.pdf(0, i), 1);
  }
}

TYPED_TEST(Integrands, Bilinear) {
  Samples<TypeParam> samples(*make_analytic_scene("bilinear"), 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    this->close(samples.value(i), samples.u(0, i) * samples.u(1, i));
    ASSERT_EQ(samples.pdf(0, i), 1);
  }
}

TYPED_TEST(Integrands, GenzGaussian) {
  // The coefficients of published tables, difficulty 7.03 spread as 1/d², to four decimals.
  const std::array<double, 6> centres = {0.5, 0.2326, 0.6652, 0.3979, 0.8305, 0.5631};
  const std::vector<std::vector<double>> widths = {{3.515},
                                                   {0.8788, 2.6362},
                                                   {0.3906, 1.1717, 1.9528},
                                                   {0.2197, 0.6591, 1.0984, 1.5378},
                                                   {0.1406, 0.4218, 0.703, 0.9842, 1.2654},
                                                   {0.0976, 0.2929, 0.4882, 0.6835, 0.8788, 1.074}};
  for (int d = 1; d <= 6; ++d) {
    Samples<TypeParam> samples(*make_analytic_scene(fmt::format("genz-gaussian:d={}", d)), 0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      double sum = 0;
      for (int k = 0; k < d; ++k) {
        const auto j = static_cast<std::size_t>(k);
        sum += std::pow(widths[static_cast<std::size_t>(d - 1)][j] * (samples.u(k, i) - centres[j]), 2);
      }
      // The exponent's error is that of its largest terms.
      ASSERT_NEAR(samples.value(i) / std::exp(-sum), 1, this->kUlps * (1 + sum));
      ASSERT_EQ(samples.pdf(0, i), 1);
    }
  }
}

TYPED_TEST(Integrands, HalfSpace) {
  const auto side = [](int d, const std::array<double, 6>& x) {
    const double r2 = x[1] / std::sqrt(2), r3 = x[2] / std::sqrt(3), r5 = x[3] / std::sqrt(5);
    if (d == 1) return x[0] / std::sqrt(2) - 0.1;
    if (d == 2) return x[0] - r2 - 0.1;
    if (d == 3) return x[0] - r2 + r3 - 0.1;
    const double four = x[0] + r2 - r3 - r5 - 0.1;
    return four + (d > 4 ? x[4] / std::sqrt(7) : 0) - (d > 5 ? x[5] / std::sqrt(11) : 0);
  };
  for (int d = 1; d <= 6; ++d) {
    Samples<TypeParam> samples(*make_analytic_scene(fmt::format("halfspace:d={}", d)), 0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      std::array<double, 6> x{};
      for (int k = 0; k < d; ++k) x[static_cast<std::size_t>(k)] = samples.u(k, i);
      ASSERT_GT(std::fabs(side(d, x)), 1e-6) << "on the plane";
      ASSERT_EQ(samples.value(i), side(d, x) > 0 ? 1 : 0);
    }
  }
}

struct Known {
  const char* name;
  double integral, variance;  ///< independent, to the digits given
};

TEST(AnalyticScenes, IntegralsAndVariancesAreTheKnownOnes) {
  const std::array<Known, 9> known = {{{"stepx", 0.3183098861837906715, 0.216988702541453},
                                       {"quarterdisk", 0.5, 0.25},
                                       {"bilinear", 0.25, 0.0486111111111111},
                                       {"genz-gaussian:d=2", 0.5083151935558555880, 0.11602644186723},
                                       {"genz-gaussian:d=4", 0.6767085303644633084, 0.029127484279478},
                                       {"genz-gaussian:d=6", 0.7291923014946368974, 0.0176771073970815},
                                       {"halfspace:d=3", 0.7907163333946851956, 0.16548401349755},
                                       {"halfspace:d=4", 0.7104723182568874544, 0.205701403247571},
                                       {"halfspace:d=1", 1 - 0.14142135623730950488, 0.12142135623730950488}}};
  const int samples = 1 << 14;
  for (const Known& k : known) {
    SCOPED_TRACE(k.name);
    const auto scene = make_analytic_scene(k.name);
    EXPECT_NEAR((*scene->closed_form(0))[0], k.integral, 2e-15);
    const PointBlock points = random_points(scene->techniques()[0].layout.dims(), samples);
    const std::size_t count = points.stride();
    const double n = static_cast<double>(count);
    TermBlock<double> terms;
    terms.reset(1, 1, 1, samples);
    const std::vector<int> set = {0};
    scene->pixel(0).integral->sample({0, 0, 0, set}, points, terms);
    const double* values = terms.value(0, 0);
    double mean = 0, second = 0, fourth = 0;
    for (std::size_t i = 0; i < count; ++i) mean += values[i] / n;
    for (std::size_t i = 0; i < count; ++i) {
      const double square = (values[i] - k.integral) * (values[i] - k.integral);
      second += square / n;
      fourth += square * square / n;
    }
    // Six standard errors of each: a false alarm in 5e8.
    EXPECT_NEAR(mean, k.integral, 6 * std::sqrt(k.variance / n));
    EXPECT_NEAR(second, k.variance, 6 * std::sqrt((fourth - k.variance * k.variance) / n) + 1e-12);
  }
}

TEST(AnalyticScenes, HalfSpaceVolumesAreThoseOfTheirSections) {
  // V_d = ∫ V_(d−1)(offset − w x) dx over the last coordinate; in one dimension V is a clamped line. Piecewise
  // polynomial of degree ≤ 5, so the midpoint rule on n cells is right to 1/n².
  const double r2 = 1 / std::sqrt(2), r3 = 1 / std::sqrt(3), r5 = 1 / std::sqrt(5), r7 = 1 / std::sqrt(7);
  const auto first = [](double c) { return std::clamp(1 - c, 0.0, 1.0); };  // x > c
  const auto second = [&](double w, double c) {                             // x + w y > c, w > 0: exactly
    const auto g = [&](double t) { return t <= 0 ? 0.0 : t >= 1 ? t - 0.5 : t * t / 2; };  // ∫ clamp(s, 0, 1) ds
    return (g(1 - c + w) - g(1 - c)) / w;
  };
  const int n = 100;
  const auto mean = [&](const auto& f) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += f((i + 0.5) / n) / n;
    return sum;
  };
  EXPECT_NEAR((*make_analytic_scene("halfspace:d=2")->closed_form(0))[0],
              mean([&](double y) { return first(0.1 + r2 * y); }), 1e-5);
  const double five = mean([&](double a) {
    return mean([&](double b) { return mean([&](double c) { return second(r2, 0.1 + r3 * a + r5 * b - r7 * c); }); });
  });
  EXPECT_NEAR((*make_analytic_scene("halfspace:d=5")->closed_form(0))[0], five, 1e-5);
  const int coarse = 60;
  double six = 0;
  for (int i = 0; i < coarse; ++i) {
    for (int j = 0; j < coarse; ++j) {
      for (int k = 0; k < coarse; ++k) {
        for (int l = 0; l < coarse / 4; ++l) {
          const double h = 1.0 / coarse, a = (i + 0.5) * h, b = (j + 0.5) * h, c = (k + 0.5) * h, e = (l + 0.5) * 4 * h;
          six += second(r2, 0.1 + r3 * a + r5 * b - r7 * c + e / std::sqrt(11)) * 4 * h * h * h * h;
        }
      }
    }
  }
  EXPECT_NEAR((*make_analytic_scene("halfspace:d=6")->closed_form(0))[0], six, 1e-4);
}

struct CapParameters {
  double n, alpha;
};

TYPED_TEST(Integrands, AlignedPhongCap) {
  for (const CapParameters c : {CapParameters{10, 0.05}, CapParameters{1, 0.2}, CapParameters{0, 1.0},
                                CapParameters{1000, 0.01}, CapParameters{100, kPi / 2}}) {
    const std::string name = fmt::format("aligned-phong-cap:n={},alpha={}", c.n, c.alpha);
    SCOPED_TRACE(name);
    const auto scene = make_analytic_scene(name);
    using Real = long double;
    const Real v_max = 2 * std::pow(std::sin(static_cast<Real>(c.alpha) / 2), 2);
    const Real exact = -std::expm1((static_cast<Real>(c.n) + 1) * std::log1p(-std::min<Real>(v_max, 1)));
    ASSERT_NEAR((*scene->closed_form(0))[0] / static_cast<double>(exact), 1, 1e-13);
    Samples<TypeParam> light(*scene, 0), bsdf(*scene, 1);
    const Real p_light = 1 / (2 * kPi * v_max), peak = (c.n + 1) / (2 * kPi);
    // (1 − v)ⁿ multiplies the error of ln(1 − v) by n.
    const double epsilon = std::numeric_limits<TypeParam>::epsilon();
    for (std::size_t i = 0; i < light.size(); ++i) {
      const Real u = light.u(0, i), log_cos = std::log1p(-u * v_max);
      const Real p_bsdf = peak * std::exp(c.n * log_cos);
      const double tolerance = epsilon * (16 + 4 * c.n * std::fabs(static_cast<double>(log_cos)));
      if (u < 1 - 1e-6 && p_bsdf > 1e-30L) {  // the lobe's last digits, at the horizon, are the coordinate's
        ASSERT_NEAR(light.value(i) / static_cast<double>(p_bsdf / p_light), 1, tolerance) << static_cast<double>(u);
        ASSERT_NEAR(light.pdf(1, i) / static_cast<double>(p_bsdf), 1, tolerance);
      }
      ASSERT_NEAR(light.pdf(0, i) / static_cast<double>(p_light), 1, 16 * epsilon);

      const Real v = -std::expm1(std::log1p(-static_cast<Real>(bsdf.u(0, i))) / (c.n + 1));
      if (std::fabs(v / v_max - 1) < 100 * epsilon) continue;  // the rim
      const bool inside = v < v_max;
      ASSERT_EQ(bsdf.value(i), inside ? 1 : 0);
      ASSERT_NEAR(bsdf.pdf(0, i), inside ? static_cast<double>(p_light) : 0,
                  16 * epsilon * static_cast<double>(p_light));
      const Real own = peak * std::pow(1 - static_cast<Real>(bsdf.u(0, i)), c.n / (c.n + 1));
      ASSERT_NEAR(bsdf.pdf(1, i) / static_cast<double>(own), 1, 64 * epsilon);
    }
  }
}

std::string error_of(const std::string& name) {
  try {
    make_analytic_scene(name);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  ADD_FAILURE() << "no error for " << name;
  return "";
}

TEST(AnalyticScenes, NamesAndParameters) {
  EXPECT_EQ(make_analytic_scene("veach-mis"), nullptr);
  EXPECT_EQ(make_analytic_scene(""), nullptr);
  EXPECT_EQ(
      error_of("aligned-phong-cap:n=1,alpah=2"),
      "scene 'aligned-phong-cap:n=1,alpah=2': there is no parameter 'alpah'; did you mean 'alpha'?; allowed: n, alpha");
  EXPECT_EQ(error_of("aligned-phong-cap:n=10"),
            "scene 'aligned-phong-cap:n=10': parameter 'alpha' is missing; it takes n, alpha");
  EXPECT_THAT(error_of("aligned-phong-cap"), HasSubstr("parameter 'n' is missing"));
  EXPECT_THAT(error_of("aligned-phong-cap:n=1,n=2,alpha=1"), HasSubstr("parameter 'n' stands twice"));
  for (const char* number : {"", "x", "1x", "nan", "inf", "0x10", " 1", "1 ", "1e999"}) {
    EXPECT_THAT(error_of("aligned-phong-cap:alpha=1,n=" + std::string(number)),
                HasSubstr("parameter 'n' must be a number, found '" + std::string(number) + "'"));
  }
  EXPECT_THAT(error_of("aligned-phong-cap:n=-1,alpha=1"), HasSubstr("n must be at least 0, found -1"));
  for (const char* alpha : {"0", "-1", "1.6"}) {
    EXPECT_THAT(error_of("aligned-phong-cap:n=1,alpha=" + std::string(alpha)), HasSubstr("in (0, pi/2]"));
  }
  EXPECT_EQ(error_of("quarterdisk:n=1"), "scene 'quarterdisk:n=1': it takes no parameters; write 'quarterdisk'");
  EXPECT_EQ(error_of("stepx:"), "scene 'stepx:': nothing stands after ':'");
  EXPECT_EQ(error_of("halfspace:d=2,"), "scene 'halfspace:d=2,': nothing stands after the last ','");
  for (const std::string scene : {"halfspace", "genz-gaussian"}) {
    for (const std::string d : {"0", "7", "-1", "2.5"}) {
      EXPECT_EQ(error_of(scene + ":d=" + d),
                "scene '" + scene + ":d=" + d + "': d must be a whole number from 1 to 6, found " + d);
    }
    EXPECT_EQ(error_of(scene), "scene '" + scene + "': parameter 'd' is missing; it takes d");
    EXPECT_EQ(make_analytic_scene(scene + ":d=3")->techniques()[0].layout.groups, (std::vector<std::uint8_t>{2, 1}));
    EXPECT_EQ(make_analytic_scene(scene + ":d=6")->techniques()[0].layout.groups, (std::vector<std::uint8_t>{2, 2, 2}));
  }
}

TEST(AnalyticScenes, AreOnePixelOfOneChannel) {
  ASSERT_FALSE(analytic_scenes().empty());
  for (const IntegrandInfo& info : analytic_scenes()) {
    EXPECT_FALSE(info.description.empty() || info.reference.empty()) << info.name;
    std::string name = info.name;
    if (info.parameters.starts_with("n=")) name += ":n=3,alpha=0.5";
    if (info.parameters.starts_with("d=")) name += ":d=5";
    const auto scene = make_analytic_scene(name);
    ASSERT_TRUE(scene) << name;
    EXPECT_EQ(scene->fingerprint(), name);
    EXPECT_EQ(scene->pixels(), 1);
    EXPECT_EQ(scene->channels(), 1);
    EXPECT_TRUE(scene->closed_form(0).has_value());
    EXPECT_THAT(scene->pixel(0).constant, ElementsAre(0, 0, 0));
    EXPECT_TRUE(scene->pixel(0).integral);
  }
}

}  // namespace
}  // namespace halfslope
