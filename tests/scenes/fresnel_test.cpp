#include "scenes/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfslope {
namespace {

/// The textbook's amplitudes, with the transmitted cosine from Snell's law, in long double.
long double textbook(long double c, long double n) {
  const long double sine2 = (1 - c * c) / (n * n);
  if (sine2 >= 1) return 1;
  const long double t = std::sqrt(1 - sine2), s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
  return (s * s + p * p) / 2;
}

TEST(FresnelDielectric, IsTheTextbookFormula) {
  for (const double n : {0.3, 0.7, 0.9, 1.0003, 1.1, 1.5, 2.4, 10.0}) {
    for (const double c : {1.0, 0.9, 0.72, 0.5, 0.1, 1e-3, 1e-9}) {
      const auto exact = static_cast<double>(textbook(c, n));
      const DielectricFresnel<double> found = fresnel_dielectric(c, n);
      EXPECT_NEAR(found.reflected, exact, 1e-14) << n << ' ' << c;
      EXPECT_NEAR(found.transmitted, 1 - exact, 1e-14) << n << ' ' << c;
      const auto single = fresnel_dielectric(static_cast<float>(c), static_cast<float>(n));
      const auto rounded = static_cast<double>(textbook(static_cast<float>(c), static_cast<float>(n)));
      EXPECT_NEAR(single.reflected, rounded, 2e-6) << n << ' ' << c;
      EXPECT_NEAR(single.reflected + single.transmitted, 1, 1e-6) << n << ' ' << c;
    }
  }
}

TEST(FresnelDielectric, KeepsItsDigitsWhereLittleIsReflectedOrLetThrough) {
  for (const double gap : {1e-3, 1e-6, 1e-9}) {  // at normal incidence ((n − 1)/(n + 1))²
    const double n = 1 + gap, exact = std::pow((n - 1) / (n + 1), 2);
    EXPECT_NEAR(fresnel_dielectric(1.0, n).reflected / exact, 1, 1e-14) << gap;
  }
  for (const double c : {1e-6, 1e-12, 1e-200}) {  // at grazing incidence 2c (1 + n²)/g, g → √(n² − 1)
    const double n = 1.5, exact = 2 * c * (1 + n * n) / std::sqrt(n * n - 1);
    EXPECT_NEAR(fresnel_dielectric(c, n).transmitted / exact, 1, 1e-5) << c;
  }
}

TEST(FresnelDielectric, LimitsAreExact) {
  EXPECT_EQ(fresnel_dielectric(0.0, 1.5).reflected, 1);
  EXPECT_EQ(fresnel_dielectric(0.5, 1.0).reflected, 0);
  EXPECT_EQ(fresnel_dielectric(0.5, 1.0).transmitted, 1);
  EXPECT_EQ(fresnel_dielectric(0.0, 1.0).reflected, 0);  // no surface
  EXPECT_EQ(fresnel_dielectric(0.5, 0.7).reflected, 1);  // sin 60° > 0.7
  EXPECT_EQ(fresnel_dielectric(0.5, 0.7).transmitted, 0);
  EXPECT_EQ(fresnel_dielectric(0.0, 0.7).reflected, 1);
  // Brewster's angle, tan θ = n: R_p vanishes, R_s = ((1 − n²)/(1 + n²))².
  EXPECT_NEAR(fresnel_dielectric(1 / std::hypot(1, 1.5), 1.5).reflected, 0.5 * std::pow(1.25 / 3.25, 2), 1e-15);
}

TEST(FresnelDielectric, BothSidesOfASurfaceReflectAlike) {
  for (const double c : {1.0, 0.6, 0.2, 0.01}) {
    const DielectricFresnel<double> in = fresnel_dielectric(c, 1.5);
    EXPECT_NEAR(fresnel_dielectric(in.cos_transmitted, 1 / 1.5).reflected, in.reflected, 1e-13) << c;
    EXPECT_NEAR(in.bend, c / 1.5 - in.cos_transmitted, 1e-15) << c;
    EXPECT_NEAR(in.cos_transmitted, std::sqrt(1 - (1 - c * c) / 2.25), 1e-15) << c;
  }
}

}  // namespace
}  // namespace halfslope
