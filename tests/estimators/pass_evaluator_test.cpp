#include "estimators/pass_evaluator.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scenes/catalogue.h"
#include "scenes/integrand.h"
#include "tests/estimators/estimates.h"
#include "tests/estimators/scene_builder.h"

namespace halfslope {
namespace {

/// Estimates of one pixel: [estimator][n][channel · kLanes + lane], by one evaluator over all of them.
template <class T>
std::vector<std::vector<std::vector<double>>> one_pass(const IntegralSource& source, int pixel,
                                                       const std::vector<std::string>& names,
                                                       const std::string& sampler,
                                                       const std::vector<std::uint64_t>& rounds) {
  std::vector<Heuristic> heuristics;
  Allocation allocation;
  for (const std::string& name : names) {
    const Estimator estimator = parse_estimator(name, source.techniques());
    heuristics.push_back(estimator.heuristic);
    allocation = estimator.allocation;
  }
  PassEvaluator<T> evaluator(SamplerCatalogue::built_in().make(sampler), source.techniques(), allocation, heuristics,
                             rounds, source.channels());
  const PixelIntegral integral = source.pixel(pixel);
  const StreamKey key = stream_key(7, sampler, "test");
  evaluator.run(*integral.integral, key, 1, 512);  // another pixel's numbers first: none of them may stay
  evaluator.run(*integral.integral, key, static_cast<std::uint32_t>(pixel), 32);
  std::vector<std::vector<std::vector<double>>> all(names.size(), std::vector<std::vector<double>>(rounds.size()));
  for (std::size_t h = 0; h < names.size(); ++h) {
    for (std::size_t n = 0; n < rounds.size(); ++n) {
      for (int c = 0; c < source.channels(); ++c) {
        const double* lanes = evaluator.estimates(h, n, c);
        all[h][n].insert(all[h][n].end(), lanes, lanes + kLanes);
      }
    }
  }
  return all;
}

/// A floor of metal under two coloured lights, one before the other in places.
DirectLighting coloured_scene() {
  Bsdf metal = conductor(0.3, Rgb(0.2, 0.5, 1.2), Rgb(3.9, 2.5, 2));
  const Primitive floor = made_of(rectangle(Vec3::Zero(), 5 * Vec3::UnitX(), 5 * Vec3::UnitY()), metal);
  return lighting(scene_of({floor, emitting(sphere({0.5, 0.2, 2}, 0.5), Rgb(1, 2, 3)),
                            emitting(rectangle({0, 0, 3}, Vec3::UnitY(), Vec3::UnitX()), Rgb(3, 1, 0.5))},
                           {looking({0.3, 0.4, 0.5}, Vec3::Zero())}));
}

template <class T>
class PassEvaluatorOf : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(PassEvaluatorOf, Numbers);

TYPED_TEST(PassEvaluatorOf, PrefixesOfASequenceAreSeparateRuns) {
  const DirectLighting source = coloured_scene();
  // Around the block of 32 samples, and far from it.
  const std::vector<std::uint64_t> rounds = {1, 2, 3, 31, 32, 33, 64, 100, 257, 1000};
  for (const std::string sampler : {"independent", "halton-owen", "stratified", "n-rooks"}) {
    const auto together = one_pass<TypeParam>(source, 0, {"balance"}, sampler, rounds);
    for (std::size_t n = 0; n < rounds.size(); ++n) {
      const auto alone = one_pass<TypeParam>(source, 0, {"balance"}, sampler, {rounds[n]});
      EXPECT_EQ(together[0][n], alone[0][0]) << sampler << ' ' << rounds[n];
    }
  }
}

TYPED_TEST(PassEvaluatorOf, AnotherHeuristicChangesNoNumberOfOthers) {
  const DirectLighting source = coloured_scene();
  std::vector<std::string> names = {"average", "balance", "power", "power:3", "power:4", "power:7.3"};
  for (int i = 0; names.size() < 37; ++i) names.push_back("power:" + std::to_string(0.25 * i));  // more than two folds
  const auto all = one_pass<TypeParam>(source, 0, names, "independent", {16, 64});
  for (std::size_t h = 0; h < names.size(); ++h) {
    EXPECT_EQ(all[h], (one_pass<TypeParam>(source, 0, {names[h]}, "independent", {16, 64}))[0]) << names[h];
  }
  EXPECT_EQ(source.channels(), 3);
}

TYPED_TEST(PassEvaluatorOf, LanesAreReplicates) {
  // The same replicates asked for from another first one: lanes move, numbers do not.
  const DirectLighting source = coloured_scene();
  const Estimator estimator = parse_estimator("power", source.techniques());
  PassEvaluator<TypeParam> evaluator(SamplerCatalogue::built_in().make("independent"), source.techniques(),
                                     estimator.allocation, {estimator.heuristic}, {50}, 3);
  const PixelIntegral integral = source.pixel(0);
  const StreamKey key = stream_key(7, "independent", "test");
  evaluator.run(*integral.integral, key, 0, 0);
  const std::vector<double> first(evaluator.estimates(0, 0, 2), evaluator.estimates(0, 0, 2) + kLanes);
  evaluator.run(*integral.integral, key, 0, 5);
  for (std::size_t l = 0; l + 5 < kLanes; ++l) EXPECT_EQ(evaluator.estimates(0, 0, 2)[l], first[l + 5]);
}

TYPED_TEST(PassEvaluatorOf, CountsStayUnbiased) {
  // Every allocation has the mean of every other: the toy problem's is 1/2, the coloured scene's that of bsdf alone.
  const auto toy = make_analytic_scene("mis-toy");
  const DirectLighting source = coloured_scene();
  for (const std::string name :
       {"average@light*3+bsdf", "balance@light*3+bsdf", "power:3@light*3+bsdf", "power@light+bsdf*5",
        "power:7.3@light*16+bsdf*16", "balance@light*4", "power:2@bsdf*7"}) {
    const Request request = {.estimator = name, .rounds = 256, .seed = 21};
    expect_mean(estimate<TypeParam>(*toy, 0, request)[0], 0.5, 1e-6, "mis-toy " + name);
    const auto found = estimate<TypeParam>(source, 0, request);
    const auto bsdf = estimate<TypeParam>(source, 0, {.estimator = "bsdf", .rounds = 4096, .seed = 22});
    for (std::size_t c = 0; c < 3; ++c) {
      const MeanAndError a = mean_of(found[c]), b = mean_of(bsdf[c]);
      EXPECT_LE(std::fabs(a.mean - b.mean), kStudent64 * std::hypot(a.standard_error, b.standard_error)) << name << c;
    }
  }
}

TYPED_TEST(PassEvaluatorOf, CountsAreSeparateSamples) {
  // k samples a round are k independent samples: the variance of average@light*k+bsdf on the toy problem, where bsdf
  // has none, is a k-th of average's 1/48. The sample variance of 2^16 estimates with κ < 3 strays by 6 standard
  // errors, √(2/2^16) each, with probability 2e-9.
  const auto toy = make_analytic_scene("mis-toy");
  for (const int k : {1, 3, 9}) {
    const std::string name = "average@light*" + std::to_string(k) + "+bsdf";
    const auto values = estimate<TypeParam>(*toy, 0, {.estimator = name, .rounds = 1, .replicates = 1 << 16})[0];
    const double error = mean_of(values).standard_error;
    EXPECT_NEAR(error * error * (1 << 16) * 48 * k, 1, 6 * std::sqrt(2.0 / (1 << 16))) << name;
  }
}

/// Independent points that keep a record of what was asked of them.
class RecordingSampler final : public Sampler {
 public:
  RecordingSampler(bool sequence, std::vector<std::string>& record)
      : points_(SamplerCatalogue::built_in().make("independent")), info_(points_->info()), record_(record) {
    info_.sequence = sequence;
  }
  const SamplerInfo& info() const override { return info_; }
  void prepare(const PointRequest& r) override {
    record_.push_back(fmt::format("{} points of {}, {}, {}", r.count, r.pixel, r.replicate, r.low_words));
    points_->prepare(r);
  }
  void fill(std::uint64_t begin, PointBlock& block) override {
    record_.push_back(fmt::format("{} from {}, {}", block.samples(), begin, block.dims()));
    points_->fill(begin, block);
  }

 private:
  std::unique_ptr<Sampler> points_;
  SamplerInfo info_;
  std::vector<std::string>& record_;
};

TYPED_TEST(PassEvaluatorOf, PointsAloneAreThoseOfARun) {
  const auto toy = make_analytic_scene("mis-toy");
  const Estimator estimator = parse_estimator("balance", toy->techniques());
  for (const bool sequence : {true, false}) {
    std::vector<std::string> record;
    PassEvaluator<TypeParam> evaluator(std::make_unique<RecordingSampler>(sequence, record), toy->techniques(),
                                       estimator.allocation, {estimator.heuristic}, {70}, toy->channels());
    const PixelIntegral pixel = toy->pixel(0);
    const StreamKey key = stream_key(1, "independent", "test");
    evaluator.run(*pixel.integral, key, 5, 32);
    const std::vector<std::string> run = std::exchange(record, {});
    evaluator.make_points(key, 5, 32);
    EXPECT_EQ(record, run);
    EXPECT_EQ(run.size(), 1u + 3);  // 70 points in blocks of 32
  }
}

TEST(PassEvaluator, ANonFiniteSampleIsNotLost) {
  // An emitter whose radiance is not a number: the estimate says so, in its own channel alone.
  const Primitive floor = made_of(rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()), diffuse(grey(0.5)));
  const Primitive light = emitting(sphere({0, 0, 2}, 1), Rgb(1, std::numeric_limits<double>::quiet_NaN(), 1));
  const DirectLighting source = lighting(scene_of({floor, light}, {looking({0.1, 0, 0.1}, Vec3::Zero())}));
  ASSERT_EQ(source.channels(), 3);
  for (const std::string name : {"light", "bsdf", "balance", "power:3"}) {
    const auto values = estimate<double>(source, 0, {.estimator = name, .rounds = 64, .replicates = kLanes});
    for (std::size_t l = 0; l < kLanes; ++l) {
      EXPECT_TRUE(std::isfinite(values[0][l]));
      EXPECT_TRUE(std::isnan(values[1][l])) << name;
    }
  }
}

}  // namespace
}  // namespace halfslope
