// What a white BSDF makes of a white world: never more than it gets.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "scenes/fresnel.h"
#include "tests/scenes/bsdf_materials.h"

namespace halfslope {
namespace {

constexpr std::array kCosines = {1.0, 0.7, 0.3, 0.1, 0.01};
const std::vector<double> kAlphas = {0.001, 0.01, 0.1, 0.3, 1};

struct Albedo {
  double mean, standard_error, most;
};

/// Of `count` samples; what crosses the surface counts as energy, radiance times the square of the index.
template <class T>
Albedo albedo(const AnyBsdf<T>& bsdf, const Vec<T>& wo, int count) {
  Uniform<T> uniform(11);
  double sum = 0, squares = 0, most = 0;
  for (int i = 0; i < count; ++i) {
    const T u_lobe = uniform(), u1 = uniform(), u2 = uniform();
    const BsdfSample<T, 1> s = bsdf.sample(wo, u_lobe, u1, u2);
    const double weight = static_cast<double>(s.weight[0]) * static_cast<double>(s.eta) * static_cast<double>(s.eta);
    EXPECT_TRUE(std::isfinite(weight) && weight >= 0 && std::isfinite(s.pdf) && s.pdf >= 0)
        << weight << ' ' << s.pdf << " at " << u_lobe << ", " << u1 << ", " << u2;
    sum += weight;
    squares += weight * weight;
    most = std::max(most, weight);
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count), most};
}

/// Microfacets and smooth surfaces weigh no sample above 1; mixtures do, and are held to 1 by 5 standard errors, passed
/// by chance with probability 3e-7 where the albedo is 1.
template <class T>
void expect_no_gain(const NamedBsdf& named, const AnyBsdf<T>& bsdf, double cosine) {
  const Albedo found = albedo<T>(bsdf, at_cosine<T>(cosine), 8'000);
  const bool mixture = named.bsdf.kind == BsdfKind::kPlastic || named.bsdf.kind == BsdfKind::kRoughPlastic ||
                       named.bsdf.kind == BsdfKind::kPhong;
  const double rounding = std::is_same_v<T, float> ? 2e-6 : 1e-12;
  EXPECT_LE(found.mean, 1 + 5 * found.standard_error + rounding) << named.name << " at " << cosine;
  if (!mixture) {
    EXPECT_LE(found.most, 1 + rounding) << named.name << " at " << cosine;
  }
  EXPECT_GT(found.mean, 0.01) << named.name << " at " << cosine;
}

TEST(BsdfFurnace, NothingIsGained) {
  for (const NamedBsdf& named : all_bsdfs(kAlphas)) {
    const auto in_double = bsdf_of<double>(named.bsdf);
    const auto in_single = bsdf_of<float>(named.bsdf);
    for (const double cosine : kCosines) {
      for (const double side : {cosine, -cosine}) {
        if (side < 0 && !transmits(named.bsdf.kind)) continue;
        expect_no_gain(named, *in_double, side);
        expect_no_gain(named, *in_single, side);
      }
    }
  }
}

TEST(BsdfFurnace, AnisotropyGainsNothing) {
  for (const BsdfKind kind : {BsdfKind::kRoughConductor, BsdfKind::kRoughDielectric}) {
    for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
      Bsdf bsdf = rough(kind, distribution, 0.02);
      bsdf.alpha_v = 0.6;
      const auto in_double = bsdf_of<double>(bsdf);
      for (const double cosine : kCosines) expect_no_gain({"anisotropic", bsdf}, *in_double, cosine);
    }
  }
}

TEST(BsdfFurnace, WhatLosesNothingGivesAllBack) {
  // Smooth, F = 1 or both lobes: exactly 1. A diffuse ground under a smooth coat gives back what the coat lets in.
  for (const double cosine : {1.0, 0.7, 0.3, 0.1, 0.01, -0.01, -0.3, -0.74, -0.76, -1.0}) {
    for (const NamedBsdf& named : smooth_bsdfs()) {
      const auto bsdf = bsdf_of<double>(named.bsdf);
      const bool glass = named.bsdf.kind == BsdfKind::kDielectric;
      if (named.bsdf.kind == BsdfKind::kPhong || (cosine < 0 && !glass)) continue;
      const Albedo found = albedo<double>(*bsdf, at_cosine(cosine), 50'000);
      EXPECT_NEAR(found.mean, 1, 5 * found.standard_error + 1e-6) << named.name << " at " << cosine;
    }
  }
}

TEST(BsdfFurnace, SlightlyRoughIsAlmostSmooth) {
  for (const NamedBsdf& named : rough_bsdfs({0.001})) {
    for (const double cosine : {1.0, 0.7, 0.3}) {
      const Albedo found = albedo<double>(*bsdf_of<double>(named.bsdf), at_cosine(cosine), 50'000);
      EXPECT_NEAR(found.mean, 1, 5 * found.standard_error + 1e-3) << named.name << " at " << cosine;
    }
  }
}

TEST(BsdfFurnace, PlasticIsCoatPlusGround) {
  // R + (1 − R) ρ (1 − R_i) / (1 − ρ R_i): one quadrature of Fresnel's F from below, R_i, by the midpoint rule.
  const double ior = 1.5, rho = 0.6;
  double internal = 0;
  const int n = 200'000;
  for (int i = 0; i < n; ++i) {
    const double c = (i + 0.5) / n;
    internal += 2 * c * fresnel_dielectric(c, 1 / ior).reflected / n;
  }
  for (const bool nonlinear : {false, true}) {
    Bsdf bsdf = white(BsdfKind::kPlastic);
    bsdf.nonlinear = nonlinear;
    bsdf.ior = ior;
    bsdf.reflectance = Rgb::Constant(rho);
    for (const double cosine : {1.0, 0.5, 0.1}) {
      const double reflected = fresnel_dielectric(cosine, ior).reflected;
      const double ground = nonlinear ? rho * (1 - internal) / (1 - rho * internal) : rho;
      const Albedo found = albedo<double>(*bsdf_of<double>(bsdf), at_cosine(cosine), 400'000);
      EXPECT_NEAR(found.mean, reflected + (1 - reflected) * ground, 5 * found.standard_error + 1e-6);
    }
  }
}

}  // namespace
}  // namespace halfslope
