// Jittered points in d dimensions: with one point in each of N = n^d cells only what varies inside a cell is left, so
// the RMSE falls like N^(−1/2 − 1/d) for a smooth integrand, whose variation in a cell is of order 1/n, and like
// N^(−1/2 − 1/(2d)) for a step, which cuts one cell in n.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scenes/integrand.h"
#include "tests/estimators/estimates.h"

namespace halfslope {
namespace {

constexpr int kReplicates = 512;

/// The slope of log RMSE against log N by least squares, over n^d points for each n of `sides`.
double rate(const std::string& scene, int dims, const std::vector<int>& sides) {
  const auto source = make_analytic_scene(scene);
  const double exact = (*source->closed_form(0))[0];
  double x_sum = 0, y_sum = 0, xx = 0, xy = 0;
  for (const int side : sides) {
    std::uint64_t count = 1;
    for (int d = 0; d < dims; ++d) count *= static_cast<std::uint64_t>(side);
    const Request request = {"mean", "jittered", count, kReplicates, 7};
    const auto estimates = estimate<double>(*source, 0, request);
    double squares = 0;
    for (const double value : estimates[0]) squares += (value - exact) * (value - exact);
    const double x = std::log(static_cast<double>(count)), y = 0.5 * std::log(squares / kReplicates);
    x_sum += x, y_sum += y, xx += x * x, xy += x * y;
  }
  const auto n = static_cast<double>(sides.size());
  return (n * xy - x_sum * y_sum) / (n * xx - x_sum * x_sum);
}

// An RMSE of 512 replicates has a standard error of 1/√1024 in its logarithm, so a slope over these N, which span a
// factor of 64 or more in 5 or 6 steps, has one of 0.01 at most. 0.06 is 5 of them (6e-7) and what small n are off the
// limit: 0.01.
TEST(JitteredCurse, RatesFallWithTheDimension) {
  const std::vector<std::vector<int>> sides = {{16, 48, 160, 500, 1500, 5000},
                                               {4, 8, 16, 32, 64, 96},
                                               {4, 6, 9, 14, 21},
                                               {3, 4, 6, 8, 11},
                                               {3, 4, 5, 6, 7},
                                               {2, 3, 4, 5, 6}};
  for (int d = 1; d <= 6; ++d) {
    const std::string dims = ":d=" + std::to_string(d);
    const auto& n = sides[static_cast<std::size_t>(d - 1)];
    EXPECT_NEAR(rate("genz-gaussian" + dims, d, n), -0.5 - 1.0 / d, 0.06) << d;
    EXPECT_NEAR(rate("halfspace" + dims, d, n), -0.5 - 0.5 / d, 0.06) << d;
  }
}

}  // namespace
}  // namespace halfslope
