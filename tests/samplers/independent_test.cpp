// The words under every randomised sampler.
#include "samplers/independent.h"

#include <gtest/gtest.h>

#include <array>

#include "core/kernel_library.h"
#include "samplers/kernels.h"
#include "tests/samplers/chi_squared.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

TEST(RandomWords, AreRandom123sPhiloxOnEveryIsaFromAnyBeginning) {
  const WordStream stream = {0xa4093822u, 0x299f31d0u, 0x13198a2eu, 0xfffffff8u};  // replicates pass 2³² − 1
  for (const Isa isa : supported_isas()) {
    const auto& table = kernels<SamplerKernels>(isa);
    for (const std::uint32_t begin : {0u, 1u, 2u, 3u, 4u, 4097u, 0x7ffffff1u}) {
      for (const int count : {1, 2, 3, 4, 5, 7, 64, 65}) {
        for (const Draw draw : {Draw::kHigh, Draw::kLow, Draw::kPermutation, Draw::kScramble}) {
          constexpr std::uint32_t kUntouched = 0xdeadbeefu;
          const std::uint32_t dim = 3 * begin % 1000, shift = draw == Draw::kLow ? 11 : 0;
          std::vector<std::uint32_t> words(static_cast<std::size_t>(count + 1) * kLanes, kUntouched);
          table.random_words(stream, static_cast<std::uint32_t>(draw), dim, begin, count, static_cast<int>(shift),
                             words.data());
          std::size_t i = 0;
          for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(count); ++s) {
            for (std::uint32_t lane = 0; lane < kLanes; ++lane, ++i) {
              const std::uint32_t word =
                  random_word({stream.key0, stream.key1}, draw, dim, begin + s, stream.replicate + lane, stream.pixel);
              ASSERT_EQ(words[i], word >> shift) << to_string(isa) << " begin " << begin << " sample " << s;
            }
          }
          for (; i < words.size(); ++i) ASSERT_EQ(words[i], kUntouched) << "written past the end";
        }
      }
    }
  }
}

TEST(Independent, CoordinatesOfAPointAndOfNeighboursAreIndependent) {
  // 16 × 16 bins of (x₀, x₁) at one index, and of x₀ at successive indices: χ² with 255 degrees, false alarm 1e-7 each.
  const auto sampler = sampler_named("independent");
  const Points points = points_of(*sampler, 8192, singles(2));
  std::array<std::array<std::uint32_t, 256>, 2> counts = {};
  for (std::uint64_t i = 0; i + 1 < points.count(); i += 2) {
    for (int lane = 0; lane < kLanes; ++lane) {
      ++counts[0][points.interval(0, i, lane, 16) * 16 + points.interval(1, i, lane, 16)];
      ++counts[1][points.interval(0, i, lane, 16) * 16 + points.interval(0, i + 1, lane, 16)];
    }
  }
  for (const auto& table : counts) {
    EXPECT_LT(chi_squared(std::span<const std::uint32_t>(table)), chi_squared_upper(255, 1e-7));
  }
}

TEST(Independent, VarianceOfTheMeanOfASumIsOneSixthOverN) {
  // f = x + y has variance 1/6. 8192 estimates of N = 64, nearly normal (kurtosis 3 − 0.6/64): the sample variance over
  // the exact one is χ²₈₁₉₁/8191 to within that. False alarm 2e-7.
  constexpr int kGroups = 512, kCount = 64, kEstimates = kGroups * kLanes;
  const auto sampler = sampler_named("independent");
  double sum = 0, squares = 0;
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    const Points points = points_of(*sampler, kCount, singles(2), group * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      double estimate = 0;
      for (std::uint64_t i = 0; i < kCount; ++i) estimate += (points(0, i, lane) + points(1, i, lane) - 1) / kCount;
      sum += estimate;
      squares += estimate * estimate;
    }
  }
  const double chi = (squares - sum * sum / kEstimates) / (1.0 / 6 / kCount);
  EXPECT_LT(chi, chi_squared_upper(kEstimates - 1, 1e-7));
  EXPECT_GT(chi, chi_squared_lower(kEstimates - 1, 1e-7));
}

}  // namespace
}  // namespace halfslope
