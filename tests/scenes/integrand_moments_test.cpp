// Integrals and variances of every integrand: against independent digits, against samples, and by quadrature.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/scenes/integrand_data.h"
#include "tests/scenes/integrand_samples.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;

double integral_of(const std::string& name) { return (*make_analytic_scene(name)->closed_form(0))[0]; }
double variance_of(const std::string& name) { return make_analytic_scene(name)->variance().value(); }

TEST(IntegrandMoments, AreThoseComputedElsewhere) {
  const auto all = known_integrands();
  ASSERT_EQ(all.size(), 70u);
  for (const KnownIntegrand& known : all) {
    SCOPED_TRACE(known.id);
    const auto scene = make_analytic_scene(known.id);
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->techniques().size(), 1u);
    EXPECT_EQ(scene->techniques()[0].layout.dims(), known.dims);
    const auto exact = static_cast<double>(known.integral), found = (*scene->closed_form(0))[0];
    EXPECT_LE(std::fabs(found - exact), 1e-14 * std::fabs(exact)) << found;
    ASSERT_TRUE(scene->variance());
    if (known.variance) {
      const auto variance = static_cast<double>(*known.variance);
      EXPECT_NEAR(*scene->variance(), variance, known.variance_error * variance);
    } else {
      EXPECT_TRUE(std::isinf(*scene->variance()) && *scene->variance() > 0);
    }
  }
}

// Two spellings of one scene: the catalogue's, with hyphens and parameters after ':', and the one of the data.
TEST(IntegrandMoments, BothSpellingsAreOneScene) {
  std::vector<std::string> names;
  for (const KnownIntegrand& known : known_integrands()) {
    const std::string own = analytic_scene_name(known.id);
    EXPECT_EQ(own.find('_'), std::string::npos) << own;
    EXPECT_EQ(analytic_scene_name(own), own);
    EXPECT_EQ(make_analytic_scene(own)->fingerprint(), own);
    EXPECT_EQ(make_analytic_scene(known.id)->fingerprint(), own);
    names.push_back(own);
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  EXPECT_EQ(analytic_scene_name("genz_gaussian_d4"), "genz-gaussian:d=4");
  EXPECT_EQ(analytic_scene_name("invsqrt_heavy"), "invsqrt-heavy");
  EXPECT_EQ(analytic_scene_name("ball4"), "ball:d=4");
  for (const std::string other : {"_d4", "sobol_g_d", "no_such_d3", "veach_mis", "d4"}) {
    EXPECT_EQ(analytic_scene_name(other), other);
    EXPECT_FALSE(make_analytic_scene(other)) << other;
  }
  try {
    make_analytic_scene("genz_gaussian_d7");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("scene 'genz_gaussian_d7': d must be a whole number from 1 to 6, found 7"));
  }
}

// 65536 random points of each, other dimensions too: mean and mean square within six standard errors, a false alarm
// in 5e8 each. The moments of a heavy tail cannot be met by samples, and stand below.
TEST(IntegrandMoments, AreMetByRandomPoints) {
  std::vector<std::string> names;
  for (const KnownIntegrand& known : known_integrands()) {
    if (known.variance && known.id != "invsqrtprod2") names.push_back(known.id);
  }
  for (const char* family : {"genz-oscillatory", "genz-productpeak", "genz-cornerpeak", "genz-gaussian",
                             "genz-continuous", "genz-discontinuous", "halfspace"}) {
    for (const int d : {1, 3, 5}) names.push_back(fmt::format("{}:d={}", family, d));
  }
  for (const char* family :
       {"sobol-g", "sumsq", "oddprod", "morokoff", "subcube", "bratley", "bernoulli2", "simplex"}) {
    for (const int d : {1, 2, 7}) names.push_back(fmt::format("{}:d={}", family, d));
  }
  for (const char* name : {"sobol-g:d=24", "bratley:d=64", "morokoff:d=64", "simplex:d=64", "keister:d=1",
                           "keister:d=2", "keister:d=8", "keister:d=12", "ball:d=1", "ball:d=2,r=0.5",
                           "ball:d=5,r=0.45", "checker:n=2", "checker:n=3", "checker:n=1000"}) {
    names.push_back(name);
  }
  const int samples = 1 << 12;
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const auto scene = make_analytic_scene(name);
    const double integral = (*scene->closed_form(0))[0], variance = scene->variance().value();
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
      const double square = (values[i] - integral) * (values[i] - integral);
      second += square / n;
      fourth += square * square / n;
    }
    EXPECT_NEAR(mean, integral, 6 * std::sqrt(variance / n));
    EXPECT_NEAR(second, variance, 6 * std::sqrt((fourth - variance * variance) / n) + 1e-12);
  }
}

/// ∫ f from a to b by the midpoint rule.
double integrate(double a, double b, int cells, const std::function<double(double)>& f) {
  const double step = (b - a) / cells;
  double sum = 0;
  for (int i = 0; i < cells; ++i) sum += f(a + (i + 0.5) * step);
  return sum * step;
}

// Over the quadrant: with x = s^m, dx = m s^(m−1) ds, the product of 0.7 x^−0.3 becomes smooth for m = 10.
TEST(IntegrandMoments, SingularOnesByQuadrature) {
  const auto power = [](double exponent) {
    return integrate(0, 1, 20000, [&](double s) { return 10 * std::pow(s, 9 - 10 * exponent); });
  };
  EXPECT_NEAR(integral_of("invsqrtprod2"), std::pow(0.7 * power(0.3), 2), 1e-7);
  EXPECT_NEAR(variance_of("invsqrtprod2"), std::pow(0.49 * power(0.6), 2) - 1, 1e-6);
  EXPECT_NEAR(integral_of("invsqrt-heavy"), std::pow(0.4 * power(0.6), 2), 1e-6);
  // In polar coordinates the mean of 1/r is the mean length of a ray in the square.
  EXPECT_NEAR(integral_of("invr"), 2 * integrate(0, kPi / 4, 20000, [](double t) { return 1 / std::cos(t); }), 1e-8);
}

// Fresnel's integrals; and sin(π/r), which in polar coordinates with u = 1/r has an integral from 1 to infinity, cut at
// the whole number U with its tail's first term.
TEST(IntegrandMoments, OscillatingOnesByQuadrature) {
  const auto mean_cosine = [](double k) {  // of k (x² + y²)
    const double c = integrate(0, 1, 200000, [&](double x) { return std::cos(k * x * x); });
    const double s = integrate(0, 1, 200000, [&](double x) { return std::sin(k * x * x); });
    return c * c - s * s;
  };
  const double one = mean_cosine(100), mean = 0.5 + one / 2;
  EXPECT_NEAR(integral_of("zoneplate100"), mean, 1e-8);
  EXPECT_NEAR(variance_of("zoneplate100"), 0.25 + one / 2 + (1 + mean_cosine(200)) / 8 - mean * mean, 1e-8);

  const auto polar = [](const std::function<double(double)>& f, double tail) {  // f of 1/r
    const double inner = integrate(1, 100, 990000, [&](double u) { return f(u) / (u * u * u); }) + tail;
    const double corner = integrate(0, std::sqrt(std::sqrt(2.0) - 1), 20000, [&](double s) {  // r = 1 + s²
      const double r = 1 + s * s;
      return r * f(1 / r) * (kPi / 2 - 2 * std::acos(1 / r)) * 2 * s;
    });
    return kPi / 2 * inner + corner;
  };
  const double first = polar([](double u) { return std::sin(kPi * u); }, 1 / (kPi * 1e6));
  const double second = polar([](double u) { return std::pow(std::sin(kPi * u), 2); }, 1 / (4 * 1e4));
  EXPECT_NEAR(integral_of("sininvr"), first, 1e-8);
  EXPECT_NEAR(variance_of("sininvr"), second - first * first, 1e-8);
}

// Normal numbers in d dimensions have lengths of density 2^(1 − d/2)/Γ(d/2) r^(d−1) exp(−r²/2).
TEST(IntegrandMoments, KeisterByItsRadius) {
  for (const int d : {1, 2, 3, 5, 9, 12}) {
    const auto mean = [&](const std::function<double(double)>& f) {
      return std::pow(2, 1 - d / 2.0) / std::tgamma(d / 2.0) * integrate(0, 20, 20000, [&](double r) {
               return f(std::cos(r / std::sqrt(2.0))) * std::pow(r, d - 1) * std::exp(-r * r / 2);
             });
    };
    const std::string name = fmt::format("keister:d={}", d);
    const double scale = std::pow(kPi, d / 2.0), first = mean([](double c) { return c; });
    EXPECT_NEAR(integral_of(name) / scale, first, 1e-6);
    EXPECT_NEAR(variance_of(name) / (scale * scale), mean([](double c) { return c * c; }) - first * first, 1e-6);
  }
}

// The midpoint rule's error is of the order of its step squared.
TEST(IntegrandMoments, FormFactorByQuadrature) {
  const auto f = [](double x, double y) { return 0.25 / (kPi * std::pow(x * x + y * y + 0.25, 2)); };
  const auto square = [&](double power) {
    return integrate(0, 1, 1000, [&](double x) {
      return integrate(0, 1, 1000, [&](double y) { return std::pow(f(x, y), power); });
    });
  };
  const double mean = square(1);
  EXPECT_NEAR(integral_of("formfactor-rect"), mean, 1e-6);
  EXPECT_NEAR(variance_of("formfactor-rect"), square(2) - mean * mean, 1e-6);
}

}  // namespace
}  // namespace halfslope
