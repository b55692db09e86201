// Predicted cumulants against closed forms and sums over grids, and what they promise of sample variances.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "analysis/run_random.h"
#include "analysis/sample_variance.h"
#include "estimators/exact_variance.h"
#include "scenes/integrand.h"

namespace halfslope {
namespace {

Cumulants predicted(const std::string& scene, const std::string& estimator) {
  const auto source = make_analytic_scene(scene);
  return exact_round_cumulants(parse_estimator(estimator, source->techniques()), *source->exact_densities()).value();
}

/// Of a function of a uniform number, by midpoints.
Cumulants of_uniform(const std::function<double(double)>& of_u) {
  constexpr int kGrid = 1 << 16;
  double mean = 0;
  for (int i = 0; i < kGrid; ++i) mean += of_u((i + 0.5) / kGrid) / kGrid;
  std::array<double, 9> moments = {};
  for (int i = 0; i < kGrid; ++i) {
    const double d = of_u((i + 0.5) / kGrid) - mean;
    double power = 1;
    for (double& moment : moments) {
      moment += power / kGrid;
      power *= d;
    }
  }
  return cumulants_from_central_moments(mean, moments);
}

void expect_cumulants(const Cumulants& found, const Cumulants& expected, double tolerance, const std::string& what) {
  const double sigma = std::sqrt(expected[2]);
  EXPECT_NEAR(found[1], expected[1], tolerance * sigma) << what;
  for (std::size_t j = 2; j <= 8; ++j) {
    const double unit = std::pow(sigma, static_cast<double>(j));
    EXPECT_NEAR(found[j] / unit, expected[j] / unit, tolerance * (1 + std::fabs(expected[j] / unit)))
        << what << ' ' << j;
  }
}

// `light` of the toy problem is a uniform number: κ_n = B_n / n.
TEST(ExactRoundCumulants, OfUniformNumbers) {
  Cumulants uniform;
  uniform.orders = {0, 0.5, 1.0 / 12, 0, -1.0 / 120, 0, 1.0 / 252, 0, -1.0 / 240};
  expect_cumulants(predicted("mis-toy", "light"), uniform, 1e-6, "light");
  // `bsdf` is always 1/2.
  Cumulants average;
  average.add(uniform, 1, 0.5);
  average.orders[1] = 0.5;
  expect_cumulants(predicted("mis-toy", "average"), average, 1e-6, "average");
  // Four numbers, an eighth of each.
  Cumulants four;
  four.add(uniform, 4, 0.125);
  four.orders[1] = 0.5;
  expect_cumulants(predicted("mis-toy", "average@light*4+bsdf"), four, 1e-6, "average@light*4+bsdf");
  // One of the two: half of the time 1/2, which halves all central moments.
  const Cumulants one_sample = predicted("mis-toy", "one-sample-average");
  EXPECT_NEAR(one_sample[2], 1.0 / 24, 1e-9);
  EXPECT_NEAR(one_sample[4], 1.0 / 160 - 3.0 / 576, 1e-8);
}

// `bsdf` of the cap is 1 where it meets the light, with the probability that is also the integral.
TEST(ExactRoundCumulants, OfTwoValuedNumbers) {
  const double p = 1 - std::pow(std::cos(0.05), 101), q = 1 - p;
  const Cumulants found = predicted("aligned-phong-cap:n=100,alpha=0.05", "bsdf");
  EXPECT_NEAR(found[1], p, 1e-9);
  EXPECT_NEAR(found[2] / (p * q), 1, 1e-9);
  EXPECT_NEAR(found.skewness(), (q - p) / std::sqrt(p * q), 1e-5);
  EXPECT_NEAR(found.kurtosis(), 3 + (1 - 6 * p * q) / (p * q), 1e-5);
}

TEST(ExactRoundCumulants, OfCombinedTechniques) {
  // The toy problem: weights 1/(1 + 2x) and 2x/(1 + 2x), x = u and x = √u.
  Cumulants balance = of_uniform([](double u) { return u / (1 + 2 * u); });
  balance.add(of_uniform([](double u) { return std::sqrt(u) / (1 + 2 * std::sqrt(u)); }), 1);
  expect_cumulants(predicted("mis-toy", "balance"), balance, 1e-4, "balance");
  // One sample of density (1 + 2x)/2, so x = (√(1 + 8u) − 1)/2, worth 2x/(1 + 2x).
  const Cumulants one = of_uniform([](double u) {
    const double root = std::sqrt(1 + 8 * u);
    return (root - 1) / root;
  });
  expect_cumulants(predicted("mis-toy", "one-sample-balance"), one, 1e-4, "one-sample-balance");
}

// With n = 1 and half-angle 0.8, v uniform on [0, V] or of density 2 (1 − v) on [0, 1], f = 2 (1 − v) on [0, V].
TEST(ExactRoundCumulants, OfOptimalWeights) {
  const double most = 1 - std::cos(0.8);
  const auto light = [&](double v) { return v <= most ? 1 / most : 0; };
  const auto bsdf = [](double v) { return 2 * (1 - v); };
  const auto f = [&](double v) { return v <= most ? bsdf(v) : 0; };
  const auto mixture = [&](double v) { return light(v) + bsdf(v); };
  double a11 = 0, a12 = 0, a22 = 0, b1 = 0, b2 = 0;
  constexpr int kGrid = 1 << 16;
  const auto add = [&](double v, double width) {
    const double c = mixture(v);
    a11 += light(v) * light(v) / c * width, a12 += light(v) * bsdf(v) / c * width;
    a22 += bsdf(v) * bsdf(v) / c * width;
    b1 += f(v) * light(v) / c * width, b2 += f(v) * bsdf(v) / c * width;
  };
  for (int i = 0; i < kGrid; ++i) {
    add(most * (i + 0.5) / kGrid, most / kGrid);
    add(most + (1 - most) * (i + 0.5) / kGrid, (1 - most) / kGrid);
  }
  const double determinant = a11 * a22 - a12 * a12;
  const double alpha1 = (b1 * a22 - b2 * a12) / determinant, alpha2 = (a11 * b2 - a12 * b1) / determinant;
  const auto worth = [&](double v) { return (f(v) - alpha1 * light(v) - alpha2 * bsdf(v)) / mixture(v); };
  Cumulants expected = of_uniform([&](double u) { return worth(most * u); });
  expected.add(of_uniform([&](double u) { return worth(1 - std::sqrt(1 - u)); }), 1);
  expected.orders[1] = alpha1 + alpha2;
  EXPECT_NEAR(expected[1], std::sin(0.8) * std::sin(0.8), 1e-6);
  expect_cumulants(predicted("aligned-phong-cap:n=1,alpha=0.8", "optimal"), expected, 2e-3, "optimal");
}

/// A cell of a run: so many rounds, of which every replicate is a mean.
struct Judged {
  std::size_t rounds;
  Interval range;
  double variance;
};

// Draws the contributions of a problem whose samples are worth `draw`, and counts the runs in which any of the cells
// has a sample variance outside its range. Cells are prefixes of one another, as N of an experiment are.
int runs_outside(const Cumulants& round, const std::function<double(RunRandom&)>& draw, int replicates, int runs,
                 double planted, std::size_t most_rounds) {
  std::vector<Judged> cells;
  for (std::size_t rounds = 4; rounds <= most_rounds; rounds *= 2) {
    const Cumulants law = round.of_mean(static_cast<double>(rounds));
    if (has_sample_variance_range(law, replicates)) cells.push_back({rounds, {}, law[2] * planted});
  }
  EXPECT_FALSE(cells.empty());
  const double level = 1 - 0.01 / static_cast<double>(cells.size());
  for (Judged& cell : cells)
    cell.range = sample_variance_range(round.of_mean(static_cast<double>(cell.rounds)), replicates, level);
  int outside = 0;
  for (int run = 0; run < runs; ++run) {
    std::vector<std::vector<double>> values(cells.size());
    RunRandom random(5, static_cast<std::uint64_t>(run), static_cast<std::uint32_t>(replicates));
    for (int r = 0; r < replicates; ++r) {
      double sum = 0;
      std::size_t cell = 0;
      for (std::size_t i = 1; i <= cells.back().rounds; ++i) {
        sum += draw(random);
        if (i == cells[cell].rounds) values[cell++].push_back(sum / static_cast<double>(i));
      }
    }
    bool any = false;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      double mean = 0, squares = 0;
      for (const double value : values[c]) mean += value / replicates;
      for (const double value : values[c]) squares += (value - mean) * (value - mean);
      const double ratio = squares / (replicates - 1) / cells[c].variance;
      any = any || ratio < cells[c].range.lo || ratio > cells[c].range.hi;
    }
    outside += any;
  }
  return outside;
}

// At 1 %, 20 of 2000 runs are wrong; more than 47 with probability 1e-7.
TEST(ExactRoundCumulants, PromiseSampleVariances) {
  const auto toy = [](RunRandom& random) { return random.uniform(); };
  EXPECT_LE(runs_outside(predicted("mis-toy", "light"), toy, 16, 2000, 1, 64), 47);
  // Rare spikes: all the light's cap, of which the lobe fills a 60th.
  const double most = 1 - std::cos(0.8);
  const auto spikes = [&](RunRandom& random) {
    return 201 * most * std::exp(200 * std::log1p(-most * random.uniform()));
  };
  const Cumulants light = predicted("aligned-phong-cap:n=200,alpha=0.8", "light");
  EXPECT_GT(light.kurtosis(), 25);
  EXPECT_LE(runs_outside(light, spikes, 16, 2000, 1, 256), 47);
  EXPECT_LE(runs_outside(light, spikes, 64, 2000, 1, 64), 47);
  // And a variance that is not the predicted one is found: 2.5 times it by 256 replicates, whose variances err by 9 %.
  EXPECT_EQ(runs_outside(predicted("mis-toy", "light"), toy, 256, 20, 2.5, 16), 20);
  EXPECT_EQ(runs_outside(predicted("mis-toy", "light"), toy, 256, 20, 0.4, 16), 20);
}

}  // namespace
}  // namespace halfslope
