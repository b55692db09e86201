#include "samplers/rotation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kLayout = {{2, 1, 2}};
constexpr std::uint64_t kLowMask = (1u << 21) - 1;

struct Pair {
  const char *plain, *rotated;
};
constexpr Pair kPairs[] = {{"halton", "halton-cp"}, {"hammersley", "hammersley-cp"}, {"sobol", "sobol-cp"}};

TEST(Rotation, ShiftsEveryPointOfADimensionAlikeModuloOne) {
  for (const auto& [plain, rotated] : kPairs) {
    const Points from = points_of(*sampler_named(plain), 1000, kLayout);
    const Points to = points_of(*sampler_named(rotated), 1000, kLayout);
    for (int dim = 0; dim < kLayout.dims(); ++dim) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto shift = [&](std::uint64_t i) {
          const std::uint64_t a = from.at(dim, i, lane), b = to.at(dim, i, lane);
          return std::array{static_cast<std::uint32_t>((b >> 21) - (a >> 21)),
                            static_cast<std::uint32_t>((b - a) & kLowMask)};
        };
        for (std::uint64_t i = 1; i < 1000; ++i) ASSERT_EQ(shift(i), shift(0)) << rotated << ' ' << dim << ' ' << i;
        // As numbers: the differences of points are those of the plain ones modulo 1, but for a carry of 2⁻³².
        for (std::uint64_t i = 1; i < 1000; ++i) {
          const double moved = to(dim, i, lane) - to(dim, 0, lane) - (from(dim, i, lane) - from(dim, 0, lane));
          ASSERT_LE(std::abs(moved - std::round(moved)), 0x1p-32) << rotated << ' ' << dim << ' ' << i;
        }
      }
    }
  }
}

TEST(Rotation, ShiftsAreUniformAndIndependentBetweenDimensions) {
  // The first point of each is the origin, so it is the shift. 65536 replicates; each dimension's first and last eight
  // bits (255 degrees), and 16 × 16 bins of every two dimensions: false alarm 1e-8 for each of 60.
  for (const auto& [plain, rotated] : kPairs) {
    const auto sampler = sampler_named(rotated);
    std::array<std::array<std::uint32_t, 256>, 5> top = {}, bottom = {};
    std::array<std::array<std::array<std::uint32_t, 256>, 5>, 5> joint = {};
    for (std::uint32_t group = 0; group < 4096; ++group) {
      const Points points = points_of(*sampler, 1, kLayout, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        for (std::size_t d = 0; d < 5; ++d) {
          const std::uint64_t x = points.at(static_cast<int>(d), 0, lane);
          ++top[d][x >> 45];
          ++bottom[d][x & 255];
          for (std::size_t e = 0; e < d; ++e)
            ++joint[d][e][x >> 49 << 4 | points.at(static_cast<int>(e), 0, lane) >> 49];
        }
      }
    }
    const auto bounded = [](const std::array<std::uint32_t, 256>& counts) {
      return chi_squared(std::span<const std::uint32_t>(counts)) < chi_squared_upper(255, 1e-8);
    };
    for (std::size_t d = 0; d < 5; ++d) {
      EXPECT_TRUE(bounded(top[d]) && bounded(bottom[d])) << rotated << ' ' << d;
      for (std::size_t e = 0; e < d; ++e) EXPECT_TRUE(bounded(joint[d][e])) << rotated << ' ' << d << ' ' << e;
    }
  }
}

// Of the mean of f = x over i/N shifted by u modulo 1: the fractional part of N·u alone moves it, uniformly over a
// width of 1/N, so its variance is 1/(12N²), and the mean itself is ½. 32768 estimates U/N − 1/(2N) with U uniform;
// kurtosis below 3, so the χ² bounds are wide enough. False alarm 1e-7 a side.
TEST(Rotation, VarianceOfTheMeanIsThatOfARotatedGrid) {
  constexpr std::uint32_t kGroups = 2048;
  constexpr double kEstimates = kGroups * kLanes;
  const auto sampler = sampler_named("hammersley-cp");
  for (const std::uint64_t count : {5u, 16u, 37u}) {
    const double n = static_cast<double>(count);
    double sum = 0, squares = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, count, {{1}}, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        double error = 0;
        for (std::uint64_t i = 0; i < count; ++i) error += (points(0, i, lane) - 0.5) / n;
        sum += error;
        squares += error * error;
      }
    }
    const double chi = squares * 12 * n * n;
    EXPECT_LT(chi, chi_squared_upper(kEstimates, 1e-7)) << count;
    EXPECT_GT(chi, chi_squared_lower(kEstimates, 1e-7)) << count;
    EXPECT_LT(std::abs(sum) * n * std::sqrt(12 / kEstimates), 5.4) << "bias, " << count;
  }
}

}  // namespace
}  // namespace halfslope
