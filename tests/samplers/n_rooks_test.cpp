#include "samplers/n_rooks.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

TEST(NRooks, OnePointInEachStratumOfEveryDimension) {
  const auto sampler = sampler_named("n-rooks");
  for (const std::uint64_t count : {1u, 2u, 3u, 5u, 7u, 64u, 97u, 100u, 1009u, 4096u, 4099u, 10007u}) {
    const Points points = points_of(*sampler, count, {{1, 2}});
    for (int dim = 0; dim < 3; ++dim) {
      for (int lane = 0; lane < kLanes; ++lane) {
        std::vector<int> seen(count);
        for (std::uint64_t i = 0; i < count; ++i) ++seen[((points.at(dim, i, lane) >> 21) * count) >> 32];
        ASSERT_EQ(seen, std::vector<int>(count, 1)) << count << " dim " << dim << " lane " << lane;
      }
    }
  }
}

// Exact variances of the mean, N points, each dimension's strata shuffled by a uniform permutation.
//
// f = x + y: each dimension is N independent jittered strata, so 2 · 1/(12N³).
// f = xy: write a_k, b_k for the point of each dimension in stratum k. Given all a and b, the estimate (1/N) Σ a_k
// b_{π(k)} has mean ā·b̄ and variance S_a S_b / (N² (N−1)), S_a = Σ (a_k − ā)² (Hoeffding, "A combinatorial central
// limit theorem", 1951). E S_a = Σ_k ((k+½)/N − ½)² + (N−1)/(12N²) = (N³−1)/(12N²), and ā has mean ½ and variance v =
// 1/(12N³), so Var = (N³−1)²/(144 N⁶ (N−1)) + v/2 + v². Leading term 1/(144N), that of the residual from additivity (M.
// Stein, "Large sample properties of simulations using Latin hypercube sampling", 1987).
//
// 32768 estimates: sums of N = 25 or 97 terms, nearly normal; false alarm 1e-7 a side, each.
TEST(NRooks, VariancesOfASumAndOfAProductAreTheLatinHypercubes) {
  constexpr std::uint32_t kGroups = 2048;
  constexpr double kEstimates = kGroups * kLanes;
  const auto sampler = sampler_named("n-rooks");
  for (const std::uint64_t count : {25u, 97u}) {
    const double n = static_cast<double>(count), cube = n * n * n, v = 1 / (12 * cube);
    const std::array<double, 2> exact = {2 * v, std::pow(cube - 1, 2) / (144 * cube * cube * (n - 1)) + v / 2 + v * v};
    std::array<double, 2> sum = {}, squares = {};
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, count, {{2}}, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        std::array<double, 2> error = {};
        for (std::uint64_t i = 0; i < count; ++i) {
          const double x = points(0, i, lane), y = points(1, i, lane);
          error[0] += (x + y - 1) / n;
          error[1] += (x * y - 0.25) / n;
        }
        for (std::size_t f = 0; f < 2; ++f) {
          sum[f] += error[f];
          squares[f] += error[f] * error[f];
        }
      }
    }
    for (std::size_t f = 0; f < 2; ++f) {
      const double chi = (squares[f] - sum[f] * sum[f] / kEstimates) / exact[f];
      EXPECT_LT(chi, chi_squared_upper(kEstimates - 1, 1e-7)) << count << " f" << f;
      EXPECT_GT(chi, chi_squared_lower(kEstimates - 1, 1e-7)) << count << " f" << f;
      EXPECT_LT(std::abs(sum[f]) / std::sqrt(kEstimates * exact[f]), 5.4) << "bias, " << count << " f" << f;
    }
  }
}

// The same product's leading term where permutations are walked instead of shuffled: 1024 estimates of N = 8192, χ²
// within its bound, false alarm 1e-7 a side.
TEST(NRooks, LargeCountsKeepTheVarianceOfAProduct) {
  constexpr std::uint32_t kGroups = 64;
  constexpr std::uint64_t kCount = 8192;
  constexpr double kEstimates = kGroups * kLanes;
  const auto sampler = sampler_named("n-rooks");
  double squares = 0;
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const Points points = points_of(*sampler, kCount, {{2}}, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      double error = 0;
      for (std::uint64_t i = 0; i < kCount; ++i) error += (points(0, i, lane) * points(1, i, lane) - 0.25) / kCount;
      squares += error * error;
    }
  }
  const double chi = squares * 144 * (kCount - 1);  // v/2 is 1e-7 of it
  EXPECT_LT(chi, chi_squared_upper(kEstimates, 1e-7));
  EXPECT_GT(chi, chi_squared_lower(kEstimates, 1e-7));
}

}  // namespace
}  // namespace halfslope
