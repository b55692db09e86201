// What every sampler promises.
#include "samplers/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "core/coordinates.h"
#include "core/kernel_library.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kLayout = {{1, 2, 2, 1, 2}};

std::vector<std::string> names(bool sequences_only) {
  std::vector<std::string> names;
  for (const SamplerInfo& info : SamplerCatalogue::built_in().list()) {
    if (info.sequence || !sequences_only) names.push_back(info.name);
  }
  return names;
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string text = info.param;
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

class EverySampler : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, EverySampler, testing::ValuesIn(names(false)), test_name);
class EverySequence : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, EverySequence, testing::ValuesIn(names(true)), test_name);

TEST_P(EverySampler, CoordinatesAreBelowOneAndBinary32IsTheTopOfBinary64) {
  const auto sampler = sampler_named(GetParam());
  for (const std::uint64_t count : {1u, 100u, 5000u}) {
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
  const Points points = points_of(*sampler, 300, kLayout);
  sampler->prepare({.count = 300, .layout = &kLayout, .key = kTestKey, .pixel = 7, .replicate = 0, .low_words = false});
  PointBlock block;
  block.reset(kLayout.dims(), 300, false);
  sampler->fill(0, block);
  for (int dim = 0; dim < block.dims(); ++dim) {
    for (int s = 0; s < 300; ++s) {
      for (int lane = 0; lane < kLanes; ++lane) {
        ASSERT_EQ(block.high(dim)[s * kLanes + lane], points.at(dim, static_cast<std::uint64_t>(s), lane) >> 21);
      }
    }
  }
}

TEST_P(EverySampler, MarginalOfEachIndexIsUniform) {
  // 65536 replicates in 64 bins of the coordinate and 64 of its digits 2⁻⁷ … 2⁻¹²: χ² with 63 degrees, false alarm 1e-9
  // for each of about 300.
  constexpr std::uint32_t kGroups = 4096;
  const auto sampler = sampler_named(GetParam());
  for (const std::uint64_t count : {1u, 5u, 8u}) {
    std::vector<std::array<std::array<std::uint32_t, 64>, 2>> bins(count * static_cast<std::size_t>(kLayout.dims()));
    for (std::uint32_t group = 0; group < kGroups; ++group) {
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

TEST_P(EverySampler, PixelsSeedsAndReplicatesAreIndependentAndRepeatable) {
  const auto sampler = sampler_named(GetParam());
  const StreamKey other_key = stream_key(20240230, "test", "points");
  const Points points = points_of(*sampler, 64, kLayout);
  EXPECT_EQ(points, points_of(*sampler_named(GetParam()), 64, kLayout));
  // Lane l is replicate + l.
  const Points shifted = points_of(*sampler, 64, kLayout, 5);
  for (int lane = 0; lane + 5 < kLanes; ++lane) {
    for (std::uint64_t i = 0; i < 64; ++i) ASSERT_EQ(shifted.at(3, i, lane), points.at(3, i, lane + 5));
  }
  // Against the next pixel, seed and replicate: 16 × 16 bins at six indices, false alarm 1e-8 each.
  std::array<std::array<std::uint32_t, 256>, 3> joint = {};
  for (std::uint32_t pixel = 0; pixel < 512; ++pixel) {
    const Points here = points_of(*sampler, 6, kLayout, 0, pixel);
    const std::array<Points, 3> others = {points_of(*sampler, 6, kLayout, 0, pixel + 1000),
                                          points_of(*sampler, 6, kLayout, 0, pixel, other_key),
                                          points_of(*sampler, 6, kLayout, kLanes, pixel)};
    for (std::uint64_t i = 0; i < 6; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) {
        for (std::size_t o = 0; o < others.size(); ++o) {
          ++joint[o][here.interval(1, i, lane, 16) * 16 + others[o].interval(1, i, lane, 16)];
        }
      }
    }
  }
  for (const auto& counts : joint) {
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(counts)), chi_squared_upper(255, 1e-8));
  }
}

TEST_P(EverySampler, BlocksMayBeFilledInAnySplitAndOrder) {
  std::mt19937 random(1);
  const auto sampler = sampler_named(GetParam());
  for (const std::uint64_t count : {1u, 37u, 1000u, 4500u}) {
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
  const Points longest = points_of(*sampler, 100000, kLayout, 0, 7, kTestKey, 3000);
  for (const std::uint64_t count : {1u, 2u, 3u, 9u, 17u, 128u, 243u, 255u, 256u, 257u, 999u, 3000u}) {
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
  for (const std::uint64_t count : {3u, 1000u, 5003u}) {
    std::vector<Points> points;
    for (const Isa isa : isas) {
      const IsaScope scope(to_string(isa));
      points.push_back(points_of(*sampler_named(GetParam()), count, kLayout));
    }
    for (std::size_t i = 1; i < points.size(); ++i) EXPECT_EQ(points[i], points[0]) << to_string(isas[i]);
  }
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
  EXPECT_EQ(none->above, 1u);
  EXPECT_FALSE(sampler->illegal(1, kLayout));
  const auto many = sampler->illegal(info.max_count + 1, kLayout);
  ASSERT_TRUE(many);
  EXPECT_FALSE(sampler->illegal(many->below.value(), kLayout));
  EXPECT_TRUE(sampler->illegal(many->below.value() + 1, kLayout));
}

}  // namespace
}  // namespace halfslope
