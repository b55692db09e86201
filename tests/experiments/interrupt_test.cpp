#include "experiments/interrupt.h"

#include <gtest/gtest.h>

namespace halfslope {
namespace {

TEST(Interrupt, FirstSignalSetsTheFlag) {
  for (int signal : {SIGINT, SIGTERM}) {
    const InterruptGuard guard;
    EXPECT_FALSE(interrupted());
    ::raise(signal);
    EXPECT_TRUE(interrupted());
  }
  EXPECT_FALSE(interrupted());
}

TEST(InterruptDeathTest, SecondSignalEndsWith130) {
  const auto twice = [] {
    const InterruptGuard guard;
    ::raise(SIGINT);
    ::raise(SIGTERM);
  };
  EXPECT_EXIT(twice(), ::testing::ExitedWithCode(130), "");
}

TEST(InterruptDeathTest, WithoutAGuardSignalsAreAsBefore) {
  const auto after = [] {
    { const InterruptGuard guard; }
    ::raise(SIGTERM);
  };
  EXPECT_EXIT(after(), ::testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace halfslope
