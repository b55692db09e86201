// The scrambles themselves: what each node of the digits' tree does, over replicates.
#include <gtest/gtest.h>

#include <set>

#include "tests/samplers/binary_scrambles.h"

namespace halfslope {
namespace {

class SobolOwenNodes : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scrambles, SobolOwenNodes, testing::Values("sobol-owen", "sobol-owen-fast"),
                         [](const auto& test) { return test.param == "sobol-owen" ? "exact" : "fast"; });

TEST_P(SobolOwenNodes, FlipFairlyAndEveryTwoIndependently) {
  for (const auto& [dim, deepest] : {std::pair{0, 30}, std::pair{1, 26}, std::pair{6, 18}}) {
    const std::vector<Digit> nodes = nodes_to_test(deepest);
    const Imbalance found = worst_imbalance(coins_of(scramble_of(GetParam(), dim, words_in(nodes)), nodes));
    EXPECT_LT(found.one, 1) << dim;
    EXPECT_LT(found.two, 1) << dim;
  }
}

TEST_P(SobolOwenNodes, All53DigitsOfPointsAreFairAndIndependent) {
  // Neighbours in every depth, and one far away: 5 × 53 coins.
  std::vector<Digit> digits;
  for (const std::uint32_t y : {0u, 0x80000000u, 0x40000000u, 0x00010000u, 0xb5c0fbcau}) {
    for (int place = 0; place < 53; ++place) digits.push_back({y, place});
  }
  const Scramble scramble = scramble_of(GetParam(), 0, words_in(digits));
  // As flips: a digit of two points with the same digits above it is the same coin, flipped or not, so only the first
  // of each node counts.
  std::vector<Digit> nodes;
  std::set<std::pair<int, std::uint32_t>> seen;
  for (const auto& [y, place] : digits) {
    const bool is_new = place >= 32 || seen.insert({place, place ? y >> (32 - place) : 0}).second;
    if (is_new) nodes.push_back({y, place});
  }
  ASSERT_GT(nodes.size(), 220u);
  const Imbalance found = worst_imbalance(coins_of(scramble, nodes));
  EXPECT_LT(found.one, 1);
  EXPECT_LT(found.two, 1);
}

TEST_P(SobolOwenNodes, DimensionsAreIndependent) {
  const std::vector<Digit> nodes = nodes_to_test(6);
  std::vector<Coin> coins;
  for (const int dim : {0, 1, 2, 7}) {
    for (Coin& coin : coins_of(scramble_of(GetParam(), dim, words_in(nodes)), nodes)) coins.push_back(std::move(coin));
  }
  const Imbalance found = worst_imbalance(coins);
  EXPECT_LT(found.one, 1);
  EXPECT_LT(found.two, 1);
}

TEST_P(SobolOwenNodes, PointsPartWhereTheirDigitsDo) {
  // The definition of nesting: two points share exactly as many first digits as the unscrambled ones, whatever they
  // are.
  const Points plain = points_of(*sampler_named("sobol"), 1500, singles(4));
  const Points scrambled = points_of(*sampler_named(GetParam()), 1500, singles(4));
  for (int d = 0; d < 4; ++d) {
    for (std::uint64_t i = 0; i < 1500; i += 3) {
      for (std::uint64_t j = 0; j < i; ++j) {
        ASSERT_EQ(std::countl_zero(plain.at(d, i, 0) ^ plain.at(d, j, 0)),
                  std::countl_zero(scrambled.at(d, i, 3) ^ scrambled.at(d, j, 3)));
      }
    }
  }
}

/// Coins of the seven nodes of the first three levels.
std::vector<Coin> first_levels(const Scramble& scramble) {
  std::vector<Digit> nodes = nodes_to_test(0);
  nodes.resize(7);
  return coins_of(scramble, nodes);
}

/// How many different settings of those the replicates show.
std::size_t settings(const std::vector<Coin>& coins) {
  std::set<std::uint32_t> seen;
  for (std::uint32_t r = 0; r < kScrambles; ++r) {
    std::uint32_t setting = 0;
    for (const Coin& coin : coins) setting = setting << 1 | (coin[r / 64] >> (r % 64) & 1u);
    seen.insert(setting);
  }
  return seen.size();
}

TEST(SobolOwen, AllNodesOfTheFirstLevelsTogetherAreIndependent) {
  // All 127 parities of the seven coins are fair, which is joint independence. 1e-8 for each.
  for (const int dim : {0, 3}) {
    const std::vector<Coin> coins = first_levels(scramble_of("sobol-owen", dim, words_in(nodes_to_test(0))));
    for (std::uint32_t subset = 1; subset < 128; ++subset) {
      Coin parity(kScrambles / 64);
      for (std::size_t c = 0; c < coins.size(); ++c) {
        if (subset >> c & 1u) parity = exclusive_or(parity, coins[c]);
      }
      EXPECT_LT(imbalance(parity), imbalance_bound(1e-8)) << dim << ' ' << subset;
    }
    EXPECT_EQ(settings(coins), 128u);
  }
}

TEST(SobolOwenFast, OnlyPairsOfNodesAreIndependent) {
  // The first three digits hang on the lowest three bits of the number added and on two of the number multiplied: of
  // the 128 settings of seven coins there are 32.
  EXPECT_LE(settings(first_levels(scramble_of("sobol-owen-fast", 0, words_in(nodes_to_test(0))))), 32u);
}

std::uint32_t reversed(std::uint32_t word) {
  std::uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit) result |= (word >> bit & 1u) << (31 - bit);
  return result;
}

/// B. Burley, "Practical hash-based Owen scrambling" (2020).
std::uint32_t burley(std::uint32_t y, std::uint32_t seed) {
  std::uint32_t x = reversed(y) + seed;
  for (const std::uint32_t factor : {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u}) x ^= x * factor;
  return reversed(x);
}

std::uint32_t seed_of(std::uint32_t replicate) { return random_word(kTestKey, Draw::kScramble, 0, 0, replicate, 0); }

constexpr int kDeepest = 6;

/// Nested scrambling of digits 0 to kDeepest by its definition, the coin of a node being the one of name(k, the k
/// digits above).
template <class Name>
Scramble by_definition(Name name) {
  return [name](std::uint32_t r, std::uint32_t y) {
    std::uint32_t x = y;
    for (int k = 0; k < kDeepest + 1; ++k) {
      const std::uint32_t node = name(k, k ? y >> (32 - k) : 0);
      x ^= (random_word(kTestKey, Draw::kScramble, 1, node, r, 0) & 1u) << (31 - k);
    }
    return std::uint64_t{x} << 21;
  };
}

TEST(SobolOwenNodes, TheTestRejectsTheHashOf2020AndScramblesThatForget) {
  // The copy is the hash: values computed elsewhere.
  ASSERT_EQ(burley(0, 1), 2792218860u);
  ASSERT_EQ(burley(0xffffffffu, 0), 3708528615u);
  ASSERT_EQ(burley(0xffffffffu, 0xffffffffu), 1854264307u);
  ASSERT_EQ(burley(1, 0), 1u);

  const std::vector<Digit> nodes = nodes_to_test(kDeepest);
  const Imbalance of_2020 = worst_imbalance(
      coins_of([](std::uint32_t r, std::uint32_t y) { return std::uint64_t{burley(y, seed_of(r))} << 21; }, nodes));
  EXPECT_LT(of_2020.one, 1);
  EXPECT_GT(of_2020.two, 8) << "a correlation of one half";

  const Imbalance no_depth =
      worst_imbalance(coins_of(by_definition([](int, std::uint32_t above) { return above; }), nodes));
  EXPECT_LT(no_depth.one, 1);
  EXPECT_GT(no_depth.two, 8) << "the same coin at every depth";
  const Imbalance no_node = worst_imbalance(
      coins_of(by_definition([](int k, std::uint32_t) { return static_cast<std::uint32_t>(k); }), nodes));
  EXPECT_GT(no_node.two, 8) << "one coin a depth";

  const Imbalance nested =
      worst_imbalance(coins_of(by_definition([](int k, std::uint32_t above) { return 1u << k | above; }), nodes));
  EXPECT_LT(nested.one, 1);
  EXPECT_LT(nested.two, 1);
}

}  // namespace
}  // namespace halfslope
