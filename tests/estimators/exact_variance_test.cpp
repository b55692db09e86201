// Two problems of one dimension whose estimators have exact variances: the estimates of one pair must have them.
//
// With one sample of each technique a pair's estimate is A(u₁) + B(u₂), independent, so its central moments are
// m₂ = a₂ + b₂ and m₄ = a₄ + b₄ + 6 a₂ b₂. m₄ says how far a sample variance of n pairs strays from σ²: its standard
// error is σ² √((κ − 1)/n), κ = m₄/σ⁴.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "scenes/integrand.h"
#include "tests/estimators/estimates.h"

namespace halfslope {
namespace {

constexpr int kPairs = 1 << 20;
constexpr int kGrid = 1 << 17;  // midpoints of every quadrature

/// Central moments of a random variable.
struct Spread {
  double mean = 0, m2 = 0, m4 = 0;
};

Spread operator+(const Spread& a, const Spread& b) {
  return {a.mean + b.mean, a.m2 + b.m2, a.m4 + b.m4 + 6 * a.m2 * b.m2};
}

/// Of a quantity as a function of a uniform number; `jumps` are where it is not smooth, if they lie in (0, 1).
Spread spread_of(const std::function<double(double)>& of_u, std::vector<double> jumps = {}) {
  std::erase_if(jumps, [](double u) { return !(u > 0 && u < 1); });
  jumps.insert(jumps.end(), {0, 1});
  std::sort(jumps.begin(), jumps.end());
  Spread spread;
  const auto each = [&](const auto& add) {
    for (std::size_t piece = 0; piece + 1 < jumps.size(); ++piece) {
      const double step = (jumps[piece + 1] - jumps[piece]) / kGrid;
      for (int i = 0; i < kGrid; ++i) add(of_u(jumps[piece] + (i + 0.5) * step), step);
    }
  };
  each([&](double v, double step) { spread.mean += v * step; });
  each([&](double v, double step) {
    const double d2 = (v - spread.mean) * (v - spread.mean);
    spread.m2 += d2 * step;
    spread.m4 += d2 * d2 * step;
  });
  return spread;
}

/// A heuristic's weight of `light` beside `bsdf`, by its definition, as a function of r = p_bsdf/p_light.
struct LightWeight {
  std::function<double(double)> of_ratio;
  std::vector<double> jumps;  ///< ratios where it jumps
};

LightWeight power_weight(double beta) {
  return {[beta](double r) { return 1 / (1 + std::pow(r, beta)); }, {}};
}
LightWeight cutoff_weight(double alpha) {
  const auto weight = [alpha](double r) {
    const double largest = std::max(r, 1.0), light = 1 >= alpha * largest ? 1 : 0, bsdf = r >= alpha * largest ? r : 0;
    return light / (light + bsdf);
  };
  return {weight, {alpha, 1 / alpha}};
}
LightWeight maximum_weight() {
  return {[](double r) { return r <= 1 ? 1 : 0; }, {1}};
}

/// Estimates from one pair (or one sample) each.
std::vector<double> one_pair_estimates(const IntegralSource& scene, const std::string& estimator) {
  return estimate<double>(scene, 0, {.estimator = estimator, .rounds = 1, .replicates = kPairs, .seed = 2024})[0];
}

struct Published {
  std::string estimator;
  double variance;
};

/// `shape`: the moments by quadrature here, of which m₂ must be the published variance as well. 6 standard errors are
/// passed by chance with probability 2e-9 for a normal deviate; the skewness of these sums, at most √(κ/n) = 0.03 where
/// the variance is tested, makes that 1e-8 at most.
void expect_variance(const IntegralSource& scene, const Published& published, const Spread& shape) {
  const std::vector<double> estimates = one_pair_estimates(scene, published.estimator);
  const MeanAndError found = mean_of(estimates);
  const double exact = (*scene.closed_form(0))[0], variance = published.variance;
  const std::string what = scene.fingerprint() + ' ' + published.estimator;
  EXPECT_LE(std::fabs(found.mean - exact), 6 * std::sqrt(variance / kPairs) + 1e-14 * exact) << what;
  if (variance < 1e-12 * exact * exact) return;  // rounding has the say
  EXPECT_NEAR(shape.mean / exact, 1, 1e-4) << what;
  EXPECT_NEAR(shape.m2 / variance, 1, 1e-3) << what;
  const double kurtosis = shape.m4 / (variance * variance);
  if (kurtosis > 1e3) return;  // too heavy a tail for this many pairs
  const double sample_variance = found.standard_error * found.standard_error * kPairs;
  EXPECT_LE(std::fabs(sample_variance / variance - 1), 6 * std::sqrt((kurtosis - 1) / kPairs) + 1e-12)
      << what << ": " << sample_variance << " is not " << variance;
}

TEST(ExactVariance, ToyProblem) {
  const auto scene = make_analytic_scene("mis-toy");
  // p₁ = 1, p₂ = 2x and f = x.
  const auto combined = [](const LightWeight& weight) {
    std::vector<double> of_light, of_bsdf;  // u where 2x is a ratio of the weight's jumps, for x = u and x = √u
    for (const double r : weight.jumps) of_light.push_back(r / 2), of_bsdf.push_back(r * r / 4);
    return spread_of([&](double u) { return weight.of_ratio(2 * u) * u; }, of_light) +
           spread_of([&](double u) { return (1 - weight.of_ratio(2 * std::sqrt(u))) / 2; }, of_bsdf);
  };
  expect_variance(*scene, {"light", 1.0 / 12}, spread_of([](double u) { return u; }));
  expect_variance(*scene, {"bsdf", 0}, {});
  expect_variance(*scene, {"average", 1.0 / 48}, spread_of([](double u) { return u / 2 + 0.25; }));
  expect_variance(*scene, {"balance", 0.011110988148968387}, combined(power_weight(1)));
  expect_variance(*scene, {"power:1", 0.011110988148968387}, combined(power_weight(1)));
  expect_variance(*scene, {"power", 0.013250220050248314}, combined(power_weight(2)));
  expect_variance(*scene, {"power:3", 0.020228413431753918}, combined(power_weight(3)));
  expect_variance(*scene, {"power:4", 0.027833444461787576}, combined(power_weight(4)));
  expect_variance(*scene, {"cutoff", 0.011121517198756346}, combined(cutoff_weight(0.1)));
  expect_variance(*scene, {"cutoff:0.1", 0.011121517198756346}, combined(cutoff_weight(0.1)));
  expect_variance(*scene, {"cutoff:0.5", 0.013146226126042774}, combined(cutoff_weight(0.5)));
  expect_variance(*scene, {"cutoff:0.8", 0.052308892485402825}, combined(cutoff_weight(0.8)));
  expect_variance(*scene, {"maximum", 7.0 / 96}, combined(maximum_weight()));
  // ln 3 / 8 − (1/2 − ln 3 / 4)² − (ln 3 / 4)²
  const double q = std::log(3.0) / 4;
  EXPECT_NEAR(combined(power_weight(1)).m2, q / 2 - (0.5 - q) * (0.5 - q) - q * q, 1e-9);
}

struct Cap {
  const char* scene;
  double n, alpha, light, bsdf, average, balance, power, cutoff1, cutoff5, cutoff8, maximum;
};

void PrintTo(const Cap& cap, std::ostream* out) { *out << cap.scene; }

class AlignedPhongCap : public testing::TestWithParam<Cap> {};

TEST_P(AlignedPhongCap, HasItsExactVariances) {
  const Cap& cap = GetParam();
  const auto scene = make_analytic_scene(cap.scene);
  const double n = cap.n, half = std::sin(cap.alpha / 2), v_max = 2 * half * half;  // v = 1 − cos θ
  const long double mu_exactly = 1 - std::pow(std::cos(static_cast<long double>(cap.alpha)), cap.n + 1);
  ASSERT_NEAR((*scene->closed_form(0))[0] / static_cast<double>(mu_exactly), 1, 1e-14);
  const double p_light = 1 / (2 * std::numbers::pi * v_max);
  const auto p_bsdf = [n](double v) { return (n + 1) / (2 * std::numbers::pi) * std::pow(1 - v, n); };
  // Without weights, the value of a light sample is p_bsdf/p_light, of a BSDF sample 1 in the cone.
  const double mu = -std::expm1((n + 1) * std::log1p(-v_max));  // the part of the BSDF's samples that meets the cone
  const auto combined = [&](const LightWeight& weight) {
    const auto light_weight = [&](double v) { return weight.of_ratio(p_bsdf(v) / p_light); };
    std::vector<double> of_light, of_bsdf = {mu};
    for (const double r : weight.jumps) {  // at v
      const double v = -std::expm1(std::log(r * p_light * 2 * std::numbers::pi / (n + 1)) / n);
      of_light.push_back(v / v_max);
      if (v < v_max) of_bsdf.push_back(-std::expm1((n + 1) * std::log1p(-v)));
    }
    const auto light = [&](double u) { return light_weight(u * v_max) * p_bsdf(u * v_max) / p_light; };
    const auto bsdf = [&](double u) { return u < mu ? 1 - light_weight(-std::expm1(std::log1p(-u) / (n + 1))) : 0.0; };
    return spread_of(light, of_light) + spread_of(bsdf, of_bsdf);
  };
  const Spread bernoulli = {mu, mu * (1 - mu), mu * (1 - mu) * (1 - 3 * mu * (1 - mu))};
  const Spread light = spread_of([&](double u) { return p_bsdf(u * v_max) / p_light; });
  expect_variance(*scene, {"light", cap.light}, light);
  expect_variance(*scene, {"bsdf", cap.bsdf}, bernoulli);
  const Spread sum = light + bernoulli;
  expect_variance(*scene, {"average", cap.average}, {sum.mean / 2, sum.m2 / 4, sum.m4 / 16});
  expect_variance(*scene, {"balance", cap.balance}, combined(power_weight(1)));
  expect_variance(*scene, {"power", cap.power}, combined(power_weight(2)));
  expect_variance(*scene, {"cutoff:0.1", cap.cutoff1}, combined(cutoff_weight(0.1)));
  expect_variance(*scene, {"cutoff:0.5", cap.cutoff5}, combined(cutoff_weight(0.5)));
  expect_variance(*scene, {"cutoff:0.8", cap.cutoff8}, combined(cutoff_weight(0.8)));
  expect_variance(*scene, {"maximum", cap.maximum}, combined(maximum_weight()));
}

INSTANTIATE_TEST_SUITE_P(
    NAndAlpha, AlignedPhongCap,
    testing::Values(Cap{"aligned-phong-cap:n=10,alpha=0.05", 10, 0.05, 2.432200069450513e-09, 0.013474917125694241,
                        0.0033687298894735777, 2.449997212925192e-06, 2.8987465303088264e-09, 2.432200069450513e-09,
                        2.432200069450513e-09, 2.432200069450513e-09, 2.432200069450513e-09},
                    Cap{"aligned-phong-cap:n=1,alpha=0.2", 1, 0.2, 5.2626707917433225e-08, 0.03791166133160433,
                        0.00947792848957806, 5.471065213688093e-05, 1.4388930249531274e-07, 5.2626707917433225e-08,
                        5.2626707917433225e-08, 5.2626707917433225e-08, 5.2626707917433225e-08},
                    Cap{"aligned-phong-cap:n=10000,alpha=0.01", 10000, 0.01, 0.0032126942860631756, 0.23865875551893376,
                        0.06046786245124924, 0.020615636319222422, 0.006386093641269864, 0.020615636319222422,
                        0.003221461715283858, 0.0032126942860631756, 0.0032126942860631756},
                    Cap{"aligned-phong-cap:n=100,alpha=0.01", 100, 0.01, 5.286618602175076e-11, 0.005011978997817704,
                        0.0012529947626709723, 1.2595956331612667e-07, 5.608519103978012e-11, 5.286618602175076e-11,
                        5.286618602175076e-11, 5.286618602175076e-11, 5.286618602175076e-11},
                    Cap{"aligned-phong-cap:n=10,alpha=0.01", 10, 0.01, 6.2990381283560985e-15, 0.0005495555958422792,
                        0.00013738889896214456, 1.6597842493415332e-10, 6.349262517832386e-15, 6.2990381283560985e-15,
                        6.2990381283560985e-15, 6.2990381283560985e-15, 6.2990381283560985e-15},
                    Cap{"aligned-phong-cap:n=1000,alpha=0.8", 1000, 0.8, 150.87415318712192, 0, 37.71853829678048,
                        0.01809049328521886, 0.004158578612201627, 0.007772941677858861, 0.004287700901583644,
                        0.004376874944801758, 0.0048919738343417086},
                    Cap{"aligned-phong-cap:n=10000,alpha=0.8", 10000, 0.8, 1515.6939270231392, 0, 378.9234817557848,
                        0.0026284731899244556, 0.00042291265907067207, 0.0007919675082120872, 0.0004339230833248504,
                        0.0004422311368571039, 0.000493916216484684},
                    Cap{"aligned-phong-cap:n=100,alpha=0.8", 100, 0.8, 14.392511731092368, 1.4062070720451987e-16,
                        3.598127932773092, 0.08661737120830017, 0.035895228585606405, 0.06528121109070967,
                        0.0388499081737648, 0.040328610419249185, 0.04540814037008391},
                    Cap{"aligned-phong-cap:n=10,alpha=0.2", 10, 0.2, 0.00013319842862834685, 0.15920026579312924,
                        0.0398333660554394, 0.004471128435898644, 0.00034253916867763197, 0.004471128435898644,
                        0.00013319842862834685, 0.00013319842862834685, 0.00013319842862834685},
                    Cap{"aligned-phong-cap:n=10000,alpha=0.2", 10000, 0.2, 98.68206110956625, 0, 24.670515277391562,
                        0.02516798192969775, 0.006321313862650276, 0.011782112287104043, 0.006537205498049859,
                        0.006681350145779071, 0.007470168631489288}));

/// Of estimators whose variance is that of many rounds, or of single samples.
struct ManyRounds {
  const char* scene;
  double optimal, one_sample_balance, one_sample_power;  ///< of a pair, of a sample, of a sample
};

// 1024 pairs a replicate, so that estimates are near normal (κ < 5 for all of these, mostly 3) and `optimal` is near
// its limit, which it misses by a few thousandths. A sample variance of R of them strays by 6 standard errors, √((κ −
// 1)/R) each, with probability 2e-9.
void expect_variances_of_many(const ManyRounds& known, int replicates, double tolerance) {
  const auto scene = make_analytic_scene(known.scene);
  const double exact = (*scene->closed_form(0))[0];
  const auto expect = [&](const std::string& estimator, std::uint64_t rounds, double variance) {
    if (variance < 0) return;  // not known
    const auto found = mean_of(estimate<double>(
        *scene, 0, {.estimator = estimator, .rounds = rounds, .replicates = replicates, .seed = 77})[0]);
    const double measured = found.standard_error * found.standard_error * replicates * static_cast<double>(rounds);
    if (variance < 1e-12 * exact * exact && variance < 1e-15) {
      EXPECT_LT(measured, 1e-15) << known.scene << ' ' << estimator;
    } else {
      EXPECT_NEAR(measured / variance, 1, tolerance) << known.scene << ' ' << estimator;
    }
  };
  expect("optimal", 1024, known.optimal);
  expect("one-sample-balance", 1024, known.one_sample_balance);
  expect("one-sample-power", 1024, known.one_sample_power);
}

const ManyRounds kManyRounds[] = {
    {"mis-toy", 0, 0.02465307216702742, -1},
    {"aligned-phong-cap:n=10,alpha=0.05", 2.3994198006957428e-09, 0.00018161195674077534, 0.00018650459987619192},
    {"aligned-phong-cap:n=1,alpha=0.2", 5.062842829185431e-08, 0.0014396303483194537, 0.0015484511621609717},
    {"aligned-phong-cap:n=10000,alpha=0.01", 0.002283754795031826, 0.06975855154192127, 0.09304825028748535},
    {"aligned-phong-cap:n=100,alpha=0.01", 5.260121443097872e-11, 2.5120675057910863e-05, 2.5372471376613944e-05},
    {"aligned-phong-cap:n=10,alpha=0.01", 6.295576455579766e-15, 3.020114568101539e-07, 3.0234340078851757e-07},
    {"aligned-phong-cap:n=1000,alpha=0.8", 0, 0.962405680576658, 0.9878677824598142},
    {"aligned-phong-cap:n=10000,alpha=0.8", 0, 0.994715123702673, 0.9987773379157294},
    {"aligned-phong-cap:n=100,alpha=0.8", 1.4062070720452e-16, 0.7770654391716872, 0.8855087508516521},
    {"aligned-phong-cap:n=10,alpha=0.2", 0.00011104759104094028, 0.02654079267877529, 0.034336426879201125},
    {"aligned-phong-cap:n=10000,alpha=0.2", 0, 0.9468378186105161, 0.9814856706692482},
};

TEST(ExactVariance, OfOptimalWeightsAndSingleSamples) {
  for (const ManyRounds& known : kManyRounds) expect_variances_of_many(known, 1 << 11, 6 * std::sqrt(4.0 / (1 << 11)));
}

// √(2/R) is 0.5 % here, and 0.03 more than 5 of them.
TEST(LongExactVariance, OfOptimalWeightsAndSingleSamplesWithinThreePercent) {
  for (const ManyRounds& known : kManyRounds) expect_variances_of_many(known, 1 << 16, 0.03);
}

}  // namespace
}  // namespace halfslope
