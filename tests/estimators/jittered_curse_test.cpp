// Jittered points in d dimensions: with one point in each of N = n^d cells only what varies inside a cell is left, so
// the RMSE falls like N^(−1/2 − 1/d) for a smooth integrand, whose variation in a cell is of order 1/n, and like
// N^(−1/2 − 1/(2d)) for a step, which cuts one cell in n.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/integrand.h"
#include "tests/estimators/estimates.h"

namespace halfslope {
namespace {

constexpr int kReplicates = 512;

double mean_squared_error(const std::string& scene, std::uint64_t count) {
  const auto source = make_analytic_scene(scene);
  const double exact = (*source->closed_form(0))[0];
  const auto estimates = estimate<double>(*source, 0, {"mean", "jittered", count, kReplicates, 7});
  double squares = 0;
  for (const double value : estimates[0]) squares += (value - exact) * (value - exact);
  return squares / kReplicates;
}

/// The slope of log RMSE against log N by least squares, over n^d points for each n of `sides`.
double rate(const std::string& scene, int dims, const std::vector<int>& sides) {
  double x_sum = 0, y_sum = 0, xx = 0, xy = 0;
  for (const int side : sides) {
    std::uint64_t count = 1;
    for (int d = 0; d < dims; ++d) count *= static_cast<std::uint64_t>(side);
    const double x = std::log(static_cast<double>(count)), y = 0.5 * std::log(mean_squared_error(scene, count));
    x_sum += x, y_sum += y, xx += x * x, xy += x * y;
  }
  const auto n = static_cast<double>(sides.size());
  return (n * xy - x_sum * y_sum) / (n * xx - x_sum * x_sum);
}

// An estimate sums over many cells, so it is near normal, and the logarithm of an RMSE of 512 replicates has a standard
// error of 1/√1024 = 0.031. A slope over these N has 0.031 / √Σ(x − x̄)², 0.0079 at most. What small n are off the limit
// is 0.015 at most (the step in five dimensions), which leaves 5.7 standard errors of 0.06: 1e-8 for each comparison.
TEST(JitteredCurse, RatesFallWithTheDimension) {
  const std::vector<std::vector<int>> sides = {{16, 48, 160, 500, 1500, 5000},
                                               {4, 8, 16, 32, 64, 96},
                                               {4, 6, 9, 14, 21},
                                               {3, 4, 6, 8, 11},
                                               {3, 4, 5, 6, 7, 8},
                                               {2, 3, 4, 5, 6}};
  for (int d = 1; d <= 6; ++d) {
    const std::string dims = ":d=" + std::to_string(d);
    const auto& n = sides[static_cast<std::size_t>(d - 1)];
    EXPECT_NEAR(rate("genz-gaussian" + dims, d, n), -0.5 - 1.0 / d, 0.06) << d;
    if (d == 1) continue;  // below
    EXPECT_NEAR(rate("halfspace" + dims, d, n), -0.5 - 0.5 / d, 0.06) << d;
  }
}

// In one dimension the step x/√2 > 1/10 cuts one cell, at the fraction r of it, so an estimate is off by (B − r)/n with
// B = 1 with probability r: E e² = r(1 − r)/n². The mean of e² over the replicates is linear in a binomial number,
// whose 6 standard deviations are passed with a probability below 1e-6 for 512 r (1 − r) > 45.
TEST(JitteredCurse, AStepInOneDimensionHasItsExactError) {
  int tested = 0;
  for (const int n : {7, 16, 48, 100, 500, 1500, 5000}) {
    const double edge = 0.1 * std::numbers::sqrt2 * n, r = edge - std::floor(edge), q = r * (1 - r);
    if (512 * q < 45) continue;
    ++tested;
    // With B − r being 1 − r or −r, the spread of its square is √q |1 − 2r|.
    const double spread = std::sqrt(q / kReplicates) * std::fabs(1 - 2 * r) / q;
    EXPECT_NEAR(mean_squared_error("halfspace:d=1", static_cast<std::uint64_t>(n)) * n * n / q, 1, 6 * spread + 1e-9)
        << n;
  }
  EXPECT_GE(tested, 4);
}

}  // namespace
}  // namespace halfslope
