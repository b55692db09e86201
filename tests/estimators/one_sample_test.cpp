// One sample of a technique chosen at random.
#include "estimators/one_sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "scenes/integrand.h"
#include "tests/estimators/estimates.h"
#include "tests/estimators/scene_builder.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;

const std::vector<Technique> kScene = {{"light", {{1, 2}}}, {"bsdf", {{2}}}, {"odd", {{2, 1}}}};

TEST(SharedLayout, LaysTechniquesOverOneAnother) {
  const SharedLayout pair = shared_layout(std::vector<int>{0, 1}, kScene);
  EXPECT_THAT(pair.layout.groups, ElementsAre(1, 1, 2));
  EXPECT_THAT(pair.first_dims, ElementsAre(1, 2));
  // A pair stays a pair: 2, 1 is no run of 1, 2.
  const SharedLayout all = shared_layout(std::vector<int>{0, 1, 2}, kScene);
  EXPECT_THAT(all.layout.groups, ElementsAre(1, 1, 2, 2, 1));
  EXPECT_THAT(all.first_dims, ElementsAre(1, 2, 4));
}

TEST(OneSample, NamesAreParsed) {
  const Estimator e = parse_estimator("one-sample-power:3@light*3+bsdf", kScene);
  EXPECT_TRUE(e.allocation.one_sample);
  EXPECT_EQ(e.heuristic.kind, HeuristicKind::kPower);
  EXPECT_EQ(e.heuristic.parameter, 3);
  EXPECT_THAT(e.allocation.counts, ElementsAre(3, 1));
  EXPECT_EQ(e.allocation.round(), 1);
  EXPECT_EQ(parse_estimator("one-sample-maximum@light+bsdf", kScene).heuristic.kind, HeuristicKind::kMaximum);
  const Estimator lone = parse_estimator("one-sample-balance@bsdf*4", kScene);
  EXPECT_EQ(lone.allocation, parse_estimator("bsdf", kScene).allocation);
  EXPECT_THROW(parse_estimator("one-sample-optimal@light+bsdf", kScene), Error);
  EXPECT_THROW(parse_estimator("one-sample-balance:2@light+bsdf", kScene), Error);
  EXPECT_THROW(parse_estimator("one-sample-", kScene), Error);
}

TEST(OneSample, EveryHeuristicIsUnbiasedInBothPrecisions) {
  const Primitive floor = made_of(rectangle(Vec3::Zero(), 5 * Vec3::UnitX(), 5 * Vec3::UnitY()),
                                  conductor(0.3, Rgb(0.2, 0.5, 1.2), Rgb(3.9, 2.5, 2)));
  const DirectLighting source =
      lighting(scene_of({floor, emitting(sphere({0.5, 0.2, 2}, 0.5), Rgb(1, 2, 3)),
                         emitting(rectangle({0, 0, 3}, Vec3::UnitY(), Vec3::UnitX()), Rgb(3, 1, 0.5))},
                        {looking({0.3, 0.4, 0.5}, Vec3::Zero())}));
  const auto exact = estimate<double>(source, 0, {.estimator = "balance", .rounds = 8192, .seed = 9});
  for (const std::string name : {"one-sample-balance", "one-sample-power@light*3+bsdf", "one-sample-maximum",
                                 "one-sample-average@bsdf+cosine+light"}) {
    const Request request = {.estimator = name, .rounds = 1001, .seed = 10};
    for (const auto& found : {estimate<double>(source, 0, request), estimate<float>(source, 0, request)}) {
      for (std::size_t c = 0; c < 3; ++c) {
        const MeanAndError a = mean_of(found[c]), b = mean_of(exact[c]);
        EXPECT_LE(std::fabs(a.mean - b.mean), kStudent64 * std::hypot(a.standard_error, b.standard_error)) << name << c;
      }
    }
  }
}

TEST(OneSample, ChoosesWithTheProbabilitiesOfTheCounts) {
  // The toy problem, all weight to bsdf: f/(C p) is 1/(2C) with probability C, else 0, so its variance at one sample is
  // (1/C − 1)/4. With 2^16 samples the variance strays by 6 standard errors, √((κ − 1)/2^16) each, with probability
  // 2e-9.
  EstimatorCatalogue catalogue = EstimatorCatalogue::built_in();
  catalogue.add({"last", "the last technique", "a test"},
                [](const double*, int techniques, int i) { return i == techniques - 1 ? 1.0 : 0.0; });
  const auto toy = make_analytic_scene("mis-toy");
  for (const auto& [name, probability] : {std::pair<std::string, double>{"one-sample-last", 0.5},
                                          {"one-sample-last@light*3+bsdf", 0.25},
                                          {"one-sample-last@light+bsdf*4", 0.8}}) {
    const int count = 1 << 16;
    const auto values = estimate_together<double>(*toy, 0, {name}, {.estimator = "", .rounds = 1, .replicates = count},
                                                  catalogue)[0][0];
    const double variance = (1 / probability - 1) / 4, error = mean_of(values).standard_error;
    const double odds = probability * (1 - probability), kurtosis = (1 - 3 * odds) / odds;
    EXPECT_NEAR(error * error * count / variance, 1, 6 * std::sqrt((kurtosis - 1) / count) + 1e-3) << name;
    EXPECT_NEAR(mean_of(values).mean, 0.5, 6 * std::sqrt(variance / count)) << name;
  }
}

}  // namespace
}  // namespace halfslope
