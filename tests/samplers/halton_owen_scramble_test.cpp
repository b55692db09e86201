// The scramble itself: what each node of the digits' tree does, over replicates.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "samplers/radical_inverse.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

/// Digit k of the scrambled point `index` in a replicate.
using Digit = std::function<std::uint64_t(std::uint32_t replicate, std::uint64_t index, int k)>;

constexpr std::uint32_t kReplicates = 32768;

struct Dependence {
  double marginal, joint;  // the worst χ² of a node and of a pair of nodes, over its bound
};

/// A node (k, j < b^k) of the tree permutes digit k by π; where it sends 0 and 1 is one of b(b−1) equally likely pairs,
/// independent between nodes. Nodes above `levels`. Bounds at 1e-9 each, at most 105 pairs of nodes.
Dependence dependence(std::uint64_t base, int levels, const Digit& digit) {
  struct Node {
    int k;
    std::uint64_t prefix, power;
  };
  std::vector<Node> nodes;
  std::uint64_t power = 1;
  for (int k = 0; k < levels; ++k, power *= base) {
    for (std::uint64_t j = 0; j < power; ++j) nodes.push_back({k, j, power});
  }
  const std::uint64_t kinds = base * (base - 1);
  std::vector<std::vector<std::uint32_t>> kind(nodes.size(), std::vector<std::uint32_t>(kReplicates));
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Node& node = nodes[n];
    for (std::uint32_t r = 0; r < kReplicates; ++r) {
      const std::uint64_t zero = digit(r, node.prefix, node.k), one = digit(r, node.prefix + node.power, node.k);
      kind[n][r] = static_cast<std::uint32_t>(zero * (base - 1) + (one > zero ? one - 1 : one));
    }
  }
  Dependence worst = {0, 0};
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    std::vector<std::uint32_t> single(kinds);
    for (const std::uint32_t at : kind[n]) ++single[at];
    worst.marginal = std::max(worst.marginal, chi_squared(std::span<const std::uint32_t>(single)) /
                                                  chi_squared_upper(static_cast<double>(kinds - 1), 1e-9));
    for (std::size_t m = 0; m < n; ++m) {
      std::vector<std::uint32_t> pair(kinds * kinds);
      for (std::uint32_t r = 0; r < kReplicates; ++r) ++pair[kind[n][r] * kinds + kind[m][r]];
      worst.joint = std::max(worst.joint, chi_squared(std::span<const std::uint32_t>(pair)) /
                                              chi_squared_upper(static_cast<double>(kinds * kinds - 1), 1e-9));
    }
  }
  return worst;
}

/// Points 0 … count − 1 of dimension `dim` in every replicate.
std::vector<Points> replicates(int dim, std::uint64_t count) {
  std::vector<Points> points;
  const auto sampler = sampler_named("halton-owen");
  for (std::uint32_t r = 0; r < kReplicates; r += kLanes)
    points.push_back(points_of(*sampler, count, singles(dim + 1), r));
  return points;
}

class HaltonOwenNodes : public testing::TestWithParam<std::array<int, 2>> {};

TEST_P(HaltonOwenNodes, PermuteUniformlyAndIndependently) {
  const auto [dim, levels] = GetParam();
  const std::uint64_t base = primes()[static_cast<std::size_t>(dim)];
  std::vector<std::uint64_t> powers = {1};
  for (int k = 0; k <= levels; ++k) powers.push_back(powers.back() * base);
  const auto points = replicates(dim, powers[static_cast<std::size_t>(levels)]);
  const Dependence found = dependence(base, levels, [&, dim = dim](std::uint32_t r, std::uint64_t index, int k) {
    const std::uint64_t intervals = powers[static_cast<std::size_t>(k) + 1];
    return points[r / kLanes].interval(dim, index, static_cast<int>(r % kLanes), intervals) % base;
  });
  EXPECT_LT(found.marginal, 1);
  EXPECT_LT(found.joint, 1);
}
INSTANTIATE_TEST_SUITE_P(Bases, HaltonOwenNodes, testing::Values(std::array{0, 4}, std::array{1, 3}, std::array{2, 2}));

// What the test above must reject: scrambles whose nodes share permutations a ↦ g + h·a (mod b). `share` names the
// permutation that a node uses.
Dependence shared(std::uint64_t base, int levels, const std::function<std::uint32_t(int, std::uint64_t)>& share) {
  return dependence(base, levels, [&](std::uint32_t r, std::uint64_t index, int k) {
    std::uint64_t power = 1;
    for (int i = 0; i < k; ++i) power *= base;
    const std::uint32_t name = share(k, index % power);
    const std::uint64_t g = (random_word(kTestKey, Draw::kScramble, 0, name, r, 0) * base) >> 32;
    const std::uint64_t h = 1 + ((random_word(kTestKey, Draw::kScramble, 1, name, r, 0) * (base - 1)) >> 32);
    return (g + h * (index / power % base)) % base;
  });
}

TEST(HaltonOwenNodes, TheTestRejectsPermutationsThatIgnoreDigitsOrDepth) {
  for (const auto& [base, levels] : {std::pair{2, 3}, std::pair{3, 3}, std::pair{5, 2}}) {
    const auto b = static_cast<std::uint64_t>(base);
    const Dependence everywhere = shared(b, levels, [](int, std::uint64_t) { return 0u; });
    EXPECT_LT(everywhere.marginal, 1);
    EXPECT_GT(everywhere.joint, 10) << "one permutation for all nodes, base " << base;
    const Dependence by_depth = shared(b, levels, [](int k, std::uint64_t) { return static_cast<std::uint32_t>(k); });
    EXPECT_GT(by_depth.joint, 10) << "one permutation a depth, base " << base;
    const Dependence by_digits = shared(b, levels, [](int, std::uint64_t j) { return static_cast<std::uint32_t>(j); });
    EXPECT_GT(by_digits.joint, 10) << "the same permutations at every depth, base " << base;
    const Dependence nested = shared(b, levels, [](int k, std::uint64_t j) {
      return static_cast<std::uint32_t>(1000 * static_cast<std::uint64_t>(k) + j);
    });
    EXPECT_LT(nested.joint, 1) << "true nested scrambling, base " << base;
  }
}

TEST(HaltonOwen, TwoPointsOfAStratumTakeAUniformPairOfDistinctDigits) {
  // Points j + a·b^k and j + a'·b^k share their first k digits; digits k of the two are distinct, each of the b(b−1)
  // pairs equally likely, whatever a ≠ a'. 32768 replicates; 1e-9 for each of about 70 pairs.
  for (const auto& [dim, k] : {std::pair{2, 1}, std::pair{3, 1}, std::pair{4, 0}, std::pair{5, 0}}) {
    const std::uint64_t base = primes()[static_cast<std::size_t>(dim)];
    const std::uint64_t power = k ? base : 1, j = k ? 2 : 0;
    const auto points = replicates(dim, power * base);
    for (std::uint64_t a = 1; a < base; ++a) {
      for (const std::uint64_t other : {std::uint64_t{0}, a / 2, a - 1}) {
        std::vector<std::uint32_t> counts(base * base);
        for (const Points& p : points) {
          for (int lane = 0; lane < kLanes; ++lane) {
            const std::uint64_t first = p.interval(dim, j + a * power, lane, power * base);
            const std::uint64_t second = p.interval(dim, j + other * power, lane, power * base);
            ASSERT_EQ(first / base, second / base);
            ASSERT_NE(first % base, second % base);
            ++counts[first % base * base + second % base];
          }
        }
        std::vector<std::uint32_t> distinct;
        for (std::uint64_t c = 0; c < base * base; ++c) {
          if (c / base != c % base) distinct.push_back(counts[c]);
        }
        EXPECT_LT(chi_squared(std::span<const std::uint32_t>(distinct)),
                  chi_squared_upper(static_cast<double>(base * (base - 1) - 1), 1e-9))
            << "base " << base << " digits " << a << ' ' << other;
      }
    }
  }
}

TEST(HaltonOwen, TailsAreUniformAndIndependentBetweenIndicesAndDimensions) {
  // Below its own t digits a point is uniform, independent of every other index's tail. Tails of two indices, or of two
  // dimensions, in 16 × 16 bins: χ² with 255 degrees, false alarm 1e-9 for each of about 400.
  constexpr std::uint64_t kCount = 72;
  for (const int dim : {0, 1, 2}) {
    const std::uint64_t base = primes()[static_cast<std::size_t>(dim)];
    const auto points = replicates(2, kCount);
    const auto tail = [&](std::uint32_t r, std::uint64_t index, int d) {
      const std::uint64_t b = primes()[static_cast<std::size_t>(d)];
      std::uint64_t own = 1;
      while (own <= index) own *= b;
      return points[r / kLanes].interval(d, index, static_cast<int>(r % kLanes), own * 16) % 16;
    };
    const auto check = [&](std::uint64_t i, int d, std::uint64_t j, int e) {
      std::array<std::uint32_t, 256> counts = {};
      for (std::uint32_t r = 0; r < kReplicates; ++r) ++counts[tail(r, i, d) * 16 + tail(r, j, e)];
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(counts)), chi_squared_upper(255, 1e-9))
          << "base " << base << " indices " << i << ' ' << j << " dims " << d << ' ' << e;
    };
    for (std::uint64_t i = 0; i + 1 < kCount; ++i) check(i, dim, i + 1, dim);
    for (std::uint64_t bit = 2; bit <= 64; bit *= 2) {
      for (const std::uint64_t i : {0, 3, 7}) check(i, dim, i + bit < kCount ? i + bit : bit, dim);
    }
    for (std::uint64_t i = 0; i < 24; ++i) check(i, dim, i, (dim + 1) % 3);
  }
}

}  // namespace
}  // namespace halfslope
