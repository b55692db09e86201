// Analytic scenes by name: what each sample of a technique is worth against the formula, and exact integrals.
#include "scenes/integrand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/kernel_library.h"
#include "tests/scenes/integrand_samples.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

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
  for (const char* r : {"0", "-0.1", "0.6"}) {
    EXPECT_THAT(error_of("ball:d=2,r=" + std::string(r)), HasSubstr("in (0, 0.5]; found " + std::string(r)));
  }
  EXPECT_THAT(error_of("checker:n=1"), HasSubstr("n must be a whole number from 2 to 1024, found 1"));
  EXPECT_THAT(error_of("sobol-g:d=65"), HasSubstr("d must be a whole number from 1 to 64, found 65"));
  EXPECT_EQ(error_of("quarterdisk:n=1"), "scene 'quarterdisk:n=1': it takes no parameters");
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
    if (info.parameters == "n=SIDE") name += ":n=3";
    if (info.parameters.starts_with("n=EXPONENT")) name += ":n=3,alpha=0.5";
    if (info.parameters.starts_with("d=")) name += ":d=5";
    const auto scene = make_analytic_scene(name);
    ASSERT_TRUE(scene) << name;
    EXPECT_EQ(scene->fingerprint(), name);
    EXPECT_EQ(info.integral.has_value(), info.parameters.empty());
    if (info.integral) {
      EXPECT_EQ((*scene->closed_form(0))[0], *info.integral);
      EXPECT_EQ(scene->variance(), info.variance);
    }
    EXPECT_EQ(scene->pixels(), 1);
    EXPECT_EQ(scene->channels(), 1);
    EXPECT_TRUE(scene->closed_form(0).has_value());
    EXPECT_THAT(scene->pixel(0).constant, ElementsAre(0, 0, 0));
    EXPECT_TRUE(scene->pixel(0).integral);
  }
}

}  // namespace
}  // namespace halfslope
