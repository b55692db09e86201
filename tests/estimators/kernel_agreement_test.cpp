// The same estimates from every instruction set, and in both precisions, on pixels of the shipped scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "estimators/direct_lighting.h"
#include "scenes/catalogue.h"
#include "tests/estimators/estimates.h"
#include "tests/estimators/isa_scope.h"

namespace halfslope {
namespace {

/// Pixels across the image: every shape of the scene is among them.
const std::vector<int>& sampled_pixels(const DirectLighting& source) {
  static const std::vector<int> kPixels = [&] {
    std::vector<int> pixels;
    for (int pixel = 0; pixel < source.pixels(); pixel += 37) {
      if (source.pixel(pixel).integral) pixels.push_back(pixel);
    }
    return pixels;
  }();
  return kPixels;
}

DirectLighting veach() { return {load_catalogue_scene("veach-mis"), 96, 64}; }

/// Estimates of all sampled pixels under an instruction set, one after another.
template <class T>
std::vector<double> estimates_by(Isa isa, const std::string& estimator, std::uint64_t rounds) {
  const IsaScope scope(isa);
  const DirectLighting source = veach();
  std::vector<double> all;
  for (const int pixel : sampled_pixels(source)) {
    for (const auto& channel :
         estimate<T>(source, pixel, {.estimator = estimator, .rounds = rounds, .replicates = kLanes})) {
      all.insert(all.end(), channel.begin(), channel.end());
    }
  }
  return all;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

bool supported(Isa isa) {
  const auto isas = supported_isas();
  return std::find(isas.begin(), isas.end(), isa) != isas.end();
}

template <class T>
class Kernels : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(Kernels, Numbers);

TYPED_TEST(Kernels, ScalarAndAvx2GiveTheSameBits) {
  if (!supported(Isa::kAvx2)) GTEST_SKIP() << "this processor lacks AVX2";
  for (const std::string estimator :
       {"light", "bsdf", "average", "balance", "power", "power:3", "power:4", "power@light*3+bsdf"}) {
    EXPECT_EQ(estimates_by<TypeParam>(Isa::kScalar, estimator, 64), estimates_by<TypeParam>(Isa::kAvx2, estimator, 64))
        << estimator;
  }
}

TYPED_TEST(Kernels, Avx2AndAvx512GiveTheSameBits) {
  if (!supported(Isa::kAvx512)) GTEST_SKIP() << "this processor lacks AVX-512";
  for (const std::string estimator :
       {"light", "bsdf", "average", "balance", "power", "power:3", "power:7.3", "power:0.5"}) {
    EXPECT_EQ(estimates_by<TypeParam>(Isa::kAvx2, estimator, 64), estimates_by<TypeParam>(Isa::kAvx512, estimator, 64))
        << estimator;
  }
}

TYPED_TEST(Kernels, GeneralPowersAgreeWithTheScalarLibrarysPow) {
  if (!supported(Isa::kAvx2)) GTEST_SKIP() << "this processor lacks AVX2";
  const auto scalar = estimates_by<TypeParam>(Isa::kScalar, "power:7.3", 64);
  const auto packet = estimates_by<TypeParam>(Isa::kAvx2, "power:7.3", 64);
  // exp and log of a few ulps each, their errors times β ln r, over weights that lie in [0, 1].
  const double tolerance = 1000 * std::numeric_limits<TypeParam>::epsilon();
  for (std::size_t i = 0; i < scalar.size(); ++i) ASSERT_NEAR(packet[i], scalar[i], tolerance * scalar[i]) << i;
}

TYPED_TEST(Kernels, TheBaselineHasNoFusedMultiplyAddAndStaysClose) {
  if (!supported(Isa::kAvx2)) GTEST_SKIP() << "this processor lacks AVX2";
  constexpr bool kSingle = std::is_same_v<TypeParam, float>;
  for (const std::string estimator : {"light", "bsdf", "balance", "power:7.3"}) {
    const auto fused = estimates_by<TypeParam>(Isa::kAvx2, estimator, 64);
    const auto plain = estimates_by<TypeParam>(Isa::kBaseline, estimator, 64);
    EXPECT_NEAR(mean(plain) / mean(fused), 1, kSingle ? 1e-3 : 1e-9) << estimator;
    std::size_t apart = 0;  // a hit that rounding makes a miss
    for (std::size_t i = 0; i < fused.size(); ++i) {
      apart += std::fabs(plain[i] - fused[i]) > (kSingle ? 2e-3 : 1e-9) * fused[i] ? 1 : 0;
    }
    EXPECT_LT(static_cast<double>(apart), 2e-3 * static_cast<double>(fused.size())) << estimator;
  }
}

TEST(Precision, Binary32FollowsBinary64) {
  // Binary32 coordinates are the top 24 bits of binary64 ones: a direction moves by some 1e-7, which is 2e-5 of the
  // smoothest plate's α = 0.005, and more of the slope of D at many α; and rarely a hit becomes a miss.
  const Isa isa = supported_isas().back();
  for (const std::string estimator : {"light", "bsdf", "average", "balance", "power"}) {
    const auto f32 = estimates_by<float>(isa, estimator, 256), f64 = estimates_by<double>(isa, estimator, 256);
    EXPECT_NEAR(mean(f32) / mean(f64), 1, 3e-4) << estimator;
    std::size_t apart = 0;
    for (std::size_t i = 0; i < f64.size(); ++i) apart += std::fabs(f32[i] - f64[i]) > 2e-3 * f64[i] ? 1 : 0;
    EXPECT_LT(static_cast<double>(apart), 1e-2 * static_cast<double>(f64.size())) << estimator;
  }
}

}  // namespace
}  // namespace halfslope
