#include "samplers/padded.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "samplers/held_pairs.h"
#include "samplers/keyed_hash.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/nets.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kPair = {{2}}, kTwoPairs = {{2, 2}};

class EveryPaddedSampler : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, EveryPaddedSampler,
                         testing::Values("multi-jittered", "correlated-multi-jittered", "pmj", "pmj02", "poisson-disk",
                                         "best-candidate", "padded:halton-owen", "padded:hammersley-owen"),
                         [](const auto& sampler) {
                           std::string name = sampler.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return c == '-' || c == ':'; }, '_');
                           return name;
                         });

TEST_P(EveryPaddedSampler, SaysSo) {
  const auto caveats = sampler_named(GetParam())->info().caveats;
  EXPECT_THAT(caveats, testing::Contains(testing::HasSubstr("independently shuffled pairs")));
}

TEST_P(EveryPaddedSampler, CoordinatesOfDifferentGroupsAreIndependent) {
  // Of the same index, in quarters of each of two coordinates of different groups, over 2048 replicates: each two
  // coordinates of each index are independent, 15 degrees; of all 16 indices together they would be if points were
  // independent of each other, which stratified ones are not, so each index is tested alone. False alarm 1e-9 for each
  // of 64.
  const auto sampler = sampler_named(GetParam());
  constexpr std::array<std::array<int, 2>, 4> kDims = {{{0, 2}, {0, 3}, {1, 2}, {1, 3}}};
  std::array<std::array<std::array<std::uint32_t, 16>, 16>, 4> joint = {};
  for (std::uint32_t group = 0; group < 128; ++group) {
    const Points points = points_of(*sampler, 16, kTwoPairs, group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      for (std::size_t d = 0; d < 4; ++d) {
        for (std::uint64_t i = 0; i < 16; ++i) {
          ++joint[d][i][points.interval(kDims[d][0], i, lane, 4) * 4 + points.interval(kDims[d][1], i, lane, 4)];
        }
      }
    }
  }
  for (const auto& dims : joint) {
    for (const auto& counts : dims) {
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(counts)), chi_squared_upper(15, 1e-9));
    }
  }
}

// Of the mean of g = (x − ½)(z − ½), x and z of different groups, over N points: 1/(144 N) if points were independent.
// Shuffled groups have Σ_i Σ_j Cov(x_i, x_j) Cov(z_i, z_j)/N², so if an order is uniform within runs of s points whose
// x add up to a variance of V_s/12, and runs are uncorrelated, each run adds (V_s − s)²/(s (s − 1)) to the N.
// Stratified in s strata: V_s = 1/s. What stratifies all N points, as a set does: s = N, and the factor is N/(N − 1).
// In a sequence of nets N = 256 has runs of 1, 1, 2, 4, 8 and 15 of 16; the first two points keep their places, which
// is as if they were a run of 2. The estimates are nearly normal, so their variance has a relative spread of
// √(2/16384); the bound is 5.5 of it and 0.01 for the runs' not being quite uncorrelated.
TEST(Padded, ProductsAcrossGroupsConvergeAsWithIndependentPoints) {
  constexpr std::uint32_t kGroups = 1024;
  constexpr std::uint64_t kCount = 256;
  const auto run = [](double s) { return std::pow(1 / s - s, 2) / (s * (s - 1)); };
  const double sequence = 1 + (2 * run(2) + run(4) + run(8) + 15 * run(16)) / kCount;
  const double set = kCount / (kCount - 1.0);
  const std::array<std::pair<const char*, double>, 5> expected = {{{"multi-jittered", set},
                                                                   {"correlated-multi-jittered", set},
                                                                   {"padded:hammersley-owen", set},
                                                                   {"pmj02", sequence},
                                                                   {"stratified", 1}}};
  for (const auto& [name, factor] : expected) {
    const auto sampler = sampler_named(name);
    double across = 0, all = 0, within = 0;
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      const Points points = points_of(*sampler, kCount, kTwoPairs, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        std::array<double, 3> error = {};
        for (std::uint64_t i = 0; i < kCount; ++i) {
          const double x = points(0, i, lane) - 0.5, y = points(1, i, lane) - 0.5, z = points(2, i, lane) - 0.5,
                       w = points(3, i, lane) - 0.5;
          error[0] += x * z / kCount;
          error[1] += x * y * z * w / kCount;
          error[2] += x * y / kCount;
        }
        across += error[0] * error[0], all += error[1] * error[1], within += error[2] * error[2];
      }
    }
    const double estimates = kGroups * kLanes, independent = 1 / (144.0 * kCount);
    EXPECT_NEAR(across / estimates / independent, factor, 0.07) << name;
    // The product of all four coordinates gains nothing either; that of one pair gains much.
    EXPECT_NEAR(all / estimates / (independent / 144), 1, 0.1) << name;
    EXPECT_LT(within / estimates / independent, 0.2) << name;
  }
}

/// An octave's index with each bit below the highest flipped by a random bit of the bits above: a shuffle that is
/// nested to the last bit, which is what the blocks of OctaveShuffle are there to avoid.
std::uint64_t nested_to_the_last_bit(std::uint64_t index, std::uint32_t key) {
  std::uint64_t flips = 0;
  for (int bit = static_cast<int>(std::bit_width(index)) - 2; bit >= 0; --bit) {
    flips |= std::uint64_t{keyed_word(static_cast<std::uint32_t>(index >> (bit + 1)), key, 0) >> 31} << bit;
  }
  return index ^ flips;
}

// As above, for runs of 2 within runs of 4 within …: the neighbours' covariance is run(2)/2 a point, and that with the
// others of each larger run follows from V_s = 1/s in the same way.
TEST(Padded, ANestedShuffleWithoutBlocksWouldLeaveMoreVariance) {
  constexpr std::uint32_t kGroups = 512;
  constexpr std::uint64_t kCount = 256;
  double factor = 1, within = 1;  // Σ_j Cov(x_i, x_j)² over the run, and Σ_j Cov(x_i, x_j), in twelfths
  for (double s = 2; s <= 128; s *= 2) {
    const double between = (1 / (s * s) - within) / (s / 2);  // of two points in different halves of a run of s
    factor += s / 2 * between * between;
    within = 1 / (s * s);
  }
  EXPECT_NEAR(factor, 1.58, 0.01);
  const auto sampler = sampler_named("pmj02");
  double squares = 0;
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const Points xs = points_of(*sampler, kCount, kPair, group * kLanes, 1);
    const Points zs = points_of(*sampler, kCount, kPair, group * kLanes, 2);
    for (int lane = 0; lane < kLanes; ++lane) {
      double error = 0;
      for (std::uint64_t i = 0; i < kCount; ++i) {
        const std::uint64_t j = nested_to_the_last_bit(i, mix32(group * kLanes + static_cast<std::uint32_t>(lane)));
        error += (xs(0, i, lane) - 0.5) * (zs(0, j, lane) - 0.5) / kCount;
      }
      squares += error * error;
    }
  }
  EXPECT_NEAR(squares / (kGroups * kLanes) * (144.0 * kCount), factor, 0.14);  // 5.5 of its spread, √(2/8192)
}

TEST(Padded, EveryPairOfASequenceOfNetsIsOneAndItsAlignedRunsAre) {
  const auto sampler = sampler_named("pmj02");
  const Points points = points_of(*sampler, 1024, {{1, 2, 2}});
  for (const int dim : {1, 3}) {
    for (std::uint64_t size = 16; size <= 1024; size *= 2) {
      for (std::uint64_t begin = 0; begin < 1024; begin += size) {
        Points run(2, size);
        for (int d = 0; d < 2; ++d) {
          for (std::uint64_t i = 0; i < size; ++i) {
            for (int lane = 0; lane < kLanes; ++lane) run.at(d, i, lane) = points.at(dim + d, begin + i, lane);
          }
        }
        for (int lane = 0; lane < kLanes; lane += 3) {
          ASSERT_TRUE(is_net(run, std::countr_zero(size), lane)) << dim << ' ' << size << " from " << begin;
        }
      }
    }
  }
}

/// The pairs of dimensions (dim, dim + 1) of a lane, in order of x.
std::vector<std::array<std::uint64_t, 2>> sorted_pairs(const Points& points, int dim, int lane) {
  std::vector<std::array<std::uint64_t, 2>> pairs;
  for (std::uint64_t i = 0; i < points.count(); ++i)
    pairs.push_back({points.at(dim, i, lane), points.at(dim + 1, i, lane)});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(PaddedFamily, TheFirstPairIsTheSamplersOwn) {
  for (const std::uint64_t count : {1u, 100u, 1000u}) {
    const Points padded = points_of(*sampler_named("padded:halton-owen"), count, {{2, 1, 2}});
    const Points own = points_of(*sampler_named("halton-owen"), count, kPair);
    for (std::uint64_t i = 0; i < count; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) {
        for (int dim = 0; dim < 2; ++dim) ASSERT_EQ(padded.at(dim, i, lane), own.at(dim, i, lane));
      }
    }
  }
  const Points padded = points_of(*sampler_named("padded:hammersley-owen"), 256, kTwoPairs);
  const Points own = points_of(*sampler_named("hammersley-owen"), 256, kPair);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(sorted_pairs(padded, 0, lane), sorted_pairs(own, 0, lane)) << "a set is shuffled in its first pair too";
    EXPECT_NE(sorted_pairs(padded, 2, lane), sorted_pairs(own, 0, lane)) << "the second is another randomisation";
  }
}

TEST(PaddedFamily, OfADeterministicSamplerOnlyTheShuffleIsRandom) {
  const auto sampler = sampler_named("padded:hammersley");
  EXPECT_TRUE(sampler->info().randomised);
  EXPECT_FALSE(sampler->info().unbiased);
  EXPECT_THAT(sampler->info().caveats, testing::Contains(testing::HasSubstr("deterministic")));
  const Points points = points_of(*sampler, 100, kTwoPairs);
  const auto own = sorted_pairs(points_of(*sampler_named("hammersley"), 100, kPair), 0, 0);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(sorted_pairs(points, 0, lane), own);
    EXPECT_EQ(sorted_pairs(points, 2, lane), own);
    if (lane > 0) {
      EXPECT_NE(points.at(2, 5, lane), points.at(2, 5, 0));
    }
  }
}

TEST(PaddedFamily, LegalCountsAreThoseOfTheSamplersPairsAndOfMemory) {
  const auto jittered = sampler_named("padded:jittered");
  EXPECT_FALSE(jittered->illegal(100, kTwoPairs));
  EXPECT_EQ(jittered->illegal(101, kTwoPairs)->below, 100u);
  EXPECT_EQ(jittered->illegal(101, kTwoPairs)->above, 121u);
  // 2¹⁸ points over two pairs: 2¹⁷, of which 362² = 131044 are a grid.
  EXPECT_EQ(jittered->illegal(131072, kTwoPairs)->below, 131044u);
  EXPECT_EQ(jittered->illegal(131072, kTwoPairs)->above, std::nullopt);
  EXPECT_EQ(sampler_named("padded:hammersley-owen")->illegal(100, kPair)->above, 128u);
  EXPECT_EQ(sampler_named("padded:halton-owen")->illegal(200000, kTwoPairs)->below, 1u << 17);
}

class Line final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {.name = "line", .description = "one", .reference = "none", .max_dims = 1};
    return kInfo;
  }
  void prepare(const PointRequest&) override {}
  void fill(std::uint64_t, PointBlock&) override {}
};

TEST(PaddedFamily, AnUnknownSamplerAndOneWithoutPairsAreErrors) {
  SamplerCatalogue catalogue = SamplerCatalogue::built_in();
  catalogue.add([] { return std::make_unique<Line>(); });
  const auto message = [&](const std::string& name) -> std::string {
    try {
      catalogue.make(name);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "made";
  };
  EXPECT_THAT(message("padded:halton-owne"), testing::HasSubstr("did you mean 'halton-owen'?"));
  EXPECT_THAT(message("padded:"), testing::HasSubstr("there is no sampler"));
  EXPECT_THAT(message("padded:line"), testing::HasSubstr("padding takes pairs"));
  EXPECT_EQ(message("padded:n-rooks"), "made");
}

}  // namespace
}  // namespace halfslope
