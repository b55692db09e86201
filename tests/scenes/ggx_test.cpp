#include "scenes/ggx.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array kAlphas = {0.001, 0.005, 0.05, 0.3, 1.0};

Vec<double> direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The microfacet normal (v, φ) of the stretched hemisphere: tan θ = α √(1 − v²)/v. There D cos θ dω = 2v dv dφ / 2π
/// (the distribution of visible area seen from above), so dω = v dv dφ / (π D cos θ): smooth in v for every α.
struct Facet {
  Vec<double> h;
  double solid_angle;  ///< of dv dφ
};
Facet facet(double alpha, double v, double phi) {
  const double s = alpha * std::sqrt((1 - v) * (1 + v)), norm = std::hypot(s, v);
  const Vec<double> h{s * std::cos(phi) / norm, s * std::sin(phi) / norm, v / norm};
  return {h, v / (kPi * ggx_d(alpha, h) * h.z)};
}

TEST(Ggx, ProjectedMicrofacetAreaIsOne) {
  // ∫ D cos θ dω = 1 by the midpoint rule in x = ln tan θ, which knows nothing of GGX but its scale.
  for (const double alpha : kAlphas) {
    const int n = 200'000;
    const double lo = std::log(alpha * 1e-6), hi = std::log(alpha * 1e6);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double t = std::exp(lo + (hi - lo) * (i + 0.5) / n), c = 1 / std::hypot(1, t), s = t * c;
      sum += ggx_d(alpha, Vec<double>{s, 0, c}) * c * s * (s * c);  // dθ = sin cos dx
    }
    EXPECT_NEAR(2 * kPi * sum * (hi - lo) / n, 1, 1e-9) << alpha;
  }
}

TEST(Ggx, BothFormsOfDAgree) {
  for (const double alpha : kAlphas) {
    for (const double theta : {0.01, 0.3, 1.0, 1.5}) {
      const double relative = ggx_d(alpha, std::cos(theta)) / ggx_d(alpha, direction(theta, 0.4));
      EXPECT_NEAR(relative, 1, 1e-10) << alpha << ' ' << theta;
    }
  }
}

TEST(Ggx, MaskingIsWhatMakesVisibleAreaTheProjectedArea) {
  // ∫ G₁ max(0, w·h) D dω_h = cos θ_w (Heitz 2014, eq. 2): the visible normals' density integrates to 1.
  for (const double alpha : kAlphas) {
    for (const double theta : {0.0, 0.7, 1.3, 1.55}) {
      const Vec<double> w = direction(theta, 0);
      const int n = 1000;
      double sum = 0;
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const Facet f = facet(alpha, (i + 0.5) / n, 2 * kPi * (j + 0.5) / n);
          sum += ggx_visible_normal_pdf(alpha, w, f.h) * f.solid_angle;
        }
      }
      EXPECT_NEAR(sum * 2 * kPi / n / n, 1, 1e-4) << alpha << ' ' << theta;
    }
  }
}

TEST(Ggx, LambdaG1AndG2AreOneFamily) {
  for (const double alpha : kAlphas) {
    for (const double ci : {1.0, 0.9, 0.3, 1e-3, 1e-12}) {
      EXPECT_NEAR(ggx_g1_over_cos(alpha, ci) * ci * (1 + ggx_lambda(alpha, ci)), 1, 1e-13);
      for (const double co : {1.0, 0.5, 1e-6}) {
        const double g2 = ggx_visibility(alpha, ci, co) * 4 * ci * co;
        EXPECT_NEAR(g2 * (1 + ggx_lambda(alpha, ci) + ggx_lambda(alpha, co)), 1, 1e-13);
        EXPECT_EQ(ggx_visibility(alpha, ci, co), ggx_visibility(alpha, co, ci));  // reciprocity, to the bit
      }
    }
  }
}

TEST(Ggx, ReflectionNeverGainsEnergy) {
  // Albedo with F = 1 as the mean of f cos / pdf = G₂/G₁ over a grid of (u₁, u₂): at most 1, and 1 for a mirror.
  for (const double alpha : kAlphas) {
    for (const double theta : {0.0, 0.8, 1.4, 1.57}) {
      const Vec<double> w = direction(theta, 2.0);
      const int n = 200;
      double albedo = 0;
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const Vec<double> h = sample_ggx_visible_normal(alpha, w, (i + 0.5) / n, (j + 0.5) / n);
          const Vec<double> o = (2 * dot(w, h)) * h - w;
          if (o.z <= 0) continue;
          const double weight =
              ggx_d(alpha, h) * ggx_visibility(alpha, w.z, o.z) * o.z / ggx_reflection_pdf_solid_angle(alpha, w.z, h);
          ASSERT_GE(weight, 0);
          ASSERT_LE(weight, 1 + 1e-12);
          albedo += weight / n / n;
        }
      }
      EXPECT_LE(albedo, 1);
      if (alpha == 0.001 && theta == 0) {
        EXPECT_NEAR(albedo, 1, 1e-4);
      }
      // α = 1 has f = 1 / (2π (c_i + c_o)), so the albedo is ∫ c_o / (c_i + c_o) dc_o = 1 − c ln((1 + c)/c).
      if (alpha == 1) {
        EXPECT_NEAR(albedo, 1 - w.z * std::log((1 + w.z) / w.z), 2e-3);
      }
    }
  }
}

TEST(Ggx, ReflectionPdfIsTheVisibleNormalPdfOverTheJacobian) {
  const Vec<double> w = direction(1.1, 0.3), h = direction(0.2, 1.0);
  EXPECT_NEAR(ggx_reflection_pdf_solid_angle(0.3, w.z, h) * 4 * dot(w, h) / ggx_visible_normal_pdf(0.3, w, h), 1,
              1e-14);
}

class VisibleNormals : public testing::TestWithParam<std::tuple<double, double>> {};

// χ² over 10 × 16 cells of (v, φ). z is Wilson and Hilferty's normal deviate of χ²; 5.5 is passed by chance with
// probability 2e-8.
TEST_P(VisibleNormals, SamplesFollowTheDensity) {
  const auto [alpha, theta] = GetParam();
  const Vec<double> w = direction(theta, 0.5);
  constexpr int kHeights = 10, kAzimuths = 16, kFine = 60, kSamples = 400'000;
  std::array<double, kHeights * kAzimuths> expected{}, observed{};
  for (int i = 0; i < kHeights * kFine; ++i) {
    for (int j = 0; j < kAzimuths * kFine; ++j) {
      const Facet f = facet(alpha, (i + 0.5) / (kHeights * kFine), 2 * kPi * (j + 0.5) / (kAzimuths * kFine));
      expected[static_cast<std::size_t>(i / kFine * kAzimuths + j / kFine)] +=
          ggx_visible_normal_pdf(alpha, w, f.h) * f.solid_angle * 2 * kPi / (kHeights * kAzimuths * kFine * kFine);
    }
  }
  std::mt19937_64 random(20240229);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < kSamples; ++i) {
    const double u1 = uniform(), u2 = uniform();
    const Vec<double> h = sample_ggx_visible_normal(alpha, w, u1, u2);
    ASSERT_NEAR(length(h), 1, 1e-14);
    ASSERT_GT(h.z, 0);
    const double v = h.z / std::hypot(h.z, std::hypot(h.x, h.y) / alpha);
    const double turn = std::atan2(h.y, h.x) / (2 * kPi), phi = turn < 0 ? turn + 1 : turn;
    const int height = std::min(static_cast<int>(v * kHeights), kHeights - 1);
    const int azimuth = std::min(static_cast<int>(phi * kAzimuths), kAzimuths - 1);
    ++observed[static_cast<std::size_t>(height * kAzimuths + azimuth)];
  }
  double chi2 = 0, rest_expected = 0, rest_observed = 0;
  int cells = 0;
  const auto add = [&](double e, double o) {
    chi2 += (o - e) * (o - e) / e;
    ++cells;
  };
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double e = expected[i] * kSamples;
    if (e >= 20) {
      add(e, observed[i]);
    } else {
      rest_expected += e;
      rest_observed += observed[i];
    }
  }
  if (rest_expected >= 20) {
    add(rest_expected, rest_observed);
  } else {
    EXPECT_LE(rest_observed, 60);  // Poisson of mean 20 passes 60 with probability 1e-12
  }
  ASSERT_GT(cells, 20);
  const double dof = cells - 1, variance = 2 / (9 * dof);
  const double z = (std::cbrt(chi2 / dof) - (1 - variance)) / std::sqrt(variance);
  EXPECT_LT(z, 5.5) << "chi2 " << chi2 << " over " << dof;
}

INSTANTIATE_TEST_SUITE_P(RoughnessAndIncidence, VisibleNormals,
                         testing::Combine(testing::Values(0.001, 0.02, 0.3, 1.0),
                                          testing::Values(0.0, 0.8, 1.5, 1.57079)));

TEST(VisibleNormals, ExtremePointsGiveFiniteUnitVectorsInBinary32) {
  const float last = 0x1.fffffep-1f;
  for (const float alpha : {1e-4f, 0.1f, 1.0f}) {
    for (const auto& w :
         {Vec<float>{0, 0, 1}, Vec<float>{1, 0, 0}, Vec<float>{0.6f, 0, 0.8f}, Vec<float>{0, -1, 1e-20f}}) {
      for (const float u1 : {0.0f, 0.25f, 0.5f, last}) {
        for (const float u2 : {0.0f, 0.5f, last}) {
          const Vec<float> h = sample_ggx_visible_normal(alpha, w, u1, u2);
          EXPECT_NEAR(length(h), 1, 1e-6);
          EXPECT_GT(h.z, 0);
          // At the rim of the cap, o is all but −v and the sign of w·h a matter of rounding.
          if (u2 < last) {
            EXPECT_GE(dot(w, h), 0);
          }
        }
      }
    }
  }
}

/// The Fresnel equations as the textbook has them, in complex long double.
long double textbook_fresnel(long double c, long double eta, long double k) {
  using Complex = std::complex<long double>;
  const Complex n(eta, k), cos_t = std::sqrt(Complex(1) - (1 - c * c) / (n * n));
  const Complex s = (c - n * cos_t) / (c + n * cos_t), p = (n * c - cos_t) / (n * c + cos_t);
  return (std::norm(s) + std::norm(p)) / 2;
}

TEST(FresnelConductor, IsTheTextbookFormula) {
  for (const double eta : {0.05, 0.2, 1.0, 1.5, 4.0}) {
    for (const double k : {1e-3, 0.5, 1.0, 3.9, 8.0}) {
      for (const double c : {1.0, 0.9, 0.5, 0.1, 1e-3, 1e-9}) {
        const double exact = static_cast<double>(textbook_fresnel(c, eta, k));
        EXPECT_NEAR(fresnel_conductor(c, eta, k) / exact, 1, 1e-13) << eta << ' ' << k << ' ' << c;
        const auto single = fresnel_conductor(static_cast<float>(c), static_cast<float>(eta), static_cast<float>(k));
        EXPECT_NEAR(single, exact, 2e-6) << eta << ' ' << k << ' ' << c;
      }
    }
  }
}

TEST(FresnelConductor, LimitsAndRange) {
  EXPECT_NEAR(fresnel_conductor(1.0, 0.2, 3.9), (0.64 + 15.21) / (1.44 + 15.21), 1e-15);  // ((η−1)²+k²)/((η+1)²+k²)
  EXPECT_EQ(fresnel_conductor(0.0, 0.2, 3.9), 1);
  EXPECT_EQ(fresnel_conductor(0.0, 1.0, 0.0), 1);
  EXPECT_NEAR(fresnel_conductor(0.5, 1.0, 0.0), 0, 1e-15);  // no interface
  EXPECT_NEAR(fresnel_conductor(0.7, 0.0, 1.0), 1, 1e-15);  // Mitsuba's material "none"
  // Brewster's angle of η = 1.5: R_p vanishes and R_s = ((1 − η²)/(1 + η²))².
  EXPECT_NEAR(fresnel_conductor(1 / std::hypot(1, 1.5), 1.5, 0.0), 0.5 * std::pow(1.25 / 3.25, 2), 1e-15);
  // Beyond the critical angle of η < 1 all is reflected.
  EXPECT_NEAR(fresnel_conductor(0.1, 0.5, 0.0), 1, 1e-15);
  std::mt19937_64 random(7);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 100'000; ++i) {
    const double c = uniform(), eta = 10 * uniform(), k = 10 * uniform();
    const auto f = fresnel_conductor(static_cast<float>(c), static_cast<float>(eta), static_cast<float>(k));
    ASSERT_GE(f, 0);
    ASSERT_LE(f, 1 + 2e-7f);
  }
}

}  // namespace
}  // namespace halfslope
