#include "samplers/sobol.h"

#include <gtest/gtest.h>

#include <bit>
#include <boost/random/sobol.hpp>
#include <cmath>

#include "samplers/sobol_sequence.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/nets.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

TEST(Sobol, FirstPointsStandInNaturalOrderFromTheOrigin) {
  constexpr double kPoints[8][2] = {{0, 0},         {0.5, 0.5},     {0.25, 0.75},   {0.75, 0.25},
                                    {0.125, 0.625}, {0.625, 0.125}, {0.375, 0.375}, {0.875, 0.875}};
  const Points points = points_of(*sampler_named("sobol"), 8, {{2}});
  for (std::uint64_t i = 0; i < 8; ++i) {
    EXPECT_EQ(points(0, i, 5), kPoints[i][0]) << i;
    EXPECT_EQ(points(1, i, 5), kPoints[i][1]) << i;
  }
}

TEST(Sobol, IsBoostsSequenceInAnotherOrderWithTheOrigin) {
  // Boost's engine counts in Gray order and leaves index 0 out: its point i is ours of index i ⊕ (i >> 1), i = 1, 2, ….
  const int dims = sobol_dims();
  ASSERT_GE(dims, 1024);
  constexpr std::uint64_t kCount = 128;
  const Points points = points_of(*sampler_named("sobol"), kCount, singles(dims));
  boost::random::sobol engine(static_cast<std::size_t>(dims));
  for (std::uint64_t i = 1; i < kCount; ++i) {
    for (int d = 0; d < dims; ++d) ASSERT_EQ(points.at(d, i ^ (i >> 1), 0), engine() >> 11) << i << ' ' << d;
  }
  for (int d = 0; d < dims; ++d) ASSERT_EQ(points.at(d, 0, 0), 0u);
}

TEST(Sobol, IsBoostsSequenceAtTheLastIndicesToo) {
  constexpr int kDims = 40;
  const auto sampler = sampler_named("sobol");
  const Layout layout = singles(kDims);
  sampler->prepare({.count = 1ull << 31, .layout = &layout, .key = kTestKey, .low_words = true});
  for (const std::uint64_t gray : {(1ull << 31) - 1, (1ull << 31) - 2, 1ull << 30, 0x55555555ull, 0x12345678ull}) {
    boost::random::sobol engine(kDims);
    engine.seed(gray - 1);
    PointBlock block;
    block.reset(kDims, 1, true);
    sampler->fill(gray ^ (gray >> 1), block);
    for (int d = 0; d < kDims; ++d) {
      EXPECT_EQ(block.high(d)[0], engine() >> 32) << gray << ' ' << d;
      EXPECT_EQ(block.low(d)[0], 0u);
    }
  }
}

TEST(Sobol, EveryDimensionIsStratifiedUpToThePrefix) {
  SobolSequence sequence;
  sequence.reserve(sobol_dims());
  for (int d = 0; d < sobol_dims(); ++d) {
    for (int m = 1; m <= 10; ++m) {
      std::vector<int> seen(1u << m);
      for (std::uint64_t i = 0; i < 1u << m; ++i) ASSERT_EQ(seen[sequence.at(d, i) >> (32 - m)]++, 0) << d << ' ' << m;
    }
  }
}

/// t of the first 2^m points in d dimensions, counted elsewhere box by box.
struct Net {
  int dims, m, t;
};
constexpr Net kNets[] = {{1, 4, 0}, {1, 8, 0}, {2, 8, 0}, {3, 5, 1}, {3, 6, 1}, {3, 7, 1}, {3, 8, 1}, {3, 9, 1},
                         {4, 4, 2}, {4, 6, 2}, {4, 8, 3}, {5, 8, 3}, {6, 6, 3}, {6, 8, 4}, {6, 10, 4}};

TEST(Sobol, PrefixesAreNetsOfTheirT) {
  for (const auto& [dims, m, t] : kNets) {
    const Points points = points_of(*sampler_named("sobol"), 1u << m, singles(dims));
    EXPECT_EQ(counted_t(points, dims, 2, m, 0), t) << dims << " dims, 2^" << m;
  }
}

TEST(Sobol, ShiftsAndScramblesAreNetsOfTheSameT) {
  for (const char* name : {"sobol-xor", "sobol-owen", "sobol-owen-fast"}) {
    const auto sampler = sampler_named(name);
    for (const auto& [dims, m, t] : kNets) {
      if (m > 8) continue;
      const Points points = points_of(*sampler, 1u << m, singles(dims), static_cast<std::uint32_t>(16 * m));
      for (int lane = 0; lane < kLanes; ++lane) {
        EXPECT_EQ(counted_t(points, dims, 2, m, lane), t) << name << ", " << dims << " dims, 2^" << m;
      }
    }
    for (int m = 0; m <= 12; ++m) {
      const Points points = points_of(*sampler, 1u << m, {{2}});
      for (int lane = 0; lane < kLanes; ++lane) EXPECT_TRUE(is_net(points, m, lane)) << name << ' ' << m;
    }
  }
}

TEST(Sobol, EveryAlignedRunOfPointsIsANet) {
  // Points k·2^m to (k + 1)·2^m − 1 of a (0, 2)-sequence.
  for (const char* name : {"sobol", "sobol-xor", "sobol-owen", "sobol-owen-fast"}) {
    const Points points = points_of(*sampler_named(name), 1024, {{2}});
    for (std::uint64_t first = 0; first < 1024; first += 128) {
      Points run(2, 128);
      for (std::uint64_t i = 0; i < 128; ++i) {
        for (int d = 0; d < 2; ++d) run.at(d, i, 9) = points.at(d, first + i, 9);
      }
      EXPECT_TRUE(is_net(run, 7, 9)) << name << ' ' << first;
    }
  }
}

TEST(Sobol, MatricesMakeThePoints) {
  constexpr int kDims = 50, kDigits = 9;
  for (const char* name : {"sobol", "sobol-xor", "sobol-owen", "sobol-owen-fast"}) {
    const auto matrices = sampler_named(name)->generator_matrices(kDims, kDigits);
    ASSERT_TRUE(matrices) << name;
    EXPECT_EQ(matrices->base, 2u);
    EXPECT_EQ(matrices->dims, kDims);
    EXPECT_EQ(matrices->digits, kDigits);
    const Points points = points_of(*sampler_named("sobol"), 1u << kDigits, singles(kDims));
    for (int d = 0; d < kDims; ++d) {
      for (std::uint64_t i = 0; i < points.count(); ++i) {
        double x = 0;
        for (int row = 0; row < kDigits; ++row) {
          std::uint64_t digit = 0;
          for (int column = 0; column < kDigits; ++column) digit += matrices->entry(d, row, column) * (i >> column & 1);
          x += static_cast<double>(digit % 2) * std::ldexp(1, -row - 1);
        }
        ASSERT_EQ(points(d, i, 0), x) << d << ' ' << i;
      }
    }
  }
  EXPECT_TRUE(sampler_named("sobol")->generator_matrices(2, 32));
  EXPECT_FALSE(sampler_named("sobol")->generator_matrices(2, 33));
  EXPECT_FALSE(sampler_named("sobol")->generator_matrices(sobol_dims() + 1, 4));
  EXPECT_FALSE(sampler_named("sobol-cp")->generator_matrices(2, 4)) << "a rotation breaks the boxes";
  EXPECT_FALSE(sampler_named("halton")->generator_matrices(2, 4));
}

TEST(Sobol, L2StarDiscrepancyIsWhatOthersMeasure) {
  // By T. T. Warnock's formula (1972).
  struct Case {
    int dims;
    std::uint64_t count;
    double value;
  };
  constexpr Case kCases[] = {{2, 256, 0.0033074703678268075}, {2, 1024, 0.0008679282638502286},
                             {3, 128, 0.007832540833419372},  {3, 256, 0.003994959986262037},
                             {4, 32, 0.029045054954510287},   {4, 64, 0.014896763517805481}};
  for (const auto& [dims, count, value] : kCases) {
    const Points points = points_of(*sampler_named("sobol"), count, singles(dims));
    long double single = 0, pairs = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      long double product = 1;
      for (int d = 0; d < dims; ++d) product *= (1 - std::pow(static_cast<long double>(points(d, i, 0)), 2)) / 2;
      single += product;
      for (std::uint64_t j = 0; j < count; ++j) {
        product = 1;
        for (int d = 0; d < dims; ++d) product *= 1 - std::max(points(d, i, 0), points(d, j, 0));
        pairs += product;
      }
    }
    const auto n = static_cast<long double>(count);
    const long double squared = std::pow(3.0L, static_cast<long double>(-dims)) - 2 * single / n + pairs / (n * n);
    EXPECT_NEAR(static_cast<double>(std::sqrt(squared)), value, 1e-12) << dims;
  }
}

TEST(Sobol, StarDiscrepancyIsWhatOthersMeasure) {
  // The worst box has its upper corner on a grid of the points' coordinates and 1, and is open or closed there.
  struct Case {
    int dims;
    std::uint64_t count;
    double value;
  };
  constexpr Case kCases[] = {{2, 8, 0.3125},    {2, 16, 0.171875},     {2, 32, 0.08984375},
                             {3, 8, 0.3828125}, {3, 16, 0.2177734375}, {3, 32, 0.1298828125}};
  for (const auto& [dims, count, value] : kCases) {
    const Points points = points_of(*sampler_named("sobol"), count, singles(dims));
    const auto corner = [&](int d, std::uint64_t i) { return i < count ? points(d, i, 0) : 1; };
    std::uint64_t corners = 1;
    for (int d = 0; d < dims; ++d) corners *= count + 1;
    double worst = 0;
    for (std::uint64_t c = 0; c < corners; ++c) {
      double volume = 1, open = 0, closed = 0;
      std::uint64_t rest = c;
      std::vector<double> x;
      for (int d = 0; d < dims; ++d, rest /= count + 1) volume *= x.emplace_back(corner(d, rest % (count + 1)));
      for (std::uint64_t i = 0; i < count; ++i) {
        bool below = true, within = true;
        for (int d = 0; d < dims; ++d) {
          below = below && points(d, i, 0) < x[static_cast<std::size_t>(d)];
          within = within && points(d, i, 0) <= x[static_cast<std::size_t>(d)];
        }
        open += below, closed += within;
      }
      const auto n = static_cast<double>(count);
      worst = std::max({worst, volume - open / n, closed / n - volume});
    }
    EXPECT_NEAR(worst, value, 1e-12) << dims << ' ' << count;
  }
}

TEST(SobolXor, AllPointsOfADimensionGetTheSame53Digits) {
  const Points plain = points_of(*sampler_named("sobol"), 1000, singles(5));
  const Points shifted = points_of(*sampler_named("sobol-xor"), 1000, singles(5));
  for (int d = 0; d < 5; ++d) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint64_t shift = shifted.at(d, 0, lane);
      for (std::uint64_t i = 0; i < 1000; ++i) ASSERT_EQ(shifted.at(d, i, lane) ^ plain.at(d, i, lane), shift);
    }
  }
}

TEST(SobolXor, KeepsWhatThePlainPointsResonateWith) {
  // Digit m + 1 of the first coordinate of 2^m points is the same in all of them. The mean of (−1)^digit, whose
  // integral is 0, is 1 or −1 in every replicate, whatever m; nested scrambling averages N independent signs. 4096
  // replicates; the squares of the means are of kurtosis below 3, false alarm 1e-7 a side.
  constexpr std::uint32_t kGroups = 256;
  constexpr int kDigits = 6;
  const auto squares = [](const char* name) {
    const auto sampler = sampler_named(name);
    double sum = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, 1u << kDigits, singles(1), group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        int signs = 0;
        for (std::uint64_t i = 0; i < points.count(); ++i) {
          signs += points.interval(0, i, lane, 2u << kDigits) % 2 ? -1 : 1;
        }
        sum += std::pow(static_cast<double>(signs) / static_cast<double>(points.count()), 2);
      }
    }
    return sum;
  };
  constexpr double kEstimates = kGroups * kLanes;
  EXPECT_EQ(squares("sobol-xor"), kEstimates);
  for (const char* name : {"sobol-owen", "sobol-owen-fast"}) {
    const double chi = squares(name) * (1u << kDigits);
    EXPECT_LT(chi, chi_squared_upper(kEstimates, 1e-7)) << name;
    EXPECT_GT(chi, chi_squared_lower(kEstimates, 1e-7)) << name;
  }
}

TEST(Sobol, WithoutTheFirstPointTheNetIsBroken) {
  const Points points = points_of(*sampler_named("sobol"), 257, {{2}});
  Points from_origin(2, 256), without(2, 256);
  for (std::uint64_t i = 0; i < 256; ++i) {
    for (int d = 0; d < 2; ++d) {
      from_origin.at(d, i, 0) = points.at(d, i, 0);
      without.at(d, i, 0) = points.at(d, i + 1, 0);
    }
  }
  EXPECT_TRUE(is_net(from_origin, 8, 0));
  EXPECT_FALSE(is_net(without, 8, 0));
}

// Of the mean of f = x: over 2^m scrambled points its variance is 1/(12N³), that of N strata. A point more, or the
// first one less, adds about one whole uniform point's error over N: 1/(12N²), half an order worse.
TEST(Sobol, APointMoreOrLessThanAPowerOfTwoCostsHalfAnOrder) {
  constexpr std::uint32_t kGroups = 512;
  for (const char* name : {"sobol-owen", "sobol-owen-fast"}) {
    const auto sampler = sampler_named(name);
    double squares[3] = {};  // points 0 … 63, 1 … 63, 0 … 64
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, 65, singles(1), group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        double sum = 0;
        for (std::uint64_t i = 0; i < 64; ++i) sum += points(0, i, lane) - 0.5;
        squares[0] += std::pow(sum / 64, 2);
        squares[1] += std::pow((sum - (points(0, 0, lane) - 0.5)) / 63, 2);
        squares[2] += std::pow((sum + (points(0, 64, lane) - 0.5)) / 65, 2);
      }
    }
    constexpr double kEstimates = kGroups * kLanes;
    EXPECT_LT(squares[0] * 12 * 64 * 64 * 64, chi_squared_upper(kEstimates, 1e-7)) << name;
    EXPECT_GT(squares[0] * 12 * 64 * 64 * 64, chi_squared_lower(kEstimates, 1e-7)) << name;
    EXPECT_GT(squares[1], 30 * squares[0]) << name;
    EXPECT_GT(squares[2], 30 * squares[0]) << name;
  }
}

TEST(Sobol, PairsOfHighDimensionsAreFarFromTheFirst) {
  // t of the plane's 2^8 points is 0 in dimensions 0 and 1, and somewhere among the first hundred so large that boxes
  // of 1/16 of the square hold no even share.
  const auto sampler = sampler_named("sobol");
  const Points points = points_of(*sampler, 256, singles(100));
  EXPECT_EQ(counted_t(points, 2, 2, 8, 0), 0);
  int worst = 0;
  for (int a = 0; a < 100; ++a) {
    for (int b = 0; b < a; ++b) {
      Points pair(2, 256);
      for (std::uint64_t i = 0; i < 256; ++i) {
        pair.at(0, i, 0) = points.at(a, i, 0);
        pair.at(1, i, 0) = points.at(b, i, 0);
      }
      if (!is_even(pair, 2, 2, 8 - worst, 0)) worst = counted_t(pair, 2, 2, 8, 0);
    }
  }
  EXPECT_GE(worst, 5);
}

TEST(Sobol, EveryCountTo31BitsIsLegal) {
  for (const char* name : {"sobol", "sobol-xor", "sobol-cp", "sobol-owen", "sobol-owen-fast"}) {
    const auto sampler = sampler_named(name);
    EXPECT_EQ(sampler->info().max_dims, 3667) << name;
    for (const std::uint64_t count : {1ull, 3ull, 1000003ull, (1ull << 31) - 1, 1ull << 31}) {
      EXPECT_FALSE(sampler->illegal(count, singles(1024))) << name << ' ' << count;
    }
    EXPECT_EQ(sampler->illegal((1ull << 31) + 1, singles(2))->below, 1ull << 31);
  }
}

}  // namespace
}  // namespace halfslope
