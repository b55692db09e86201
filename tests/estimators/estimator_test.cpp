#include "estimators/estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::vector<Technique> kScene = {{"light", {{1, 2}}}, {"bsdf", {{2}}}};
const std::vector<Technique> kLighting = {
    {"light", {{1, 2}}}, {"bsdf", {{2}}}, {"hemisphere", {{2}}}, {"cosine", {{2}}}, {"surface", {{1, 2}}}};
const std::vector<Technique> kIntegrand = {{"mean", {{2}}}};

TEST(ParseEstimator, ATechniquesNameIsItsOwnEstimator) {
  const Estimator light = parse_estimator("light", kScene);
  EXPECT_EQ(light.name, "light");
  EXPECT_EQ(light.heuristic.kind, HeuristicKind::kSingle);
  EXPECT_THAT(light.allocation.techniques, ElementsAre(0));
  EXPECT_THAT(light.allocation.counts, ElementsAre(1));
  EXPECT_EQ(light.allocation.round(), 1);
  EXPECT_THAT(light.allocation.layout(kScene).groups, ElementsAre(1, 2));
  EXPECT_THAT(parse_estimator("bsdf", kScene).allocation.techniques, ElementsAre(1));
  EXPECT_THAT(parse_estimator("bsdf", kScene).allocation.layout(kScene).groups, ElementsAre(2));
  EXPECT_EQ(parse_estimator("mean", kIntegrand).heuristic.kind, HeuristicKind::kSingle);
}

TEST(ParseEstimator, HeuristicsTakeLightAndBsdfUnlessToldOtherwise) {
  const struct {
    const char* name;
    HeuristicKind kind;
    double parameter;
  } cases[] = {{"average", HeuristicKind::kAverage, 0},    {"balance", HeuristicKind::kBalance, 0},
               {"power", HeuristicKind::kPower, 2},        {"power:3", HeuristicKind::kPower, 3},
               {"power:0.5", HeuristicKind::kPower, 0.5},  {"power:0", HeuristicKind::kPower, 0},
               {"power:1e3", HeuristicKind::kPower, 1000}, {"cutoff", HeuristicKind::kCutoff, 0.1},
               {"cutoff:0", HeuristicKind::kCutoff, 0},    {"cutoff:0.5", HeuristicKind::kCutoff, 0.5},
               {"cutoff:1", HeuristicKind::kCutoff, 1},    {"maximum", HeuristicKind::kMaximum, 0}};
  for (const auto& c : cases) {
    const Estimator estimator = parse_estimator(c.name, kScene);
    EXPECT_EQ(estimator.name, c.name);
    EXPECT_EQ(estimator.heuristic.kind, c.kind) << c.name;
    EXPECT_EQ(estimator.heuristic.parameter, c.parameter) << c.name;
    EXPECT_THAT(estimator.allocation.techniques, ElementsAre(0, 1));
    EXPECT_THAT(estimator.allocation.counts, ElementsAre(1, 1));
    EXPECT_EQ(estimator.allocation.round(), 2);
    EXPECT_THAT(estimator.allocation.layout(kScene).groups, ElementsAre(1, 2, 2));
    EXPECT_EQ(parse_estimator(std::string(c.name) + "@light+bsdf", kScene).allocation, estimator.allocation);
  }
}

TEST(ParseEstimator, CountsFollowTheCatalogueWhateverTheOrderInTheName) {
  const Estimator estimator = parse_estimator("power:3@light*3+bsdf", kScene);
  EXPECT_EQ(estimator.heuristic.parameter, 3);
  EXPECT_THAT(estimator.allocation.counts, ElementsAre(3, 1));
  EXPECT_EQ(estimator.allocation.round(), 4);
  EXPECT_THAT(estimator.allocation.layout(kScene).groups, ElementsAre(1, 2, 1, 2, 1, 2, 2));
  EXPECT_EQ(estimator.allocation.layout(kScene).dims(), 11);
  EXPECT_EQ(parse_estimator("balance@bsdf+light*3", kScene).allocation, estimator.allocation);
  EXPECT_FALSE(parse_estimator("balance", kScene).allocation == estimator.allocation);
}

TEST(ParseEstimator, AnyTechniquesInAnyNumbers) {
  const Estimator estimator = parse_estimator("cutoff:0.2@surface+light*2+cosine*5+hemisphere+bsdf", kLighting);
  EXPECT_THAT(estimator.allocation.techniques, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(estimator.allocation.counts, ElementsAre(2, 1, 1, 5, 1));
  EXPECT_EQ(estimator.allocation.round(), 10);
  EXPECT_THAT(estimator.allocation.layout(kLighting).groups, ElementsAre(1, 2, 1, 2, 2, 2, 2, 2, 2, 2, 2, 1, 2));
  EXPECT_THAT(parse_estimator("balance", kLighting).allocation.techniques, ElementsAre(0, 1));
  for (const char* name : {"hemisphere", "cosine", "surface"}) {
    EXPECT_EQ(parse_estimator(name, kLighting).heuristic.kind, HeuristicKind::kSingle) << name;
    EXPECT_EQ(parse_estimator(name, kLighting).allocation.round(), 1) << name;
  }
}

TEST(ParseEstimator, ALoneTechniqueNeedsNoWeights) {
  for (const char* name : {"average@bsdf", "balance@bsdf*4", "power:7@bsdf*64"}) {
    EXPECT_EQ(parse_estimator(name, kScene).heuristic.kind, HeuristicKind::kSingle) << name;
    EXPECT_THAT(parse_estimator(name, kScene).allocation.techniques, ElementsAre(1)) << name;
  }
  EXPECT_THAT(parse_estimator("balance@bsdf*4", kScene).allocation.counts, ElementsAre(4));
}

std::string error_of(const std::string& name, const std::vector<Technique>& techniques) {
  try {
    parse_estimator(name, techniques);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  ADD_FAILURE() << "no error for " << name;
  return "";
}

TEST(ParseEstimator, ErrorsSayWhatIsWrongAndWhatThereIs) {
  EXPECT_EQ(error_of("balence", kScene),
            "there is no estimator 'balence' for this scene; did you mean 'balance'? (it has light, bsdf, average, "
            "balance, power, cutoff, maximum, optimal, optimal-progressive, one-sample-balance, one-sample-power)");
  EXPECT_EQ(error_of("", kScene),
            "there is no estimator '' for this scene (it has light, bsdf, average, balance, power, cutoff, maximum, "
            "optimal, optimal-progressive, one-sample-balance, one-sample-power)");
  EXPECT_EQ(error_of("light*3", kScene).find("there is no estimator 'light*3'"), 0u);
  EXPECT_EQ(error_of("balance@light+bsfd", kScene),
            "estimator 'balance@light+bsfd': there is no technique 'bsfd' here; did you mean 'bsdf'? (this scene has "
            "light, bsdf)");
  EXPECT_THAT(error_of("balance@", kScene), HasSubstr("there is no technique ''"));
  EXPECT_THAT(error_of("balance@light+", kScene), HasSubstr("there is no technique ''"));
  EXPECT_THAT(error_of("balance@+bsdf", kScene), HasSubstr("there is no technique ''"));
  EXPECT_EQ(error_of("balance@light+light", kScene), "estimator 'balance@light+light': technique 'light' stands twice");
  for (const char* count : {"0", "-1", "65", "1.5", "", "x", "3*3", "99999999999"}) {
    const std::string name = "balance@light*" + std::string(count) + "+bsdf";
    EXPECT_EQ(error_of(name, kScene),
              "estimator '" + name + "': 'light*" + count + "': a count is a whole number from 1 to 64");
  }
  EXPECT_EQ(error_of("balance@light*60+bsdf*5", kScene),
            "estimator 'balance@light*60+bsdf*5': a round takes at most 64 samples of 16 techniques");
  for (const char* beta : {"", "-1", "x", "nan", "inf", "1e999", "2,5", " 2"}) {
    const std::string name = "power:" + std::string(beta);
    EXPECT_EQ(error_of(name, kScene), "estimator '" + name +
                                          "': the power heuristic's exponent is a number that is at least 0, found '" +
                                          beta + "'");
  }
  for (const char* alpha : {"", "-0.1", "1.001", "2", "x", "nan", "inf", "0,5", "0.5x"}) {
    const std::string name = "cutoff:" + std::string(alpha);
    EXPECT_EQ(error_of(name, kScene),
              "estimator '" + name +
                  "': the cutoff heuristic's threshold is a number that is at least 0 and at most 1, found '" + alpha +
                  "'");
  }
  EXPECT_EQ(error_of("maximum:1", kScene), "estimator 'maximum:1': 'maximum' takes no parameter");
  EXPECT_EQ(error_of("balance:2", kScene), "estimator 'balance:2': 'balance' takes no parameter");
  EXPECT_EQ(error_of("average:", kScene), "estimator 'average:': 'average' takes no parameter");
  // A scene of one technique: the default pair is not there.
  EXPECT_EQ(error_of("balance", kIntegrand),
            "estimator 'balance': there is no technique 'light' here (this scene has mean)");
  EXPECT_EQ(error_of("light", kIntegrand).find("there is no estimator 'light' for this scene"), 0u);
}

TEST(EstimatorCatalogue, EveryEntryIsWhatTheParserKnows) {
  ASSERT_FALSE(EstimatorCatalogue::built_in().list().empty());
  for (const EstimatorInfo& info : EstimatorCatalogue::built_in().list()) {
    EXPECT_FALSE(info.description.empty() || info.reference.empty()) << info.name;
    const std::string name = info.name.substr(0, info.name.find('['));
    std::vector<Technique> techniques = name == "mean" ? kIntegrand : kLighting;
    for (const char* light : {"light-power", "light-bvh", "light-solid-angle"}) techniques.push_back({light, {{2}}});
    if (is_path_estimator(name)) {
      const std::vector<Technique> of_paths = {{"light", {{2}}}, {"bsdf", {{2}}}};
      EXPECT_NO_THROW(EstimatorCatalogue::built_in().parse_path(name, of_paths, {})) << name;
    } else {
      EXPECT_NO_THROW(parse_estimator(name, techniques)) << name;
    }
  }
}

}  // namespace
}  // namespace halfslope
