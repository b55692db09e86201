#include "samplers/theory.h"

#include <gtest/gtest.h>

#include "samplers/catalogue.h"

namespace halfslope {
namespace {

using enum Regularity;

const Layout kLine = {{1}}, kPair = {{2}}, kPairs = {{2, 2}}, kMixed = {{1, 2}};

// Exact variances of one uniform point in each of N intervals: 1/(12 N³) of f = x, r (1 − r)/N² of a step.
TEST(Theory, AGridOnTheLine) {
  EXPECT_EQ(grid_rate(kSmooth, kLine), -1.5);
  EXPECT_EQ(grid_rate(kJump, kLine), -1.0);
}

TEST(Theory, AGridLosesWithDimensions) {
  EXPECT_EQ(grid_rate(kSmooth, kPair), -1.0);
  EXPECT_EQ(grid_rate(kKinked, kPair), -1.0);
  EXPECT_EQ(grid_rate(kJump, kPair), -0.75);
  EXPECT_EQ(grid_rate(kOneCoordinateJump, kPair), -0.75);
  EXPECT_EQ(grid_rate(kSmooth, kPairs), -0.75);
  EXPECT_EQ(grid_rate(kJump, kPairs), -0.625);
  EXPECT_FALSE(grid_rate(kSquareIntegrable, kPair));
}

TEST(Theory, AGridInEveryGroupGainsForSumsAlone) {
  EXPECT_EQ(grouped_grid_rate(kJump, kPair), -0.75);
  EXPECT_EQ(grouped_grid_rate(kJump, kPairs), -0.5);
  EXPECT_EQ(grouped_grid_rate(kOneCoordinateSmooth, kPairs), -1.0);
  EXPECT_FALSE(grouped_grid_rate(kOneCoordinateSmooth, kMixed));  // −3/2 or −1: it is not said of which coordinate
}

TEST(Theory, ALatinHypercubeKnowsCoordinatesAlone) {
  EXPECT_EQ(latin_rate(kOneCoordinateJump, kPair), -1.0);
  EXPECT_EQ(latin_rate(kOneCoordinateSmooth, kPairs), -1.5);
  EXPECT_EQ(latin_rate(kSmooth, kPair), -0.5);
  EXPECT_EQ(latin_rate(kSmooth, kLine), -1.5);
}

TEST(Theory, NetsAndShiftsAndFolds) {
  EXPECT_EQ(scrambled_net_rate(kMixedDerivative, kPairs), -1.5);
  EXPECT_EQ(scrambled_net_rate(kJump, kPair), -0.75);
  EXPECT_EQ(scrambled_net_rate(kOneCoordinateJump, kPair), -1.0);
  EXPECT_FALSE(scrambled_net_rate(kKinked, kPair));
  EXPECT_EQ(low_discrepancy_rate(kSmooth, kPairs), -1.0);
  EXPECT_FALSE(low_discrepancy_rate(kJump, kPair));  // of unbounded variation unless along the axes
  EXPECT_EQ(folded_lattice_rate(kSmooth, kPairs), -2.0);
  EXPECT_FALSE(folded_lattice_rate(kMixedDerivative, kPair));
}

std::optional<double> rate_of(const std::string& sampler, Regularity regularity, const Layout& layout) {
  const RateTheory rate = SamplerCatalogue::built_in().make(sampler)->info().rate;
  return rate ? rate(regularity, layout) : std::nullopt;
}

TEST(Theory, SamplersDeclareIt) {
  EXPECT_EQ(rate_of("independent", kSquareIntegrable, kPairs), -0.5);
  EXPECT_EQ(rate_of("halton-cp", kSmooth, kPair), -1.0);
  EXPECT_EQ(rate_of("faure-owen", kSmooth, kPair), -1.5);
  EXPECT_EQ(rate_of("faure-owen", kSmooth, kPairs), -1.0);
  EXPECT_EQ(rate_of("sobol-owen", kSmooth, kPairs), -1.5);
  EXPECT_EQ(rate_of("padded:sobol-owen", kSmooth, kPair), -1.5);
  EXPECT_EQ(rate_of("padded:sobol-owen", kSmooth, kPairs), -0.5);
  EXPECT_FALSE(rate_of("poisson-disk", kSmooth, kPair));
}

}  // namespace
}  // namespace halfslope
