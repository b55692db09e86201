#include "samplers/halton_owen.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "samplers/radical_inverse.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

TEST(HaltonOwen, EveryElementaryIntervalHoldsOnePointOfEveryBlock) {
  // Points m·M … (m+1)·M − 1 with M = 2^k·3^l·5^n: one in each box of 2^k × 3^l × 5^n equal intervals.
  const auto sampler = sampler_named("halton-owen");
  const Points points = points_of(*sampler, 20000, singles(3));
  for (std::uint64_t a = 1; a <= 2000; a *= 2) {
    for (std::uint64_t b = 1; a * b <= 2000; b *= 3) {
      for (std::uint64_t c = 1; a * b * c <= 2000; c *= 5) {
        const std::uint64_t boxes = a * b * c, blocks = std::min<std::uint64_t>(13, points.count() / boxes);
        std::vector<std::uint64_t> seen(boxes);
        for (int lane = 0; lane < kLanes; ++lane) {
          std::fill(seen.begin(), seen.end(), 0);
          for (std::uint64_t i = 0; i < blocks * boxes; ++i) {
            const std::uint64_t box = (points.interval(0, i, lane, a) * b + points.interval(1, i, lane, b)) * c +
                                      points.interval(2, i, lane, c);
            ASSERT_EQ(seen[box]++, i / boxes) << a << '*' << b << '*' << c << " point " << i << " lane " << lane;
          }
        }
      }
    }
  }
}

TEST(HaltonOwen, FirstPowerOfTheBaseHasOnePointInEachInterval) {
  // In dims 0 … 9 every power up to 2000; in all others the first power.
  const auto sampler = sampler_named("halton-owen");
  const Points points = points_of(*sampler, 2048, singles(304));
  for (int dim = 0; dim < 304; ++dim) {
    const std::uint64_t base = primes()[static_cast<std::size_t>(dim)];
    for (std::uint64_t power = base; power <= 2048; power = dim < 10 ? power * base : ~0ull) {
      for (int lane = 0; lane < kLanes; ++lane) {
        std::vector<int> seen(power);
        for (std::uint64_t i = 0; i < power; ++i) ++seen[points.interval(dim, i, lane, power)];
        ASSERT_EQ(seen, std::vector<int>(power, 1)) << "dim " << dim << " power " << power << " lane " << lane;
      }
    }
  }
}

TEST(HaltonOwen, LastLegalPointsStandInTheirParentsIntervals) {
  // Index i = j + a·b^k has the first k digits of index j (its top digit cut off), and another digit k.
  const auto sampler = sampler_named("halton-owen");
  for (const int dims : {1, 2, 5, 1024}) {
    const Layout layout = singles(dims);
    std::uint64_t most = std::uint64_t{1} << 31;
    if (const auto neighbours = sampler->illegal(most + 1, layout)) most = neighbours->below.value();
    EXPECT_FALSE(sampler->illegal(most, layout)) << dims;
    const int dim = dims - 1;
    const std::uint64_t base = primes()[static_cast<std::size_t>(dim)];
    sampler->prepare(
        {.count = most, .layout = &layout, .key = kTestKey, .pixel = 0, .replicate = 0, .low_words = true});
    for (const std::uint64_t back : {1, 2, 3, 1000, 123456}) {
      const std::uint64_t index = most - back;
      std::uint64_t power = 1;
      while (power * base <= index) power *= base;
      PointBlock child, parent;
      child.reset(dims, 1, true), parent.reset(dims, 1, true);
      sampler->fill(index, child);
      sampler->fill(index % power, parent);
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto digits = [&](const PointBlock& block, std::uint64_t intervals) {
          return static_cast<std::uint64_t>(static_cast<long double>(block.coordinate(dim, 0, lane)) *
                                            static_cast<long double>(intervals));
        };
        EXPECT_EQ(digits(child, power), digits(parent, power)) << dims << " index " << index << " lane " << lane;
        EXPECT_NE(digits(child, power * base), digits(parent, power * base)) << dims << " index " << index;
      }
    }
  }
}

TEST(HaltonOwen, CountsBeyond31BitsOfDigitsAreIllegal) {
  const auto sampler = sampler_named("halton-owen");
  EXPECT_EQ(sampler->illegal((1ull << 31) + 1, singles(1))->below, 1ull << 31);
  EXPECT_EQ(sampler->illegal(1ull << 31, singles(2))->below, 1162261467u);  // 3¹⁹
  EXPECT_EQ(sampler->illegal(1162261468u, singles(2))->above, std::nullopt);
  EXPECT_FALSE(sampler->illegal(1162261467u, singles(2)));
  EXPECT_EQ(sampler->illegal(0, singles(2))->above, 1u);
}

// Of the mean of f = x over the first N = a·b^k points, 1 ≤ a ≤ b: each interval of length w = b^−k holds a points in a
// different subintervals of length w/b, chosen uniformly, each uniform inside its own; intervals are independent,
// because their nodes' permutations are. A subinterval's number has variance (b²−1)/12, a of them without replacement
// have 1 − (a−1)/(b−1) of a times that, so
//   Var = (1/N²) · b^k · a · (w/b)² · [(b²−1)/12 · (1 − (a−1)/(b−1)) + 1/12].
// A scramble that used one permutation for a whole depth would have up to b^k times the first part. 32768 estimates,
// nearly normal; false alarm 1e-8 a side for each of 11 counts.
TEST(HaltonOwen, VarianceOfTheMeanIsNestedScramblings) {
  constexpr std::uint32_t kGroups = 2048;
  constexpr double kEstimates = kGroups * kLanes;
  struct Case {
    int dim;
    std::uint64_t lead, power;
  };
  const auto sampler = sampler_named("halton-owen");
  for (const Case& c : {Case{0, 1, 16}, Case{0, 1, 64}, Case{1, 1, 27}, Case{1, 2, 27}, Case{2, 1, 25}, Case{2, 2, 25},
                        Case{2, 3, 25}, Case{2, 4, 25}, Case{3, 3, 49}, Case{4, 5, 11}, Case{9, 2, 29}}) {
    const double b = primes()[static_cast<std::size_t>(c.dim)], a = static_cast<double>(c.lead);
    const double intervals = static_cast<double>(c.power), n = a * intervals;
    const double exact =
        intervals * a / (n * n) / std::pow(intervals * b, 2) * ((b * b - 1) / 12 * (1 - (a - 1) / (b - 1)) + 1.0 / 12);
    double sum = 0, squares = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, c.lead * c.power, singles(c.dim + 1), group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        double error = 0;
        for (std::uint64_t i = 0; i < points.count(); ++i) error += (points(c.dim, i, lane) - 0.5) / n;
        sum += error;
        squares += error * error;
      }
    }
    const double chi = (squares - sum * sum / kEstimates) / exact;
    EXPECT_LT(chi, chi_squared_upper(kEstimates - 1, 1e-8)) << b << ' ' << n;
    EXPECT_GT(chi, chi_squared_lower(kEstimates - 1, 1e-8)) << b << ' ' << n;
    EXPECT_LT(std::abs(sum) / std::sqrt(kEstimates * exact), 5.8) << "bias, " << b << ' ' << n;
  }
}

}  // namespace
}  // namespace halfslope
