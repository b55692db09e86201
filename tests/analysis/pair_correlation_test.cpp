#include "analysis/pair_correlation.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

std::vector<std::uint64_t> all_pairs(const Columns& points, const DistanceBins& bins) {
  std::vector<std::uint64_t> pairs(static_cast<std::size_t>(bins.bins));
  for (std::size_t i = 0; i < points[0].size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double sum = 0;
      for (const auto& column : points) {
        const double apart = std::abs(column[i] - column[j]);
        sum += std::pow(std::min(apart, 1 - apart), 2);
      }
      const auto bin = static_cast<std::size_t>(std::sqrt(sum) * (bins.bins / bins.most));
      if (bin < pairs.size()) ++pairs[bin];
    }
  }
  return pairs;
}

TEST(PairCorrelation, CountsAllPairsOnce) {
  std::mt19937_64 random(1);
  for (std::size_t dims = 1; dims <= 5; ++dims) {
    for (const std::size_t count : {2, 3, 50, 700}) {
      const Columns points = random_points(count, dims, random);
      for (const DistanceBins& bins : {DistanceBins{1, 0.5}, {64, 0.5}, {37, 0.31}, {200, 0.11}, {10, 0.013}}) {
        EXPECT_EQ(pairs_by_distance(view(points), bins), all_pairs(points, bins))
            << dims << ' ' << count << ' ' << bins.most;
      }
    }
  }
}

// Ties, equal points, and coordinates 0 and 1, which are one place. The grid's distances are no edges of bins.
TEST(PairCorrelation, CountsTies) {
  std::mt19937_64 random(2);
  for (const std::uint64_t grid : {1, 2, 8, 16}) {
    const Columns points = random_points(300, 2, random, grid);
    for (const DistanceBins& bins : {DistanceBins{7, 0.499}, {13, 0.2999}, {11, 0.07}}) {
      EXPECT_EQ(pairs_by_distance(view(points), bins), all_pairs(points, bins)) << grid << ' ' << bins.most;
    }
  }
}

TEST(PairCorrelation, InOneDimensionUpToAHalfIsAllPairs) {
  std::mt19937_64 random(3);
  const auto pairs = pairs_by_distance(view(random_points(1000, 1, random)), {50, 0.5});
  EXPECT_EQ(std::accumulate(pairs.begin(), pairs.end(), std::uint64_t{0}), 1000u * 999 / 2);
}

TEST(PairCorrelation, EqualPointsAreAtDistance0) {
  const auto pairs = pairs_by_distance(view(Columns(2, std::vector<double>(3000, 0.7))), {5, 0.1});
  EXPECT_EQ(pairs[0], 3000u * 2999 / 2);
  EXPECT_EQ(std::accumulate(pairs.begin() + 1, pairs.end(), std::uint64_t{0}), 0u);
}

// Of a 16 × 16 grid each point has 4 neighbours at 1/16, 4 at √2/16, 4 at 2/16, 8 at √5/16 and no others below √8/16;
// with bins of 1/64 that is the bins 4 (from 4/64 on), 5, and twice 8.
TEST(PairCorrelation, OfAGrid) {
  Columns points(2);
  for (int i = 0; i < 256; ++i) points[0].push_back(i % 16 / 16.0), points[1].push_back(i / 16 / 16.0);
  const DistanceBins bins = {9, 9 / 64.0};
  const auto pairs = pairs_by_distance(view(points), bins);
  EXPECT_THAT(pairs, ::testing::ElementsAre(0, 0, 0, 0, 512, 512, 0, 0, 512 + 1024));
  const double ring = std::numbers::pi * (25 - 16) / (64.0 * 64);
  EXPECT_NEAR(pair_correlation(view(points), bins)[4], 512 / (256 * 255 / 2 * ring), 1e-12);
}

TEST(PairCorrelation, VolumesOfBalls) {
  const double pi = std::numbers::pi, r = 0.37;
  EXPECT_DOUBLE_EQ(ball_volume(1, r), 2 * r);
  EXPECT_DOUBLE_EQ(ball_volume(2, r), pi * r * r);
  EXPECT_DOUBLE_EQ(ball_volume(3, r), 4 * pi / 3 * r * r * r);
  EXPECT_DOUBLE_EQ(ball_volume(4, r), pi * pi / 2 * std::pow(r, 4));
  EXPECT_DOUBLE_EQ(ball_volume(7, r), 16 * pi * pi * pi / 105 * std::pow(r, 7));
}

// Of independent points any two pairs are independent too, since the torus has no middle: the number of pairs in a bin
// of volume p has exactly the mean M p and the variance M p (1 − p), M = N(N − 1)/2. The mean over replicates at every
// r is within 6.2 standard errors of 1. Of a bin with the fewest pairs, 200, that fails once in 2e8 runs, of the
// thousands that most have once in 2e9; 600 bins in all: false alarm below 1e-6.
TEST(PairCorrelation, OfIndependentPointsIs1AtEveryDistance) {
  std::mt19937_64 random(4);
  for (const std::size_t dims : {1u, 2u, 3u}) {
    for (const double most : {0.5, usual_most_distance(1000, dims) / 2}) {
      const DistanceBins bins = {100, most};
      const std::size_t count = dims == 1 ? 500 : 1000;
      const int replicates = 64;
      std::vector<double> sums(static_cast<std::size_t>(bins.bins));
      for (int r = 0; r < replicates; ++r) {
        const auto g = pair_correlation(view(random_points(count, dims, random)), bins);
        for (std::size_t k = 0; k < g.size(); ++k) sums[k] += g[k];
      }
      const double all = static_cast<double>(count) * static_cast<double>(count - 1) / 2 * replicates;
      for (int k = dims == 3 ? 8 : 0; k < bins.bins; ++k) {
        const double p = ball_volume(dims, bins.edge(k + 1)) - ball_volume(dims, bins.edge(k));
        ASSERT_GT(all * p, 200) << dims << ' ' << most << ' ' << k;
        EXPECT_NEAR(sums[static_cast<std::size_t>(k)] / replicates, 1, 6.2 * std::sqrt((1 - p) / (all * p)))
            << dims << " dimensions, r = " << bins.centre(k);
      }
    }
  }
}

TEST(PairCorrelation, LooksAsFarAsTenMeanDistances) {
  EXPECT_DOUBLE_EQ(usual_most_distance(16384, 2), 10 / 128.0);
  EXPECT_DOUBLE_EQ(usual_most_distance(1'000'000, 3), 0.1);
  EXPECT_DOUBLE_EQ(usual_most_distance(2, 2), 0.5);
}

TEST(PairCorrelationDeathTest, DistancesAreAtMostHalf) {
  const Columns points = {{0.1, 0.2}, {0.1, 0.2}};
  EXPECT_DEATH(pair_correlation(view(points), {10, 0.6}), "lie in \\(0, 1/2\\]");
  EXPECT_DEATH(pair_correlation(view({{0.1}}), {10, 0.5}), "needs two");
}

}  // namespace
}  // namespace halfslope
