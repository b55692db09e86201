// Integrands of one to six dimensions: values against their formulas, integrals and variances against known ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scenes/integrand.h"
#include "tests/scenes/integrand_samples.h"

namespace halfslope {
namespace {

template <class T>
class IntegrandDims : public Integrands<T> {};
TYPED_TEST_SUITE(IntegrandDims, Numbers);

TYPED_TEST(IntegrandDims, GenzGaussian) {
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

TYPED_TEST(IntegrandDims, HalfSpace) {
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

}  // namespace
}  // namespace halfslope
