#include "samplers/faure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "samplers/faure_sequence.h"
#include "samplers/radical_inverse.h"
#include "tests/samplers/net_variance.h"
#include "tests/samplers/nets.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

__extension__ using Wide = unsigned __int128;

TEST(Faure, FirstPointsAreThoseOfTheTextbook) {
  // P. Glasserman, "Monte Carlo methods in financial engineering" (2004), page 299, in ninths.
  constexpr std::uint64_t kNinths[9][3] = {{0, 0, 0}, {3, 3, 3}, {6, 6, 6}, {1, 4, 7}, {4, 7, 1},
                                           {7, 1, 4}, {2, 8, 5}, {5, 2, 8}, {8, 5, 2}};
  const Points points = points_of(*sampler_named("faure"), 9, {{1, 2}});
  for (std::uint64_t i = 0; i < 9; ++i) {
    for (int d = 0; d < 3; ++d) EXPECT_EQ(points.at(d, i, 2), (kNinths[i][d] << 53) / 9) << i << ' ' << d;
  }
}

TEST(Faure, BaseIsTheLeastPrimeNotBelowTheDimensions) {
  for (const auto& [dims, base] : {std::pair{1, 2u}, std::pair{2, 2u}, std::pair{3, 3u}, std::pair{4, 5u},
                                   std::pair{6, 7u}, std::pair{8, 11u}, std::pair{1024, 1031u}}) {
    EXPECT_EQ(faure_base(dims), base);
    EXPECT_EQ(sampler_named("faure")->generator_matrices(dims, 2)->base, base);
  }
}

/// ⌊2⁵³ x⌋ of a point by its definition: digit r is Σ_c binom(c, r) j^(c−r) a_c, where 0⁰ = 1.
std::uint64_t by_definition(std::uint64_t base, std::uint64_t j, std::uint64_t index) {
  std::vector<std::uint64_t> a;
  for (; index > 0; index /= base) a.push_back(index % base);
  Wide numerator = 0, denominator = 1;
  for (std::size_t r = 0; r < a.size(); ++r) {
    Wide digit = 0, term = 1;  // term = binom(c, r), below 2³¹ for c ≤ 31
    for (std::size_t c = r; c < a.size(); ++c) {
      if (c > r) term = term * c / (c - r);
      std::uint64_t power = 1;
      for (std::size_t e = r; e < c; ++e) power = power * j % base;
      digit += term % base * power * a[c];
    }
    numerator = numerator * base + digit % base;
    denominator *= base;
  }
  return static_cast<std::uint64_t>((numerator << 53) / denominator);
}

TEST(Faure, EveryCoordinateIsExactToTheLastIndex) {
  const auto sampler = sampler_named("faure");
  for (const int dims : {1, 2, 3, 5, 8, 30, 200, 1024}) {
    const Layout layout = singles(dims);
    sampler->prepare({.count = 1ull << 31, .layout = &layout, .key = kTestKey, .low_words = true});
    for (const std::uint64_t begin : {0ull, 100ull, 1031ull * 1031 - 20, 48828125ull - 30, (1ull << 31) - 40}) {
      PointBlock block;
      block.reset(dims, 40, true);
      sampler->fill(begin, block);
      for (int d = 0; d < dims; d += 1 + dims / 8) {
        for (int s = 0; s < 40; ++s) {
          const std::size_t at = static_cast<std::size_t>(s) * kLanes;
          ASSERT_EQ(
              std::uint64_t{block.high(d)[at]} << 21 | block.low(d)[at],
              by_definition(faure_base(dims), static_cast<std::uint64_t>(d), begin + static_cast<std::uint64_t>(s)))
              << dims << " dims, dim " << d << ", point " << begin << " + " << s;
        }
      }
    }
  }
}

/// Points of "faure", each coordinate a step of 2⁻⁵³ up: the exact ones were rounded down, those on an interval's lower
/// end, such as 1/3, out of it.
Points inside_their_intervals(std::uint64_t count, int dims) {
  Points points = points_of(*sampler_named("faure"), count, singles(dims));
  for (int d = 0; d < dims; ++d) {
    for (std::uint64_t i = 0; i < count; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) ++points.at(d, i, lane);
    }
  }
  return points;
}

TEST(Faure, PrefixesAreNetsWithoutLossAndSoAreTheirScrambles) {
  struct Net {
    int dims, m;
  };
  for (const bool scrambled : {false, true}) {
    for (const auto& [dims, m] : {Net{1, 8}, Net{2, 8}, Net{3, 3}, Net{3, 4}, Net{4, 3}, Net{5, 3}, Net{7, 2}}) {
      const std::uint64_t base = faure_base(dims);
      const auto count = static_cast<std::uint64_t>(std::llround(std::pow(base, m)));
      const Points points = scrambled ? points_of(*sampler_named("faure-owen"), count, singles(dims))
                                      : inside_their_intervals(count, dims);
      for (int lane = 0; lane < kLanes; lane += 5) {
        EXPECT_EQ(counted_t(points, dims, base, m, lane), 0)
            << scrambled << ' ' << dims << " dims, " << base << '^' << m;
      }
    }
  }
}

TEST(Faure, MatricesMakeThePoints) {
  for (const char* name : {"faure", "faure-owen"}) {
    const auto matrices = sampler_named(name)->generator_matrices(5, 4);
    ASSERT_TRUE(matrices);
    const Points points = points_of(*sampler_named("faure"), 625, singles(5));
    for (int d = 0; d < 5; ++d) {
      for (std::uint64_t i = 0; i < 625; ++i) {
        const std::uint64_t digits[] = {i % 5, i / 5 % 5, i / 25 % 5, i / 125};
        std::uint64_t numerator = 0;
        for (int row = 0; row < 4; ++row) {
          std::uint64_t digit = 0;
          for (int column = 0; column < 4; ++column) digit += matrices->entry(d, row, column) * digits[column];
          numerator = numerator * 5 + digit % 5;
        }
        ASSERT_EQ(points.at(d, i, 0), static_cast<std::uint64_t>((Wide{numerator} << 53) / 625)) << d << ' ' << i;
      }
    }
  }
}

TEST(Faure, TheFirstPointsOfManyDimensionsStandOnTheDiagonal) {
  // The reason to take a power of the base: the first b points are (i/b, …, i/b), and the first b² lie on b lines.
  const Points points = points_of(*sampler_named("faure"), 29, singles(29));
  for (std::uint64_t i = 0; i < 29; ++i) {
    for (int d = 0; d < 29; ++d) EXPECT_EQ(points.at(d, i, 0), (i << 53) / 29);
  }
}

TEST(Faure, AnotherDimensionIsAnotherSequence) {
  const auto sampler = sampler_named("faure");
  const Points three = points_of(*sampler, 50, singles(3)), four = points_of(*sampler, 50, singles(4));
  EXPECT_EQ(three.at(0, 1, 0), (1ull << 53) / 3);
  EXPECT_EQ(four.at(0, 1, 0), (1ull << 53) / 5);
  EXPECT_EQ(three, points_of(*sampler, 50, singles(3))) << "prepared for others in between";
}

TEST(FaureOwen, CountsArePowersOfTheBaseAtMost) {
  const auto sampler = sampler_named("faure-owen");
  for (const auto& [dims, most] : {std::pair{2, 1ull << 31}, std::pair{3, 1162261467ull}, std::pair{5, 1220703125ull},
                                   std::pair{8, 214358881ull}, std::pair{1024, 1095912791ull}}) {
    EXPECT_FALSE(sampler->illegal(most, singles(dims)));
    EXPECT_EQ(sampler->illegal(most + 1, singles(dims))->below, most);
    EXPECT_EQ(sampler->illegal(most + 1, singles(dims))->above, std::nullopt);
  }
}

TEST(FaureOwen, VarianceIsOwensForScrambledNets) {
  for (const auto& [dims, digits] : {std::pair{1, 6}, std::pair{3, 3}, std::pair{5, 2}}) {
    const std::uint64_t base = faure_base(dims);
    const auto count = static_cast<std::uint64_t>(std::llround(std::pow(base, digits)));
    const Points plain = inside_their_intervals(count, dims);
    expect_product_variance("faure-owen", dims, count, product_variance(plain, dims, base, digits));
  }
}

TEST(FaureOwen, LastPointsPartWhereThePlainOnesDo) {
  // Base 3, 19 digits: the scrambled points share as many first digits as the unscrambled ones do.
  const Layout layout = singles(3);
  const std::uint64_t begin = 1162261467ull - 90;
  PointBlock plain, scrambled;
  for (const auto& [name, block] : {std::pair{"faure", &plain}, std::pair{"faure-owen", &scrambled}}) {
    const auto sampler = sampler_named(name);
    sampler->prepare({.count = 1162261467, .layout = &layout, .key = kTestKey, .low_words = true});
    block->reset(3, 90, true);
    sampler->fill(begin, *block);
  }
  const auto shared = [](const PointBlock& block, int dim, int a, int b, int lane) {
    double x = block.coordinate(dim, a, lane), y = block.coordinate(dim, b, lane);
    int digits = 0;
    for (; digits < 8 && std::floor(x * 3) == std::floor(y * 3); ++digits) {
      x = x * 3 - std::floor(x * 3);
      y = y * 3 - std::floor(y * 3);
    }
    return digits;
  };
  for (int dim = 0; dim < 3; ++dim) {
    for (int a = 0; a < 90; ++a) {
      for (int b = 0; b < a; ++b) ASSERT_EQ(shared(plain, dim, a, b, 0), shared(scrambled, dim, a, b, 11));
    }
  }
}

}  // namespace
}  // namespace halfslope
