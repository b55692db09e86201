// Directional albedos: by sampling, and by quadratures that know nothing of how samples are drawn.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/gauss_legendre.h"
#include "scenes/rough_transmittance.h"
#include "tests/scenes/bsdf_charts.h"
#include "tests/scenes/bsdf_materials.h"

namespace halfslope {
namespace {

/// ∫ f cos θ_i dω_i on w_o's side: Gauss's rule along a, whose nodes crowd at the horizon, equal steps around.
double by_quadrature(const AnyBsdf<double>& bsdf, double scale, const Vec<double>& wo) {
  constexpr int kTurns = 160;
  static const auto kNodes = gauss_legendre<64>();
  const ReflectionChart chart(scale, wo);
  double sum = 0;
  for (const auto& node : kNodes) {
    for (int j = 0; j < kTurns; ++j) {
      const ChartPoint p = chart.point(node.x, (j + 0.5) / kTurns);
      if (p.solid_angle > 0) sum += node.weight * bsdf.evaluate(wo, p.wi).cosine_bsdf[0] * p.solid_angle;
    }
  }
  return sum / kTurns;
}

struct Estimate {
  double mean, standard_error;
};
Estimate by_sampling(const AnyBsdf<double>& bsdf, const Vec<double>& wo, int count) {
  Uniform<double> uniform(3);
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double u_lobe = uniform(), u1 = uniform(), u2 = uniform();
    const BsdfSample<double, 1> s = bsdf.sample(wo, u_lobe, u1, u2);
    if ((s.wi.z > 0) != (wo.z > 0)) continue;
    sum += s.weight[0];
    squares += s.weight[0] * s.weight[0];
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

/// A gold-like conductor and a plastic with coat and ground, each way of looking from steep to grazing. 5 standard
/// errors are passed by chance with probability 6e-7; and an outcome of probability 14/n, such as a rare loss below the
/// horizon, is missed by n samples with probability 1e-6.
TEST(BsdfEnergy, SamplingAndQuadratureAgree) {
  constexpr int kSamples = 60'000;
  for (NamedBsdf named : rough_bsdfs({0.005, 0.1, 0.5, 1})) {
    named.bsdf.unit_fresnel = false;
    named.bsdf.eta = Rgb::Constant(0.143);
    named.bsdf.k = Rgb::Constant(3.98);
    named.bsdf.reflectance = Rgb::Constant(named.bsdf.kind == BsdfKind::kRoughConductor ? 1.0 : 0.4);
    const auto bsdf = bsdf_of<double>(named.bsdf);
    for (const double cosine : {1.0, 0.5, 0.1}) {
      const Vec<double> wo = at_cosine(cosine);
      const Estimate sampled = by_sampling(*bsdf, wo, kSamples);
      const double integrated = by_quadrature(*bsdf, named.bsdf.alpha, wo);
      EXPECT_NEAR(sampled.mean, integrated, 5 * sampled.standard_error + 14.0 / kSamples + 2e-5)
          << named << ' ' << cosine;
    }
  }
}

/// GGX of roughness 1 with F = 1 has f = 1/(2π (c_i + c_o)), so the albedo 1 − c ln((1 + c)/c).
TEST(BsdfEnergy, RoughestMirrorInClosedForm) {
  const auto bsdf = bsdf_of<double>(rough(BsdfKind::kRoughConductor, Distribution::kGgx, 1));
  for (const double c : {1.0, 0.5, 0.1, 0.01}) {
    EXPECT_NEAR(by_quadrature(*bsdf, 1, at_cosine(c)), 1 - c * std::log((1 + c) / c), 5e-5) << c;
    const Estimate sampled = by_sampling(*bsdf, at_cosine(c), 100'000);
    EXPECT_NEAR(sampled.mean, 1 - c * std::log((1 + c) / c), 5 * sampled.standard_error) << c;
  }
}

TEST(BsdfEnergy, ACoatLetsThroughWhatItDoesNotReflect) {
  for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
    for (const double alpha : {0.01, 0.1, 0.4, 1.0}) {
      for (const double ior : {1.1, 1.5, 2.2}) {
        Bsdf coat = rough(BsdfKind::kRoughPlastic, distribution, alpha);
        coat.ior = ior;
        coat.reflectance = Rgb::Zero();
        const auto bsdf = bsdf_of<double>(coat);
        const MaterialData<double> data = material_data<double>(coat);
        const RoughTransmittance<double> transmittance(UniformMaterial<double>{data});
        for (const double c : {1.0, 0.6, 0.2, 0.05}) {
          const double reflected = by_quadrature(*bsdf, alpha, at_cosine(c));
          EXPECT_NEAR(rough_reflectance(distribution, alpha, ior, c), reflected, 5e-5)
              << alpha << ' ' << ior << ' ' << c;
          EXPECT_NEAR(transmittance(c), 1 - reflected, 1e-4) << alpha << ' ' << ior << ' ' << c;
        }
      }
    }
  }
}

/// Of a smooth surface under diffuse light from the less dense side (J. W. T. Walsh, 1926; R. V. Dunkle, 1963).
double walsh(double n) {
  const double n2 = n * n, n4 = n2 * n2, sum = n2 + 1, difference = n4 - 1;
  return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * std::pow(n2 - 1, 2) / std::pow(sum, 3) * std::log((n - 1) / (n + 1)) -
         2 * n * n2 * (n2 + 2 * n - 1) / (sum * difference) +
         8 * n4 * (n4 + 1) / (sum * difference * difference) * std::log(n);
}

TEST(BsdfEnergy, ARoughCoatTendsToTheSmoothOne) {
  // Smooth: R_i = 1 − (1 − R_e)/n², and F itself for each direction.
  const double n = 1.5;
  for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
    for (const double c : {1.0, 0.5, 0.1}) {
      EXPECT_NEAR(rough_reflectance(distribution, 1e-4, n, c), fresnel_dielectric(c, n).reflected, 1e-4) << c;
    }
    const double external = rough_diffuse_reflectance(distribution, 1e-4, n);
    EXPECT_NEAR(external, walsh(n), 1e-5);
    EXPECT_NEAR(rough_diffuse_reflectance(distribution, 1e-4, 1 / n), 1 - (1 - external) / (n * n), 1e-4);
  }
}

TEST(BsdfEnergy, ACoatLessDenseThanItsOutsideIsRefused) {
  Bsdf bsdf = rough(BsdfKind::kRoughPlastic, Distribution::kGgx, 0.1);
  bsdf.ior = 0.9;
  EXPECT_THROW(material_data<float>(bsdf), std::runtime_error);
}

/// Neighbours of the smooth dielectric's F: a rough one reflects and lets through the shares that its microfacets do.
TEST(BsdfEnergy, ARoughDielectricReflectsWhatARoughCoatDoes) {
  for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
    for (const double alpha : {0.05, 0.5}) {
      const Bsdf glass = rough(BsdfKind::kRoughDielectric, distribution, alpha);
      const auto bsdf = bsdf_of<double>(glass);
      for (const double c : {0.9, 0.3}) {
        const Estimate above = by_sampling(*bsdf, at_cosine(c), 50'000);
        EXPECT_NEAR(above.mean, rough_reflectance(distribution, alpha, 1.5, c), 5 * above.standard_error);
        const Estimate below = by_sampling(*bsdf, at_cosine(-c), 50'000);
        EXPECT_NEAR(below.mean, rough_reflectance(distribution, alpha, 1 / 1.5, c), 5 * below.standard_error + 1e-3);
      }
    }
  }
}

}  // namespace
}  // namespace halfslope
