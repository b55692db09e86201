// Heuristics that an embedder adds: a weight function under a name of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/estimators/expect_radiance.h"
#include "tests/estimators/heuristic_ways.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

double own_balance(const double* ratios, int techniques, int i) {
  double sum = ratios[0];
  for (int k = 1; k < techniques; ++k) sum += ratios[k];
  return ratios[i] / sum;
}
double own_power(const double* ratios, int techniques, int i) {
  double sum = 0;
  for (int k = 0; k < techniques; ++k) sum += ratios[k] * ratios[k];
  return ratios[i] * ratios[i] / sum;
}
/// All to the last technique, whatever it would have been worth elsewhere: right where it reaches everything.
double last_one(const double*, int techniques, int i) { return i == techniques - 1 ? 1 : 0; }

Heuristic custom(WeightFunction weight) { return {HeuristicKind::kCustom, 0, weight}; }

const std::vector<Technique> kScene = {{"light", {{1, 2}}}, {"bsdf", {{2}}}};

EstimatorCatalogue extended() {
  EstimatorCatalogue catalogue = EstimatorCatalogue::built_in();
  catalogue.add({"own-balance", "the balance heuristic again", "a test"}, own_balance);
  catalogue.add({"own_power2", "the power heuristic again", "a test"}, own_power);
  catalogue.add({"last", "the last technique", "a test"}, last_one);
  return catalogue;
}

template <class T>
class CustomHeuristics : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(CustomHeuristics, Numbers);

TYPED_TEST(CustomHeuristics, TheSameFormulaGivesTheSameWeights) {
  using T = TypeParam;
  const double epsilon = std::numeric_limits<T>::epsilon();
  for (std::size_t n = 2; n <= 5; ++n) {
    const Table<T> densities = random_densities<T>(n, 512, 70 + n);
    for (const Way<T>& way : every_way<T>()) {
      const auto expect_same = [&](const Heuristic& own, const Heuristic& built_in) {
        const Table<T> found = way.weights(own, densities), expected = way.weights(built_in, densities);
        for (std::size_t i = 0; i < n; ++i) {
          // The function is called in binary64, and rounds once.
          for (std::size_t p = 0; p < 512; ++p) ASSERT_NEAR(found[i][p], expected[i][p], 4 * epsilon) << way.name;
        }
      };
      expect_same(custom(own_balance), kBalance);
      expect_same(custom(own_power), power(2));
    }
  }
}

TYPED_TEST(CustomHeuristics, EstimateWhatTheBuiltInOnesDo) {
  using T = TypeParam;
  const Primitive ball = emitting(sphere({-1, -0.8, 1.5}, 0.5), Rgb(4, 0, 1));
  const DirectLighting source =
      lighting(floor_under({ceiling_light(2, 1, 1, Rgb(1, 2, 3)), ball}, phong(grey(0.3), grey(0.4), 20)));
  const double epsilon = std::numeric_limits<T>::epsilon();
  for (const std::string list : {"", "@light*2+bsdf", "@bsdf+hemisphere+cosine+surface"}) {
    const auto found = estimate_together<T>(
        source, 0, {"balance" + list, "own-balance" + list, "power" + list, "own_power2" + list, "last" + list},
        {.estimator = "", .rounds = 256, .replicates = kLanes}, extended());
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        ASSERT_NEAR(found[1][c][l], found[0][c][l], 16 * epsilon * found[0][c][l]) << list;
        ASSERT_NEAR(found[3][c][l], found[2][c][l], 16 * epsilon * found[2][c][l]) << list;
      }
    }
  }
  const auto last = estimate_together<T>(source, 0, {"last"}, {.estimator = "", .rounds = 256}, extended())[0];
  const auto all =
      estimate_together<T>(source, 0, {"own-balance@light*3+bsdf"}, {.estimator = "", .rounds = 4096}, extended())[0];
  for (std::size_t c = 0; c < 3; ++c) {
    const MeanAndError a = mean_of(last[c]), b = mean_of(all[c]);
    EXPECT_LE(std::fabs(a.mean - b.mean), kStudent64 * std::hypot(a.standard_error, b.standard_error));
  }
}

TEST(CustomHeuristicNames, AreParsedAndListed) {
  const EstimatorCatalogue catalogue = extended();
  const Estimator estimator = catalogue.parse("own-balance@light*3+bsdf", kScene);
  EXPECT_EQ(estimator.heuristic.kind, HeuristicKind::kCustom);
  EXPECT_EQ(estimator.heuristic.custom, &own_balance);
  EXPECT_THAT(estimator.allocation.counts, ElementsAre(3, 1));
  EXPECT_EQ(catalogue.parse("own-balance@bsdf", kScene).heuristic.kind, HeuristicKind::kSingle);
  EXPECT_EQ(catalogue.list().back().name, "last");
  EXPECT_EQ(catalogue.list().size(), EstimatorCatalogue::built_in().list().size() + 3);
  try {
    catalogue.parse("own-balance:2", kScene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "estimator 'own-balance:2': 'own-balance' takes no parameter");
  }
  try {
    catalogue.parse("own-balence", kScene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'own-balance'?"));
  }
  EXPECT_THROW(parse_estimator("own-balance", kScene), Error) << "the built-in catalogue is as it was";
}

TEST(CustomHeuristicNamesDeathTest, TakenAndIllegalNamesAreAssertions) {
  // Techniques' names too: a technique's name alone is its own estimator, so the heuristic would never be met.
  for (const char* name : {"balance", "power", "cutoff", "maximum", "last", "light", "surface", "mean"}) {
    EXPECT_DEATH(extended().add({name, "taken", "a test"}, own_balance), "an estimator of that name") << name;
  }
  for (const char* name : {"", "a:b", "a@b", "a+b", "a*b", "a,b", "a b", "a/b", "a\nb", "\"a\"", "a[b", "\u00e4"}) {
    EXPECT_DEATH(extended().add({name, "illegal", "a test"}, own_balance), "without punctuation") << name;
  }
  EXPECT_DEATH(extended().add({"nothing", "no function", "a test"}, nullptr), "has a weight function");
}

}  // namespace
}  // namespace halfslope
