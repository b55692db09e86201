#include "analysis/normal.h"

#include <gtest/gtest.h>

namespace halfslope {
namespace {

TEST(Normal, QuantilesAndProbabilitiesAreThoseOfTables) {
  EXPECT_NEAR(normal_quantile(0.975), kNormal975, 1e-13);
  EXPECT_NEAR(normal_quantile(0.8), 0.8416212335729143, 1e-13);
  EXPECT_NEAR(normal_probability(1.959963984540054), 0.975, 1e-14);
  EXPECT_NEAR(normal_probability(-5), 2.866515718791939e-7, 1e-20);
}

}  // namespace
}  // namespace halfslope
