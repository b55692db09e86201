// The optimal weights: what they attain, and what singular systems, few samples and prefixes leave of them.
#include "estimators/optimal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scenes/integrand.h"
#include "tests/estimators/estimates.h"
#include "tests/estimators/scene_builder.h"

namespace halfslope {
namespace {

DirectLighting lit_floor(const Rgb& radiance) {
  const Primitive floor = made_of(rectangle(Vec3::Zero(), 5 * Vec3::UnitX(), 5 * Vec3::UnitY()), diffuse(grey(0.5)));
  return lighting(
      scene_of({floor, emitting(sphere({0, 0, 2}, 1), radiance)}, {looking({0.3, 0.4, 0.5}, Vec3::Zero())}));
}

/// The totals of one round of these samples, in every lane.
std::vector<double> totals_of(const std::vector<std::vector<double>>& weights, const std::vector<double>& y) {
  std::vector<double> totals;
  const auto add = [&](double sum) { totals.insert(totals.end(), kLanes, sum); };
  const std::size_t n = weights.front().size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0;
      for (const auto& w : weights) sum += w[i] * w[j];
      add(sum);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t s = 0; s < y.size(); ++s) sum += y[s] * weights[s][i];
    add(sum);
  }
  return totals;
}

double direct(const std::vector<int>& counts, const std::vector<double>& totals, std::uint64_t rounds) {
  const OptimalSolver solver(counts, 1, OptimalSolver::tolerance(false));
  EXPECT_EQ(totals.size(), solver.sums() * kLanes);
  std::vector<double> out(kLanes);
  solver.direct(totals, rounds, out.data());
  return out[3];
}

TEST(OptimalSolver, SumsTheFit) {
  // y = 2 w₁ + 5 w₂ exactly: α = c β, F = 3 · 2 + 1 · 5.
  const std::vector<std::vector<double>> w = {{0.25, 0.75}, {0.5, 0.5}, {0.9, 0.1}, {1, 0}};
  EXPECT_NEAR(direct({3, 1}, totals_of(w, {4.25, 3.5, 2.3, 2}), 1), 11, 1e-12);
}

TEST(OptimalSolver, EqualDensitiesAreOneTechnique) {
  // p₁ = p₂: all weights are 1/2, and the estimate is the mean of f/p = Σ y over the round.
  const std::vector<std::vector<double>> w = {{0.5, 0.5}, {0.5, 0.5}};
  EXPECT_NEAR(direct({1, 1}, totals_of(w, {0.2, 0.7}), 1), 0.9, 1e-14);
  // One sample, two unknowns: the balance heuristic's, made whole by the shortest fit.
  EXPECT_NEAR(direct({1, 1}, totals_of({{0.5, 0.5}}, {0.2}), 1), 0.4, 1e-14);
}

TEST(OptimalSolver, NothingComesOfNothing) {
  EXPECT_EQ(direct({1, 1}, std::vector<double>(5 * kLanes, 0.0), 7), 0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(direct({1, 1}, std::vector<double>(5 * kLanes, nan), 7)));
}

TEST(Optimal, HasNoVarianceWhereFIsASumOfDensities) {
  const auto toy = make_analytic_scene("mis-toy");  // f = p₂/2
  for (const std::string name : {"optimal", "optimal@light*3+bsdf"}) {
    const Estimates found = estimate<double>(*toy, 0, {.estimator = name, .rounds = 64});
    for (const double value : found[0]) EXPECT_NEAR(value, 0.5, 1e-13) << name;
  }
}

TEST(Optimal, EqualDensitiesLeaveItWhatTheyAgreeOn) {
  // Inside a sphere of light all diffuse samples by `light`, `bsdf` and `cosine` are worth ρ L, at the same densities.
  const Primitive floor =
      made_of(rectangle(Vec3::Zero(), 0.01 * Vec3::UnitX(), 0.01 * Vec3::UnitY()), diffuse(grey(0.5)));
  const DirectLighting source = lighting(scene_of({floor, emitting(sphere(Vec3::Zero(), 1, true), Rgb(3, 3, 3))},
                                                  {looking({0.3, 0.4, 0.5}, Vec3::Zero())}));
  for (const std::string name : {"optimal@bsdf+cosine", "optimal-progressive@bsdf+cosine"}) {
    for (const std::uint64_t rounds : {1, 2, 64}) {
      const Request request = {.estimator = name, .rounds = rounds, .replicates = kLanes};
      const Estimates f64 = estimate<double>(source, 0, request), f32 = estimate<float>(source, 0, request);
      for (std::size_t l = 0; l < kLanes; ++l) {
        EXPECT_NEAR(f64[0][l], 1.5, 1e-10) << name;
        EXPECT_NEAR(f32[0][l], 1.5, 1e-4) << name;
      }
    }
  }
}

TEST(Optimal, SamplesThatMeetNoLightCount) {
  const DirectLighting source = lit_floor(Rgb(1, 1, 1));
  const double exact = (*source.closed_form(0))[0];
  for (const std::string techniques : {"light+bsdf", "bsdf+cosine", "light+hemisphere+cosine", "light*3+bsdf"}) {
    const Request request = {.estimator = "", .rounds = 4096, .seed = 4};
    const auto found = estimate_together<double>(
        source, 0, {"optimal-progressive@" + techniques, "optimal@" + techniques, "balance@" + techniques}, request);
    expect_mean(found[0][0], exact, 0, "progressive " + techniques);
    expect_mean(found[1][0], exact, 1e-3, "direct " + techniques);  // and its bias, of the order of 1/4096
    // 64 replicates: the ratio of two equal variances is below 3.4 but with probability 1e-6.
    EXPECT_LT(mean_of(found[1][0]).standard_error, std::sqrt(3.4) * mean_of(found[2][0]).standard_error) << techniques;
  }
}

TEST(Optimal, ChannelsHaveFitsOfTheirOwn) {
  // A channel's estimate is linear in its radiance, whatever the others are.
  const DirectLighting coloured = lit_floor(Rgb(1, 2, 0)), grey_one = lit_floor(Rgb(1, 1, 1));
  ASSERT_EQ(coloured.channels(), 3);
  for (const std::string name : {"optimal", "optimal-progressive"}) {
    const Request request = {.estimator = name, .rounds = 100, .replicates = kLanes};
    const auto found = estimate<double>(coloured, 0, request), plain = estimate<double>(grey_one, 0, request);
    for (std::size_t l = 0; l < kLanes; ++l) {
      EXPECT_NEAR(found[0][l] / plain[0][l], 1, 1e-12);
      EXPECT_NEAR(found[1][l] / plain[0][l], 2, 1e-12);
      EXPECT_EQ(found[2][l], 0);
    }
  }
}

TEST(Optimal, ProgressiveIsUnbiasedAndBalanceAtFirst) {
  const auto cap = make_analytic_scene("aligned-phong-cap:n=10000,alpha=0.01");
  const double exact = (*cap->closed_form(0))[0];
  for (const std::uint64_t rounds : {3, 8, 21, 300}) {
    const Request request = {.estimator = "", .rounds = rounds, .seed = 5};
    const auto both = estimate_together<double>(*cap, 0, {"optimal-progressive", "balance"}, request);
    expect_mean(both[0][0], exact, 0, "progressive");
    for (std::size_t l = 0; rounds <= 8 && l < 64; ++l) EXPECT_NEAR(both[0][0][l], both[1][0][l], 1e-13);
  }
}

TEST(Optimal, APrefixIsARunOfItsOwnAndChangesNoOther) {
  const auto cap = make_analytic_scene("aligned-phong-cap:n=10000,alpha=0.01");
  const std::vector<std::string> names = {"balance", "optimal", "optimal-progressive"};
  const std::vector<std::uint64_t> rounds = {5, 8, 100, 128, 300};
  const StreamKey key = stream_key(7, "independent", "test");
  std::vector<Heuristic> heuristics;
  for (const auto& name : names) heuristics.push_back(parse_estimator(name, cap->techniques()).heuristic);
  const auto make = [&](std::vector<Heuristic> some, std::vector<std::uint64_t> at) {
    PassEvaluator<double> evaluator(SamplerCatalogue::built_in().make("independent"), cap->techniques(),
                                    {{0, 1}, {1, 1}}, std::move(some), std::move(at), 1);
    evaluator.run(*cap->pixel(0).integral, key, 0, 0);
    return evaluator;
  };
  const auto all = make(heuristics, rounds);
  for (std::size_t h = 0; h < names.size(); ++h) {
    for (std::size_t n = 0; n < rounds.size(); ++n) {
      const auto alone = make({heuristics[h]}, {rounds[n]});
      for (std::size_t l = 0; l < kLanes; ++l)
        EXPECT_EQ(all.estimates(h, n, 0)[l], alone.estimates(0, 0, 0)[l]) << names[h] << ' ' << rounds[n];
    }
  }
}

}  // namespace
}  // namespace halfslope
