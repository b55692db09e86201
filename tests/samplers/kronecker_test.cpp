#include "samplers/kronecker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/samplers/points.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kMask = (std::uint64_t{1} << 53) - 1;

/// α_k of a number of dimensions to 96 bits, and the first 64 bits of (2³¹ − 1) α_k modulo 1: by Newton's method in
/// decimals of 120 digits. The first is the golden ratio less 1, the next two are powers of the plastic number (OEIS
/// A060006).
struct Known {
  int dims, k;
  std::uint64_t high;
  std::uint32_t low;
  std::uint64_t far;
};
constexpr Known kKnown[] = {
    {1, 1, 0x9e3779b97f4a7c15u, 0xf39cc060u, 2408797229939942426u},
    {2, 1, 0xc13fa9a902a6328fu, 0x434ff71bu, 13840528806902876414u},
    {2, 2, 0x91e10da5c79e7b1cu, 0xd438a0a8u, 5903708837734372663u},
    {8, 1, 0xebedeed9d803c815u, 0x63353b4eu, 5617614715278738u},
    {8, 2, 0xd96eb1a810caaf5eu, 0xb074c5deu, 3384074720208991120u},
    {8, 8, 0x8538ecb5bd456ea2u, 0x1578d2fcu, 6442903510298589916u},
    {1024, 1, 0xffd3acdb6d435426u, 0xbe6dfdd9u, 13172462901852875461u},
    {1024, 2, 0xffa761638a19d588u, 0x80257a93u, 14223926046582433729u},
    {1024, 1024, 0x800b15becfe62c25u, 0xa7c87772u, 16710606778202460051u},
};

TEST(Kronecker, StepsAreRightToNinetySixBits) {
  for (const Known& known : kKnown) {
    const LongFraction step = kronecker_steps(known.dims)[static_cast<std::size_t>(known.k - 1)];
    EXPECT_EQ(step.high, known.high) << known.dims << ' ' << known.k;
    EXPECT_EQ(step.low, known.low) << known.dims << ' ' << known.k;
  }
}

TEST(Kronecker, TheLastPointOfAllIsStillExact) {
  constexpr std::uint64_t kLast = (std::uint64_t{1} << 31) - 1;
  for (const Known& known : kKnown) {
    const Layout layout = singles(known.dims);
    const auto sampler = make_kronecker();
    sampler->prepare({.count = kLast + 1, .layout = &layout, .key = kTestKey, .low_words = true});
    PointBlock first, last;
    first.reset(known.dims, 1, true);
    last.reset(known.dims, 1, true);
    sampler->fill(0, first);
    sampler->fill(kLast, last);
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto bits = [&](const PointBlock& block) {
        return std::uint64_t{block.high(known.k - 1)[lane]} << 21 | block.low(known.k - 1)[lane];
      };
      // The shift has bits below 2⁻⁵³, so the cut moves a difference by up to one unit.
      const std::uint64_t moved = (bits(last) - bits(first) - (known.far >> 11)) & kMask;
      EXPECT_LE(moved, 1u) << known.dims << ' ' << known.k;
    }
  }
}

TEST(Kronecker, FibonacciNumbersOfPointsComeBackAsNearAsTheoryHasIt) {
  // F_k/φ = F_(k−1) − (−1/φ)^k.
  std::uint64_t before = 1, fibonacci = 1;
  const LongFraction step = kronecker_steps(1)[0];
  for (int k = 2; fibonacci < std::uint64_t{1} << 31; ++k) {
    const auto back = static_cast<long double>(static_cast<std::int64_t>(step.multiple(fibonacci))) * 0x1p-64L;
    const long double theory = -std::pow(-1 / std::numbers::phi_v<long double>, k);
    EXPECT_LE(std::abs(back - theory), 1e-17L * std::abs(theory) + 0x1p-63L) << k;
    before = std::exchange(fibonacci, fibonacci + before);
  }
}

TEST(Kronecker, PointsOnACircleHaveThreeDistances) {
  // The three-distance theorem (Sós, Surányi, Świerczkowski): N multiples of any α leave gaps of at most three lengths.
  for (const std::uint64_t count : {10u, 100u, 1000u, 1597u}) {
    const Points points = points_of(*make_kronecker(), count, singles(1));
    std::vector<std::uint64_t> sorted, gaps;
    for (std::uint64_t i = 0; i < count; ++i) sorted.push_back(points.at(0, i, 0));
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size(); ++i)
      gaps.push_back((sorted[(i + 1) % sorted.size()] - sorted[i]) & kMask);
    std::sort(gaps.begin(), gaps.end());
    int lengths = 1;
    for (std::size_t i = 1; i < gaps.size(); ++i) lengths += gaps[i] - gaps[i - 1] > 2;  // but for the cut
    EXPECT_LE(lengths, 3) << count;
  }
}

TEST(Kronecker, TheNumbersBelongToTheNumberOfDimensions) {
  // So the first two dimensions of three are another sequence than two dimensions.
  const Points two = points_of(*make_kronecker(), 2, {{2}}), three = points_of(*make_kronecker(), 2, {{2, 1}});
  EXPECT_EQ(two.at(0, 0, 0), three.at(0, 0, 0));  // the shift
  EXPECT_NE(two.at(0, 1, 0), three.at(0, 1, 0));
}

}  // namespace
}  // namespace halfslope
