// What every sampler promises.
#include "samplers/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "core/coordinates.h"
#include "core/kernel_library.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kLayout = {{1, 2, 2, 1, 2}};

/// The samplers of the catalogue; of a family, some members.
std::vector<std::string> names(const std::function<bool(const SamplerInfo&)>& wanted) {
  const SamplerCatalogue catalogue = SamplerCatalogue::built_in();
  std::vector<std::string> names;
  for (const std::string& name : catalogue.names()) {
    if (name.find(':') == std::string::npos) names.push_back(name);
  }
  for (const char* member : {"padded:halton-owen", "padded:hammersley-owen"}) names.push_back(member);
  std::erase_if(names, [&](const std::string& name) { return !wanted(catalogue.make(name)->info()); });
  return names;
}

/// Sets that cost microseconds a point are tested with fewer points, and less often.
bool is_dear(const std::string& name) { return name == "poisson-disk" || name == "best-candidate"; }

/// `count`, or where there are no so many points the next legal count, above if there is one.
std::uint64_t legal(const Sampler& sampler, std::uint64_t count) {
  if (is_dear(sampler.info().name)) count = std::min<std::uint64_t>(count, 150);
  const auto neighbours = sampler.illegal(count, kLayout);
  if (!neighbours) return count;
  return neighbours->above ? *neighbours->above : neighbours->below.value();
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string text = info.param;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '-' || c == ':'; }, '_');
  return text;
}

class EverySampler : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, EverySampler, testing::ValuesIn(names([](const SamplerInfo&) { return true; })),
                         test_name);
class EverySequence : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, EverySequence,
                         testing::ValuesIn(names([](const SamplerInfo& s) { return s.sequence; })), test_name);
class EveryRandomisedSampler : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, EveryRandomisedSampler,
                         testing::ValuesIn(names([](const SamplerInfo& s) { return s.randomised; })), test_name);
class EveryDeterministicSampler : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, EveryDeterministicSampler,
                         testing::ValuesIn(names([](const SamplerInfo& s) { return !s.randomised; })), test_name);
/// Where each index alone is uniform on the whole cube. A jittered point is uniform in the cell of its index.
class EverySamplerOfUniformPoints : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, EverySamplerOfUniformPoints, testing::ValuesIn(names([](const SamplerInfo& s) {
                           return s.randomised && s.name != "jittered";
                         })),
                         test_name);

TEST_P(EverySampler, CoordinatesAreBelowOneAndBinary32IsTheTopOfBinary64) {
  const auto sampler = sampler_named(GetParam());
  for (const std::uint64_t about : {1u, 100u, 5000u}) {
    const std::uint64_t count = legal(*sampler, about);
    sampler->prepare(
        {.count = count, .layout = &kLayout, .key = kTestKey, .pixel = 1, .replicate = 0, .low_words = true});
    PointBlock block;
    block.reset(kLayout.dims(), static_cast<int>(count), true);
    sampler->fill(0, block);
    std::vector<float> single(block.stride());
    std::vector<double> both(block.stride());
    for (int dim = 0; dim < block.dims(); ++dim) {
      to_coordinates(block.high(dim), block.low(dim), block.stride(), single.data());
      to_coordinates(block.high(dim), block.low(dim), block.stride(), both.data());
      for (std::size_t i = 0; i < block.stride(); ++i) {
        ASSERT_LT(block.low(dim)[i], 1u << 21);
        ASSERT_TRUE(0 <= both[i] && both[i] < 1);
        ASSERT_TRUE(0 <= single[i] && single[i] < 1);
        ASSERT_EQ(static_cast<double>(single[i]), std::floor(both[i] * 0x1p24) * 0x1p-24);
      }
    }
  }
}

TEST_P(EverySampler, HighWordsAreTheSameWithoutLowWords) {
  const auto sampler = sampler_named(GetParam());
  const std::uint64_t count = legal(*sampler, 300);
  const Points points = points_of(*sampler, count, kLayout);
  sampler->prepare(
      {.count = count, .layout = &kLayout, .key = kTestKey, .pixel = 7, .replicate = 0, .low_words = false});
  PointBlock block;
  block.reset(kLayout.dims(), static_cast<int>(count), false);
  sampler->fill(0, block);
  for (int dim = 0; dim < block.dims(); ++dim) {
    for (int s = 0; s < block.samples(); ++s) {
      for (int lane = 0; lane < kLanes; ++lane) {
        ASSERT_EQ(block.high(dim)[s * kLanes + lane], points.at(dim, static_cast<std::uint64_t>(s), lane) >> 21);
      }
    }
  }
}

TEST_P(EverySamplerOfUniformPoints, MarginalOfEachIndexIsUniform) {
  // 65536 replicates (4096 of dear ones) in 64 bins of the coordinate and 64 of its digits 2⁻⁷ … 2⁻¹²: χ² with 63
  // degrees, false alarm 1e-9 for each of about 300.
  const std::uint32_t groups = is_dear(GetParam()) ? 256 : 4096;
  const auto sampler = sampler_named(GetParam());
  for (const std::uint64_t about : {1u, 5u, 8u}) {
    const std::uint64_t count = legal(*sampler, about);
    std::vector<std::array<std::array<std::uint32_t, 64>, 2>> bins(count * static_cast<std::size_t>(kLayout.dims()));
    for (std::uint32_t group = 0; group < groups; ++group) {
      const Points points = points_of(*sampler, count, kLayout, group * kLanes);
      for (int dim = 0; dim < kLayout.dims(); ++dim) {
        for (std::uint64_t i = 0; i < count; ++i) {
          auto& [coarse, fine] = bins[static_cast<std::size_t>(dim) * count + i];
          for (int lane = 0; lane < kLanes; ++lane) {
            ++coarse[points.interval(dim, i, lane, 64)];
            ++fine[points.interval(dim, i, lane, 4096) % 64];
          }
        }
      }
    }
    for (const auto& both : bins) {
      for (const auto& counts : both) {
        EXPECT_LT(chi_squared(std::span<const std::uint32_t>(counts)), chi_squared_upper(63, 1e-9)) << count;
      }
    }
  }
}

/// Points of one pixel against those of the next pixel, another seed and other replicates: whether ⌊x · intervals⌋ mod
/// 16 of both are uniform and independent, at each of four indices of dimension 1 (a table for each: the points of a
/// replicate may have a shift in common). χ² with 255 degrees, false alarm 1e-8 for each of 12.
void expect_independent(const std::string& name, std::uint64_t intervals) {
  constexpr std::size_t kIndices = 4;
  const auto sampler = sampler_named(name);
  const StreamKey other_key = stream_key(20240230, "test", "points");
  const std::uint64_t count = legal(*sampler, 6);
  std::array<std::array<std::array<std::uint32_t, 256>, kIndices>, 3> joint = {};
  for (std::uint32_t pixel = 0; pixel < (is_dear(name) ? 128u : 512u); ++pixel) {
    const Points here = points_of(*sampler, count, kLayout, 0, pixel, kTestKey, kIndices);
    const std::array<Points, 3> others = {points_of(*sampler, count, kLayout, 0, pixel + 1000, kTestKey, kIndices),
                                          points_of(*sampler, count, kLayout, 0, pixel, other_key, kIndices),
                                          points_of(*sampler, count, kLayout, kLanes, pixel, kTestKey, kIndices)};
    for (std::size_t i = 0; i < kIndices; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const std::uint64_t digits = here.interval(1, i, lane, intervals) % 16;
        for (std::size_t o = 0; o < others.size(); ++o) {
          ++joint[o][i][digits * 16 + others[o].interval(1, i, lane, intervals) % 16];
        }
      }
    }
  }
  for (const auto& other : joint) {
    for (const auto& counts : other) {
      EXPECT_LT(chi_squared(std::span<const std::uint32_t>(counts)), chi_squared_upper(255, 1e-8));
    }
  }
}

TEST_P(EveryRandomisedSampler, PixelsSeedsAndReplicatesAreIndependentAndRepeatable) {
  const auto sampler = sampler_named(GetParam());
  const std::uint64_t count = legal(*sampler, 64);
  const Points points = points_of(*sampler, count, kLayout);
  EXPECT_EQ(points, points_of(*sampler_named(GetParam()), count, kLayout));
  // Lane l is replicate + l.
  const Points shifted = points_of(*sampler, count, kLayout, 5);
  for (int lane = 0; lane + 5 < kLanes; ++lane) {
    for (std::uint64_t i = 0; i < count; ++i) ASSERT_EQ(shifted.at(3, i, lane), points.at(3, i, lane + 5));
  }
  expect_independent(GetParam(), 64);  // digits 2⁻³ … 2⁻⁶, below the cells of a jittered point
}

TEST_P(EverySamplerOfUniformPoints, FirstDigitsOfPixelsSeedsAndReplicatesAreIndependent) {
  expect_independent(GetParam(), 16);
}

TEST_P(EveryDeterministicSampler, PointsAreTheSameInEveryLaneReplicatePixelAndSeed) {
  const auto sampler = sampler_named(GetParam());
  EXPECT_FALSE(sampler->info().unbiased);
  for (const std::uint64_t about : {1u, 64u, 999u}) {
    const std::uint64_t count = legal(*sampler, about);
    const Points points = points_of(*sampler, count, kLayout);
    EXPECT_EQ(points, points_of(*sampler, count, kLayout, 5 * kLanes));
    EXPECT_EQ(points, points_of(*sampler, count, kLayout, 0, 8));
    EXPECT_EQ(points, points_of(*sampler, count, kLayout, 0, 7, stream_key(2, "test", "points")));
    for (int dim = 0; dim < kLayout.dims(); ++dim) {
      for (std::uint64_t i = 0; i < count; ++i) {
        for (int lane = 1; lane < kLanes; ++lane) ASSERT_EQ(points.at(dim, i, lane), points.at(dim, i, 0));
      }
    }
  }
}

TEST_P(EveryRandomisedSampler, MeanOfTheProductOfAPairIsAQuarter) {
  // ∫∫ xy = 1/4, of pairs of the layout and of coordinates from different groups: means over 16384
  // replicates (2048 of dear ones), each a mean of N points in [0, 1], against their own standard error. Normal to all
  // that matters; false alarm 2e-9 for each of 12 means.
  const std::uint32_t groups = is_dear(GetParam()) ? 128 : 1024;
  const double replicates = groups * kLanes;
  constexpr std::array<std::array<int, 2>, 6> kPairs = {{{0, 1}, {1, 2}, {3, 4}, {2, 3}, {6, 7}, {1, 6}}};
  const auto sampler = sampler_named(GetParam());
  EXPECT_TRUE(sampler->info().unbiased);
  for (const std::uint64_t about : {1u, 6u}) {
    const std::uint64_t count = legal(*sampler, about);
    std::array<double, kPairs.size()> sum = {}, squares = {};
    for (std::uint32_t group = 0; group < groups; ++group) {
      const Points points = points_of(*sampler, count, kLayout, group * kLanes);
      for (int lane = 0; lane < kLanes; ++lane) {
        for (std::size_t p = 0; p < kPairs.size(); ++p) {
          double error = 0;
          for (std::uint64_t i = 0; i < count; ++i) {
            error += points(kPairs[p][0], i, lane) * points(kPairs[p][1], i, lane) - 0.25;
          }
          error /= static_cast<double>(count);
          sum[p] += error;
          squares[p] += error * error;
        }
      }
    }
    for (std::size_t p = 0; p < kPairs.size(); ++p) {
      const double mean = sum[p] / replicates;
      const double se = std::sqrt((squares[p] / replicates - mean * mean) / (replicates - 1));
      EXPECT_LT(std::abs(mean) / se, 6) << count << " dims " << kPairs[p][0] << ' ' << kPairs[p][1];
    }
  }
}

TEST_P(EverySampler, BlocksMayBeFilledInAnySplitAndOrder) {
  std::mt19937 random(1);
  const auto sampler = sampler_named(GetParam());
  for (const std::uint64_t about : {1u, 37u, 1000u, 4500u}) {
    const std::uint64_t count = legal(*sampler, about);
    const Points whole = points_of(*sampler, count, kLayout, 0, 7, kTestKey, 0, static_cast<int>(count));
    for (int trial = 0; trial < 4; ++trial) {
      EXPECT_EQ(whole, points_of(*sampler, count, kLayout, 0, 7, kTestKey, 0, 1 + static_cast<int>(random() % 300)));
    }
    for (int trial = 0; trial < 50; ++trial) {
      const std::uint64_t begin = random() % count, samples = 1 + random() % std::min<std::uint64_t>(64, count - begin);
      PointBlock block;
      block.reset(kLayout.dims(), static_cast<int>(samples), true);
      sampler->fill(begin, block);
      for (int dim = 0; dim < kLayout.dims(); ++dim) {
        for (std::uint64_t s = 0; s < samples; ++s) {
          for (int lane = 0; lane < kLanes; ++lane) {
            ASSERT_EQ(block.coordinate(dim, static_cast<int>(s), lane), whole(dim, begin + s, lane));
          }
        }
      }
    }
  }
}

TEST_P(EverySequence, PrefixIsTheSameWhateverWasPrepared) {
  const auto sampler = sampler_named(GetParam());
  const std::uint64_t most = legal(*sampler, 100000);
  const Points longest = points_of(*sampler, most, kLayout, 0, 7, kTestKey, std::min<std::uint64_t>(most, 3000));
  for (const std::uint64_t count : {1u, 2u, 3u, 9u, 17u, 128u, 243u, 255u, 256u, 257u, 999u, 3000u}) {
    if (count > most) break;
    const Points shorter = points_of(*sampler, count, kLayout);
    for (int dim = 0; dim < kLayout.dims(); ++dim) {
      for (std::uint64_t i = 0; i < count; ++i) {
        for (int lane = 0; lane < kLanes; ++lane) {
          ASSERT_EQ(shorter.at(dim, i, lane), longest.at(dim, i, lane)) << count << " point " << i << " dim " << dim;
        }
      }
    }
  }
}

TEST_P(EverySampler, WordsAreTheSameOnEveryIsa) {
  const std::vector<Isa> isas = supported_isas();
  for (const std::uint64_t about : {3u, 1000u, 5003u}) {
    std::vector<Points> points;
    for (const Isa isa : isas) {
      const IsaScope scope(to_string(isa));
      const auto sampler = sampler_named(GetParam());
      points.push_back(points_of(*sampler, legal(*sampler, about), kLayout));
    }
    for (std::size_t i = 1; i < points.size(); ++i) EXPECT_EQ(points[i], points[0]) << to_string(isas[i]);
  }
}

/// The fewest points of kLayout's 8 dimensions: one, but for those that come in pairs, and for p² of an array that has
/// p
/// + 1 columns.
std::uint64_t least_count(const std::string& name) {
  if (name == "antithetic") return 2;
  if (name == "orthogonal-array") return 7 * 7;
  return 1;
}

TEST_P(EverySampler, DeclaresItselfAndRefusesNoPoints) {
  const auto sampler = sampler_named(GetParam());
  const SamplerInfo& info = sampler->info();
  EXPECT_EQ(info.name, GetParam());
  EXPECT_FALSE(info.description.empty());
  EXPECT_FALSE(info.reference.empty());
  EXPECT_GE(info.max_dims, kLayout.dims());
  const auto none = sampler->illegal(0, kLayout);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->below, std::nullopt);
  EXPECT_EQ(none->above, least_count(GetParam()));
  EXPECT_FALSE(sampler->illegal(least_count(GetParam()), kLayout));
  const auto many = sampler->illegal(info.max_count + 1, kLayout);
  ASSERT_TRUE(many);
  EXPECT_LE(many->below.value(), info.max_count);
  EXPECT_EQ(many->above, std::nullopt);
  EXPECT_FALSE(sampler->illegal(many->below.value(), kLayout));
  EXPECT_TRUE(sampler->illegal(many->below.value() + 1, kLayout));
}

TEST_P(EverySampler, NeighboursOfAnIllegalCountAreLegalAndNearest) {
  const auto sampler = sampler_named(GetParam());
  std::optional<std::uint64_t> below;
  for (std::uint64_t count = 1; count <= 10000; ++count) {
    const auto neighbours = sampler->illegal(count, kLayout);
    if (!neighbours) {
      below = count;
      continue;
    }
    ASSERT_EQ(neighbours->below, below) << count;
    ASSERT_TRUE(neighbours->above) << count;
    ASSERT_GT(*neighbours->above, count);
    ASSERT_FALSE(sampler->illegal(*neighbours->above, kLayout)) << count;
    ASSERT_TRUE(sampler->illegal(*neighbours->above - 1, kLayout)) << count;
  }
}

}  // namespace
}  // namespace halfslope
