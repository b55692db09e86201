#include "scenes/beckmann.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "scenes/microfacet.h"
#include "tests/scenes/bsdf_materials.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array kAlphas = {0.001, 0.05, 0.3, 1.0};

TEST(Beckmann, ProjectedMicrofacetAreaIsOne) {
  // ∫ D cos θ dω over θ by the midpoint rule in x = ln tan θ.
  for (const double alpha : kAlphas) {
    const int n = 20'000;
    const double lo = std::log(alpha * 1e-6), hi = std::log(alpha * 1e2);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double t = std::exp(lo + (hi - lo) * (i + 0.5) / n), c = 1 / std::hypot(1, t), s = t * c;
      sum += beckmann_d(alpha, alpha, Vec<double>{s, 0, c}) * c * s * (s * c);  // dθ = sin cos dx
    }
    EXPECT_NEAR(2 * kPi * sum * (hi - lo) / n, 1, 1e-9) << alpha;
  }
}

TEST(Beckmann, DIsTheSameFromCosineAndFromVectorsOfAnyLength) {
  for (const double alpha : kAlphas) {
    for (const double theta : {0.0, 0.5 * alpha, 2 * alpha, 1.5}) {
      const Vec<double> h{std::sin(theta) * 0.6, std::sin(theta) * 0.8, std::cos(theta)};
      const double d = beckmann_d(alpha, alpha, h);
      EXPECT_NEAR(beckmann_d(alpha, std::cos(theta)), d, 1e-9 * d) << alpha << ' ' << theta;
      EXPECT_NEAR(beckmann_d(alpha, alpha, 1e-3 * h), d, 1e-12 * d);
    }
  }
  EXPECT_NEAR(beckmann_d(0.5, 1.0), 1 / (kPi * 0.25), 1e-15);
  EXPECT_EQ(beckmann_d(0.5, 0.0), 0);
  EXPECT_EQ(beckmann_d(1e-3f, 1e-3f, Vec<float>{1, 0, 0}), 0);
}

/// A distribution's D and L, at two roughnesses.
template <template <class> class D>
void expect_visible_area_is_projected_area(double alpha_u, double alpha_v) {
  // ∫ (w·m)⁺ D dω_m = (cos θ + L)/2 = cos θ/G₁ (Heitz 2014, eq. 2), in slopes (p, q) = (α_u r cos φ, α_v r sin φ) with
  // r = tan ψ; dω = cos³ dp dq.
  const D<double> distribution(alpha_u, alpha_v);
  for (const double cosine : {1.0, 0.7, 0.1, 1e-3}) {
    const Vec<double> w = at_cosine(cosine);
    const int n = 400, turns = 800;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double psi = 0.5 * kPi * (i + 0.5) / n, r = std::tan(psi), c = std::cos(psi);
      for (int j = 0; j < turns; ++j) {
        const double phi = 2 * kPi * (j + 0.5) / turns;
        const Vec<double> m = normalise(Vec<double>{alpha_u * r * std::cos(phi), alpha_v * r * std::sin(phi), 1});
        sum += std::max(dot(w, m), 0.0) * distribution.d(m) * std::pow(m.z, 3) * alpha_u * alpha_v * r / (c * c);
      }
    }
    const double area = sum * kPi * kPi / n / turns, promised = (w.z + distribution.projected_length(w)) / 2;
    EXPECT_NEAR(area / promised, 1, 2e-5) << alpha_u << ' ' << alpha_v << ' ' << cosine;
  }
}

TEST(Microfacet, MaskingIsWhatMakesVisibleAreaTheProjectedArea) {
  expect_visible_area_is_projected_area<GgxDistribution>(0.01, 0.01);
  expect_visible_area_is_projected_area<GgxDistribution>(0.3, 0.8);
  expect_visible_area_is_projected_area<BeckmannDistribution>(0.01, 0.01);
  expect_visible_area_is_projected_area<BeckmannDistribution>(0.3, 0.8);
  expect_visible_area_is_projected_area<BeckmannDistribution>(1, 1);
}

TEST(Microfacet, OneRoughnessForBothTangentsIsTheIsotropicDistribution) {
  for (const double alpha : kAlphas) {
    const GgxDistribution<double> ggx(alpha, alpha);
    for (const double cosine : {1.0, 0.8, 0.1}) {
      const Vec<double> w = at_cosine(cosine);
      EXPECT_NEAR(ggx.d(w) / ggx_d(alpha, w), 1, 1e-13);
      EXPECT_NEAR(ggx.projected_length(w), ggx_projected_length(alpha, w.z), 1e-15);
    }
  }
}

TEST(Beckmann, LambdaIsTheTextbooks) {
  for (const double a : {1e-3, 0.1, 1.0, 3.0, 8.0}) {  // a = 1/(α tan θ), Λ = ½ (erf a − 1 + exp(−a²)/(a√π))
    const double lambda = 0.5 * (std::erf(a) - 1 + std::exp(-a * a) / (a * std::sqrt(kPi)));
    const double s = 0.1, c = a * s;
    EXPECT_NEAR(beckmann_projected_length(s, c) / (c * (1 + 2 * lambda)), 1, 1e-14) << a;
  }
  EXPECT_NEAR(beckmann_projected_length(0.1, 0.0), 0.1 / std::sqrt(kPi), 1e-16);
  EXPECT_EQ(beckmann_projected_length(0.0, 1.0), 1);
}

/// The share of visible slopes below t, in double: Heitz & d'Eon 2014, eq. 15, integrated.
double visible_share(double c, double s, double t) {
  const double a = s > 0 ? c / s : 30, inv = 1 / std::sqrt(kPi);
  const double all = c * (1 + std::erf(a)) + s * std::exp(-a * a) * inv;
  return (c * (std::erf(t) + std::erf(a)) + s * (std::exp(-a * a) - std::exp(-t * t)) * inv) / all;
}

template <class T>
void expect_slopes_invert(double tolerance) {
  for (double log_cot = -12; log_cot <= 8; log_cot += 0.25) {
    const double theta = log_cot == 8 ? 0 : log_cot == -12 ? kPi / 2 : std::atan(std::exp(-log_cot));
    const T c = std::max(static_cast<T>(std::cos(theta)), T(0)), s = static_cast<T>(std::sin(theta));
    T before = -100;
    for (int i = 0; i <= 2000; ++i) {
      const double steps = std::is_same_v<T, float> ? 0x1p24 : 0x1p53;
      const double spread = i < 20 ? std::exp2(i - 25) : i > 1980 ? 1 - std::exp2(1975 - i) : i / 2000.0;
      const T u = static_cast<T>(std::max(std::floor(spread * steps), 0.5) / steps);
      const T t = beckmann::visible_slope(c, s, u);
      ASSERT_NEAR(visible_share(c, s, t), u, tolerance) << log_cot << ' ' << u;
      // Points that are stratified in u stay so in the slopes.
      if (i % 100 == 0) {
        ASSERT_GE(t, before) << log_cot << ' ' << u;
        before = t;
      }
    }
  }
}

TEST(Beckmann, VisibleSlopesInvertTheirDistribution) {
  expect_slopes_invert<double>(1e-14);
  expect_slopes_invert<float>(5e-7);
}

template <class T>
void expect_gaussian(double tolerance) {
  for (int i = 0; i <= 10'000; ++i) {
    const double u = i == 0        ? beckmann::kLeastNumber<T>
                     : i == 10'000 ? 1 - std::numeric_limits<T>::epsilon() / 2
                                   : i / 1e4;
    const T rounded = static_cast<T>(u);
    ASSERT_NEAR(0.5 * std::erfc(-static_cast<double>(beckmann::gaussian_slope(rounded))), rounded, tolerance) << u;
  }
}

TEST(Beckmann, GaussianSlopesInvertTheirDistribution) {
  expect_gaussian<double>(1e-13);
  expect_gaussian<float>(2e-7);
}

/// Nori's microfacet test (W. Jakob, scenes/pa5/tests/ttest-microfacet.xml): k_d/π + k_s D F G/(4 cos θ_i cos θ_o) with
/// Beckmann's D, α = 0.1, Walter's rational G₁ each way, k_d = (0.1, 0.2, 0.15), k_s = 0.8, indices 1.000277 and 1.5;
/// the luminance of the directional albedo, by quadrature elsewhere.
TEST(Beckmann, NorisMicrofacetAlbedo) {
  const double alpha = 0.1;
  const auto g1 = [&](double cosine) {
    const double tangent = std::sqrt((1 - cosine) * (1 + cosine)) / cosine, b = 1 / (alpha * tangent);
    return tangent == 0 || b >= 1.6 ? 1.0 : (3.535 * b + 2.181 * b * b) / (1 + 2.276 * b + 2.577 * b * b);
  };
  const struct {
    double degrees, value;
  } cases[] = {{80, 0.430823671525207}, {85, 0.5190059390964016}, {60, 0.247774409195964}};
  const double index = 1.5 / 1.000277, diffuse = 0.2126 * 0.1 + 0.7152 * 0.2 + 0.0722 * 0.15;
  for (const auto& c : cases) {
    const double theta = c.degrees * kPi / 180;
    const Vec<double> wo{std::sin(theta), 0, std::cos(theta)};
    // Over microfacets m in slopes, dω_i = 4 (w_o·m) dω_m.
    const int n = 3000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double r = 8 * (i + 0.5) / n;
      for (int j = 0; j < n / 4; ++j) {
        const double phi = kPi * (j + 0.5) / (n / 4);
        const Vec<double> m = normalise(Vec<double>{alpha * r * std::cos(phi), alpha * r * std::sin(phi), 1});
        const double facing = dot(wo, m);
        const Vec<double> wi = mirror(wo, m);
        if (facing <= 0 || wi.z <= 0) continue;
        sum += beckmann_d(alpha, alpha, m) * fresnel_dielectric(facing, index).reflected * g1(wo.z) * g1(wi.z) *
               facing / wo.z * std::pow(m.z, 3) * r;
      }
    }
    const double coat = 0.8 * sum * 2 * alpha * alpha * (8.0 / n) * (kPi / (n / 4));
    EXPECT_NEAR(diffuse + coat, c.value, 2e-5) << c.degrees;
  }
}

}  // namespace
}  // namespace halfslope
