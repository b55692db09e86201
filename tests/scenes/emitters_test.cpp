#include "scenes/emitters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Emitters, ASpotsSolidAngleIsItsPowerOverItsIntensity) {
  SpotLight spot;
  spot.cutoff_angle = 0.9, spot.beam_width = 0.4;
  double sum = 0;
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 0.9 * (i + 0.5) / kSteps;
    sum += std::sin(t) * std::min(1.0, (0.9 - t) / 0.5);
  }
  EXPECT_NEAR(solid_angle(spot), 2 * kPi * sum * 0.9 / kSteps, 1e-8);
  spot.beam_width = 0.9;
  EXPECT_NEAR(solid_angle(spot), 2 * kPi * (1 - std::cos(0.9)), 1e-12);
}

}  // namespace
}  // namespace halfslope
