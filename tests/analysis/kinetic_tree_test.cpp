#include "analysis/kinetic_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace halfslope {
namespace {

/// Lines in a plain list, each looked at.
struct Lines {
  std::vector<double> y;
  std::vector<int> c;
  double slope;

  double value(std::size_t j, double t) const { return c[j] - slope * t * y[j]; }
  double best(double t, bool largest) const {
    double best = value(0, t);
    for (std::size_t j = 1; j < y.size(); ++j)
      best = largest ? std::max(best, value(j, t)) : std::min(best, value(j, t));
    return best;
  }
};

void race(std::size_t count, double slope, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> y(count);
  for (double& value : y) value = uniform(random);
  std::sort(y.begin(), y.end());
  Lines lines = {y, std::vector<int>(count), slope};
  KineticTree largest(y, slope, KineticTree::Winner::kLargest), smallest(y, slope, KineticTree::Winner::kSmallest);
  double t = 0;
  for (int step = 0; step < 400; ++step) {
    if (step % 3 == 0) {
      t += uniform(random) * (step % 2 == 0 ? 0.02 : 0.0005);
      largest.advance(t);
      smallest.advance(t);
    }
    const std::size_t first = random() % (count + 1);  // the last: past the end
    largest.raise_from(first);
    smallest.raise_from(first);
    for (std::size_t j = first; j < count; ++j) ++lines.c[j];
    for (const bool high : {true, false}) {
      const KineticTree::Line winner = (high ? largest : smallest).winner();
      const auto j = static_cast<std::size_t>(std::find(y.begin(), y.end(), winner.y) - y.begin());
      ASSERT_LT(j, count);
      ASSERT_EQ(winner.c, lines.c[j]);
      ASSERT_NEAR(lines.value(j, t), lines.best(t, high), 1e-12 * (1 + slope)) << count << " lines, step " << step;
    }
  }
}

TEST(KineticTree, KnowsTheWinnerOfLinesThatAreRaised) {
  for (const std::size_t count : {1, 2, 3, 4, 5, 16, 17, 31, 100, 1000}) {
    for (const double slope : {1.0, 100.0, 3000.0}) race(count, slope, count);
  }
}

TEST(KineticTree, EqualLinesAtTheStart) {
  const std::vector<double> y = {0, 0.25, 1};
  KineticTree largest(y, 4, KineticTree::Winner::kLargest), smallest(y, 4, KineticTree::Winner::kSmallest);
  EXPECT_EQ(largest.winner().c, 0);
  largest.advance(0.5);
  smallest.advance(0.5);
  EXPECT_EQ(largest.winner().y, 0);
  EXPECT_EQ(smallest.winner().y, 1);
  largest.raise_from(1);  // c_1 − 4 · 0.5 · 0.25 = 0.5
  EXPECT_EQ(largest.winner().y, 0.25);
  EXPECT_EQ(largest.winner().c, 1);
}

}  // namespace
}  // namespace halfslope
