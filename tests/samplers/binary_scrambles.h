// Scrambles of binary digits and the coins of their nodes, over replicates.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "samplers/sobol_sequence.h"
#include "tests/samplers/points.h"

namespace halfslope {

inline constexpr std::uint32_t kScrambles = 32768;  // replicates

/// Where a replicate's scramble of one coordinate sends the 32 digits y, the first on top: 53 digits.
using Scramble = std::function<std::uint64_t(std::uint32_t replicate, std::uint32_t y)>;

/// The digit of index `place` (0 the first) of where y goes.
struct Digit {
  std::uint32_t y;
  int place;
};

/// A fair coin of each replicate, a bit each.
using Coin = std::vector<std::uint64_t>;

/// Where kScrambles replicates of a Sobol' sampler send each of `ys`, in one dimension.
inline Scramble scramble_of(const std::string& name, int dim, const std::vector<std::uint32_t>& ys) {
  const auto directions = sobol_directions(dim);
  const auto sampler = sampler_named(name);
  const Layout layout = singles(dim + 1);
  std::map<std::uint32_t, std::vector<std::uint64_t>> words;
  PointBlock block;
  block.reset(dim + 1, 1, true);
  for (std::uint32_t r = 0; r < kScrambles; r += kLanes) {
    sampler->prepare({.count = 1ull << 31, .layout = &layout, .key = kTestKey, .replicate = r, .low_words = true});
    for (const std::uint32_t y : ys) {
      // The index whose point is y: number k is the only one of 0 … k that reaches digit k.
      std::uint64_t index = 0;
      std::uint32_t rest = y;
      for (std::size_t k = 32; k-- > 0;) {
        if (rest >> (31 - k) & 1u) rest ^= directions[k], index |= std::uint64_t{1} << k;
      }
      sampler->fill(index, block);
      for (int lane = 0; lane < kLanes; ++lane) {
        words[y].resize(kScrambles);
        words[y][r + static_cast<std::uint32_t>(lane)] =
            std::uint64_t{block.high(dim)[lane]} << 21 | block.low(dim)[lane];
      }
    }
  }
  return [words = std::move(words)](std::uint32_t r, std::uint32_t y) { return words.at(y)[r]; };
}

inline std::vector<std::uint32_t> words_in(const std::vector<Digit>& digits) {
  std::vector<std::uint32_t> ys;
  for (const Digit& digit : digits) ys.push_back(digit.y);
  std::sort(ys.begin(), ys.end());
  ys.erase(std::unique(ys.begin(), ys.end()), ys.end());
  return ys;
}

inline std::vector<Coin> coins_of(const Scramble& scramble, const std::vector<Digit>& digits) {
  std::vector<Coin> coins;
  for (const auto& [y, place] : digits) {
    Coin coin(kScrambles / 64);
    for (std::uint32_t r = 0; r < kScrambles; ++r) coin[r / 64] |= (scramble(r, y) >> (52 - place) & 1) << (r % 64);
    coins.push_back(std::move(coin));
  }
  return coins;
}

/// |heads − tails| / √replicates.
inline double imbalance(const Coin& coin) {
  int heads = 0;
  for (const std::uint64_t word : coin) heads += std::popcount(word);
  return std::abs(2.0 * heads - kScrambles) / std::sqrt(kScrambles);
}
inline Coin exclusive_or(const Coin& a, const Coin& b) {
  Coin both = a;
  for (std::size_t i = 0; i < both.size(); ++i) both[i] ^= b[i];
  return both;
}
/// What the imbalance of a fair coin exceeds with probability at most `alpha` (W. Hoeffding 1963).
inline double imbalance_bound(double alpha) { return std::sqrt(2 * std::log(2 / alpha)); }

struct Imbalance {
  double one = 0, two = 0;  ///< the worst of a coin, and of two coins' exclusive or
};

/// Over the bounds that all coins together pass with probability 1e-8 each if every two of them are independent.
inline Imbalance worst_imbalance(const std::vector<Coin>& coins) {
  Imbalance worst;
  const auto count = static_cast<double>(coins.size());
  for (std::size_t a = 0; a < coins.size(); ++a) {
    worst.one = std::max(worst.one, imbalance(coins[a]) / imbalance_bound(1e-8 / count));
    for (std::size_t b = 0; b < a; ++b) {
      const double two = imbalance(exclusive_or(coins[a], coins[b]));
      worst.two = std::max(worst.two, two / imbalance_bound(1e-8 / (count * count)));
    }
  }
  return worst;
}

/// Every node of the first five levels; deeper ones in families that share all digits but the last, half of them, or
/// the first alone; each node as the digit of the y that ends in zeros from there.
inline std::vector<Digit> nodes_to_test(int deepest) {
  std::vector<Digit> nodes;
  for (int k = 0; k < 5; ++k) {
    for (std::uint32_t prefix = 0; prefix < 1u << k; ++prefix) {
      nodes.push_back({k ? prefix << (32 - k) : 0, k});
    }
  }
  for (int k = 6; k <= deepest; k += 4) {
    const std::uint32_t prefix = 0x9e3779b9u & ~(0xffffffffu >> k);
    for (const int differ : {k - 1, k / 2, 1}) nodes.push_back({prefix ^ (0x80000000u >> differ), k});
    nodes.push_back({prefix, k});
    nodes.push_back({0, k});
  }
  return nodes;
}

}  // namespace halfslope
