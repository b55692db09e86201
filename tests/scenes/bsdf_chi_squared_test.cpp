// Directions from sample() against the density from evaluate(): Pearson's χ² over grids of the charts in
// tests/scenes/bsdf_charts.h, with what is not scattered and the delta lobes as further outcomes. Each comparison has a
// false-alarm probability of 1e-6.
#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/scenes/bsdf_charts.h"
#include "tests/scenes/bsdf_materials.h"

namespace halfslope {
namespace {

struct Grid {
  int a = 12, b = 16;            ///< cells of each chart
  int fine_a = 16, fine_b = 16;  ///< midpoints each way in a cell
  std::size_t cells() const { return static_cast<std::size_t>(a * b); }
};

/// The outcomes: cells of reflection, cells of refraction, delta reflection, delta refraction, nothing.
struct Outcomes {
  std::vector<double> expected, observed;  ///< a probability; a count
};

double textbook_fresnel(double c, double n) {
  const double sine2 = (1 - c * c) / (n * n);
  if (sine2 >= 1) return 1;
  const double t = std::sqrt(1 - sine2), s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
  return (s * s + p * p) / 2;
}

double index_seen(const Bsdf& bsdf, const Vec<double>& wo) { return wo.z > 0 ? bsdf.ior : 1 / bsdf.ior; }

/// Of unit colours, so that a plastic's coat and ground are chosen as F and 1 − F.
void expect_delta(const Bsdf& bsdf, const Vec<double>& wo, double& reflection, double& refraction) {
  const double fresnel = textbook_fresnel(std::fabs(wo.z), index_seen(bsdf, wo));
  reflection = refraction = 0;
  if (bsdf.kind == BsdfKind::kConductor) reflection = 1;
  if (bsdf.kind == BsdfKind::kPlastic || bsdf.kind == BsdfKind::kDielectric) reflection = fresnel;
  if (bsdf.kind == BsdfKind::kDielectric) refraction = 1 - fresnel;
}

double chart_scale(const Bsdf& bsdf) {
  switch (bsdf.kind) {
    case BsdfKind::kPhong:
      return std::sqrt(2 / (bsdf.exponent + 2));
    case BsdfKind::kDiffuse:
    case BsdfKind::kPlastic:
      return 1;
    default:
      return std::sqrt(bsdf.alpha * bsdf.alpha_v.value_or(bsdf.alpha));
  }
}

using Density = std::function<double(const Vec<double>& wi)>;

template <class Chart>
void integrate(const Chart& chart, const Grid& grid, const Density& pdf, double* cells) {
  const int rows = grid.a * grid.fine_a, columns = grid.b * grid.fine_b;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const ChartPoint p = chart.point((i + 0.5) / rows, (j + 0.5) / columns);
      if (p.solid_angle > 0) {
        cells[i / grid.fine_a * grid.b + j / grid.fine_b] += pdf(p.wi) * p.solid_angle / rows / columns;
      }
    }
  }
}

template <class T>
Outcomes outcomes(const Bsdf& data, const AnyBsdf<T>& bsdf, const Vec<double>& wo, int count, const Grid& grid,
                  const Density& pdf) {
  const ReflectionChart reflection(chart_scale(data), wo);
  const RefractionChart refraction(chart_scale(data), index_seen(data, wo), wo);
  const std::size_t delta = 2 * grid.cells();
  Outcomes out{std::vector<double>(delta + 3), std::vector<double>(delta + 3)};
  integrate(reflection, grid, pdf, out.expected.data());
  if (data.kind == BsdfKind::kRoughDielectric) {
    integrate(refraction, {grid.a, grid.b, 2 * grid.fine_a, 2 * grid.fine_b}, pdf, out.expected.data() + grid.cells());
  }
  expect_delta(data, wo, out.expected[delta], out.expected[delta + 1]);
  double rest = 1;
  for (const double p : out.expected) rest -= p;
  out.expected[delta + 2] = std::max(rest, 0.0);

  const Vec<T> o{static_cast<T>(wo.x), static_cast<T>(wo.y), static_cast<T>(wo.z)};
  Uniform<T> uniform(20260101);
  for (int i = 0; i < count; ++i) {
    const T u_lobe = uniform(), u1 = uniform(), u2 = uniform();
    const BsdfSample<T, 1> s = bsdf.sample(o, u_lobe, u1, u2);
    const bool crosses = (s.wi.z > 0) != (wo.z > 0);
    if (s.pdf == 0) {
      ++out.observed[delta + 2];
    } else if (s.delta) {
      ++out.observed[delta + (crosses ? 1 : 0)];
    } else {
      const Vec<double> wi{s.wi.x, s.wi.y, s.wi.z};
      const ChartCoordinates at = crosses ? refraction.coordinates(wi) : reflection.coordinates(wi);
      const int a = std::clamp(static_cast<int>(at.a * grid.a), 0, grid.a - 1);
      const int b = std::clamp(static_cast<int>(at.b * grid.b), 0, grid.b - 1);
      ++out.observed[(crosses ? grid.cells() : 0) + static_cast<std::size_t>(a * grid.b + b)];
    }
  }
  return out;
}

struct Verdict {
  double chi_squared, threshold, total;  ///< threshold: exceeded with probability 1e-6; total: of the expectations
};

/// Outcomes expected fewer than 5 times are taken together, with others until they are expected as often.
Verdict judge(const Outcomes& outcomes, int count) {
  double chi_squared = 0, small_expected = 0, small_observed = 0, total = 0;
  int terms = 0;
  const auto add = [&](double expected, double observed) {
    chi_squared += (observed - expected) * (observed - expected) / expected;
    ++terms;
  };
  for (std::size_t i = 0; i < outcomes.expected.size(); ++i) {
    const double expected = outcomes.expected[i] * count;
    total += outcomes.expected[i];
    if (expected >= 5) {
      add(expected, outcomes.observed[i]);
      continue;
    }
    small_expected += expected;
    small_observed += outcomes.observed[i];
  }
  if (small_expected >= 5) {
    add(small_expected, small_observed);
  } else if (small_observed > 40) {
    chi_squared = std::numeric_limits<double>::infinity();  // a Poisson mean of 5 passes 40 with probability 1e-22
  }
  if (terms < 2) return {chi_squared, 1, total};
  const boost::math::chi_squared law(terms - 1);
  return {chi_squared, quantile(complement(law, 1e-6)), total};
}

template <class T>
void expect_agreement(const NamedBsdf& named, const AnyBsdf<T>& bsdf, const AnyBsdf<double>& exact, double cosine,
                      int count, Grid grid) {
  // At grazing incidence half vectors squeeze a Phong lobe into narrow azimuths.
  if (named.bsdf.kind == BsdfKind::kPhong && cosine < 0.2) grid.fine_b = 160;
  const Vec<double> wo = at_cosine(cosine);
  const auto pdf = [&](const Vec<double>& wi) { return exact.evaluate(wo, wi).pdf; };
  const Verdict verdict = judge(outcomes<T>(named.bsdf, bsdf, wo, count, grid, pdf), count);
  EXPECT_LE(verdict.chi_squared, verdict.threshold) << named << " at " << cosine << " f" << 8 * sizeof(T);
  EXPECT_NEAR(verdict.total, 1, 2e-3) << named << " at " << cosine;  // the density does not integrate to more than 1
}

/// For directions on both sides where both scatter.
void expect_agreement(const NamedBsdf& named, const std::vector<double>& cosines, int count, const Grid& grid = {}) {
  const auto in_double = bsdf_of<double>(named.bsdf);
  const auto in_single = bsdf_of<float>(named.bsdf);
  for (const double cosine : cosines) {
    for (const double side : {cosine, -cosine}) {
      if (side < 0 && !transmits(named.bsdf.kind)) continue;
      expect_agreement(named, *in_double, *in_double, side, count, grid);
    }
  }
  expect_agreement(named, *in_single, *in_double, 0.4, count, grid);
  if (transmits(named.bsdf.kind)) expect_agreement(named, *in_single, *in_double, -0.4, count, grid);
}

class BsdfChiSquared : public testing::TestWithParam<NamedBsdf> {};

TEST_P(BsdfChiSquared, SamplesFollowTheDensity) { expect_agreement(GetParam(), {1.0, 0.6, 0.1, 0.01}, 20'000); }

INSTANTIATE_TEST_SUITE_P(Rough, BsdfChiSquared, testing::ValuesIn(rough_bsdfs({0.001, 0.02, 0.2, 1})));
INSTANTIATE_TEST_SUITE_P(Smooth, BsdfChiSquared, testing::ValuesIn(smooth_bsdfs()));

class BsdfChiSquaredLong : public testing::TestWithParam<NamedBsdf> {};

TEST_P(BsdfChiSquaredLong, SamplesFollowTheDensity) {
  expect_agreement(GetParam(), {1.0, 0.9, 0.6, 0.3, 0.1, 0.05, 0.01}, 200'000, {12, 16, 48, 48});
}

INSTANTIATE_TEST_SUITE_P(LongRough, BsdfChiSquaredLong,
                         testing::ValuesIn(rough_bsdfs({0.001, 0.005, 0.02, 0.05, 0.2, 0.5, 1})));

TEST(BsdfChiSquaredOf, AnisotropicSurfaces) {
  for (const BsdfKind kind : {BsdfKind::kRoughConductor, BsdfKind::kRoughDielectric}) {
    for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
      NamedBsdf named{"anisotropic", rough(kind, distribution, 0.1)};
      named.bsdf.alpha_v = 0.4;
      expect_agreement(named, {0.9, 0.2}, 40'000);
    }
  }
}

/// A density in which one lobe has 1.01 times its share is found, and the right one passes, with the same samples.
TEST(BsdfChiSquaredOf, AWrongLobeShareIsFound) {
  NamedBsdf named{"phong", white(BsdfKind::kPhong)};
  named.bsdf.reflectance = named.bsdf.specular = Rgb::Constant(0.5);
  const Vec<double> wo = at_cosine(0.7);
  const auto right = bsdf_of<double>(named.bsdf);
  constexpr int kCount = 2'000'000;
  for (const double error : {0.0, 0.01}) {
    MaterialData<double> data = material_data<double>(named.bsdf);
    data.specular_share *= 1 + error;
    const auto evaluated = bsdf_of<double>(data);
    const auto pdf = [&](const Vec<double>& wi) { return evaluated->evaluate(wo, wi).pdf; };
    const Verdict verdict = judge(outcomes<double>(named.bsdf, *right, wo, kCount, {6, 8, 48, 48}, pdf), kCount);
    if (error == 0) {
      EXPECT_LE(verdict.chi_squared, verdict.threshold);
    } else {  // expected: 47 degrees of freedom, and 2e6 (0.01² ½ + 0.01² ½) = 200 more
      EXPECT_GT(verdict.chi_squared, 1.5 * verdict.threshold);
    }
  }
}

}  // namespace
}  // namespace halfslope
