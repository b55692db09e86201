// The same estimates from every instruction set, and in both precisions, on pixels of the shipped scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "estimators/direct_lighting.h"
#include "scenes/catalogue.h"
#include "tests/estimators/estimates.h"
#include "tests/estimators/isa_scope.h"
#include "tests/estimators/scene_builder.h"

namespace halfslope {
namespace {

DirectLighting veach() { return {load_catalogue_scene("veach-mis"), 96, 64}; }

/// Disks, rectangles and spheres in colour, in each other's way, over a floor of `bsdf`; the light's plates reflect as
/// well.
DirectLighting room(const Bsdf& bsdf) {
  const Primitive floor = made_of(rectangle(Vec3::Zero(), 2 * Vec3::UnitX(), 2 * Vec3::UnitY()), bsdf),
                  plate = emitting(disk({-1, 1, 1.2}, 0.5 * Vec3::UnitY(), 0.3 * Vec3::UnitX()), Rgb(0, 3, 1)),
                  window = emitting(rectangle({1.5, 0, 1}, 0.4 * Vec3(0.5, 0, 1), 0.7 * Vec3::UnitY()), Rgb(1, 2, 3)),
                  bulb = emitting(sphere({-1, -0.8, 1.5}, 0.3), Rgb(4, 0.5, 1)),
                  screen = made_of(disk({-0.5, -0.5, 0.7}, Vec3(0.3, 0, 0.1), Vec3(0, 0.4, 0)), diffuse(grey(0.5))),
                  ball = made_of(sphere({0.4, 0.6, 0.3}, 0.3), conductor(0.4, Rgb(0.14, 0.37, 1.4), Rgb(4, 2.4, 1.6)));
  std::vector<Ray> rays;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 12; ++x) rays.push_back(looking({0.2, -0.1, 4}, {0.3 * (x - 5.5), 0.3 * (y - 5.5), 0}));
  }
  return lighting(scene_of({floor, plate, window, bulb, screen, ball}, rays));
}
DirectLighting diffuse_room() { return room(diffuse(Rgb(0.2, 0.5, 0.9))); }
DirectLighting phong_room() { return room(phong(Rgb(0.1, 0.3, 0.2), Rgb(0.5, 0, 0.4), 40)); }

/// Estimates of pixels across the image, every shape of the scene among them, under an instruction set.
template <class T>
std::vector<double> estimates_by(Isa isa, const std::string& estimator, std::uint64_t rounds,
                                 DirectLighting (*scene)() = veach) {
  const IsaScope scope(isa);
  const DirectLighting source = scene();
  std::vector<double> all;
  for (int pixel = 0; pixel < source.pixels(); pixel += source.channels() == 1 ? 37 : 5) {
    if (!source.pixel(pixel).integral) continue;
    for (const auto& channel :
         estimate<T>(source, pixel, {.estimator = estimator, .rounds = rounds, .replicates = kLanes})) {
      all.insert(all.end(), channel.begin(), channel.end());
    }
  }
  EXPECT_GT(all.size(), 300u);
  return all;
}

const std::string kMix = "@light*2+bsdf+hemisphere+cosine+surface";
/// Estimators that need no exponential: their bits are the same from scalars and from packets.
const std::vector<std::string>& plain_estimators() {
  static const std::vector<std::string> kNames = {"light",
                                                  "bsdf",
                                                  "average",
                                                  "balance",
                                                  "power",
                                                  "power:3",
                                                  "power:4",
                                                  "power@light*3+bsdf",
                                                  "hemisphere",
                                                  "cosine",
                                                  "surface",
                                                  "cutoff:0.1",
                                                  "maximum",
                                                  "balance" + kMix,
                                                  "maximum" + kMix,
                                                  "cutoff:0.5" + kMix,
                                                  "power@hemisphere+surface"};
  return kNames;
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
  for (const auto scene : {veach, diffuse_room}) {
    for (const std::string& estimator : plain_estimators()) {
      EXPECT_EQ(estimates_by<TypeParam>(Isa::kScalar, estimator, 64, scene),
                estimates_by<TypeParam>(Isa::kAvx2, estimator, 64, scene))
          << estimator;
    }
  }
}

TYPED_TEST(Kernels, Avx2AndAvx512GiveTheSameBits) {
  if (!supported(Isa::kAvx512)) GTEST_SKIP() << "this processor lacks AVX-512";
  std::vector<std::string> estimators = plain_estimators();
  estimators.insert(estimators.end(), {"power:7.3", "power:0.5", "power:0.5" + kMix});
  for (const auto scene : {veach, phong_room}) {
    for (const std::string& estimator : estimators) {
      EXPECT_EQ(estimates_by<TypeParam>(Isa::kAvx2, estimator, 64, scene),
                estimates_by<TypeParam>(Isa::kAvx512, estimator, 64, scene))
          << estimator;
    }
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

TYPED_TEST(Kernels, PhongAgreesWithTheScalarLibrarysExponentials) {
  if (!supported(Isa::kAvx2)) GTEST_SKIP() << "this processor lacks AVX2";
  constexpr bool kSingle = std::is_same_v<TypeParam, float>;
  for (const std::string& estimator : plain_estimators()) {
    const auto scalar = estimates_by<TypeParam>(Isa::kScalar, estimator, 64, phong_room);
    const auto packet = estimates_by<TypeParam>(Isa::kAvx2, estimator, 64, phong_room);
    std::size_t apart = 0;  // a hit that rounding makes a miss, or the other way about
    for (std::size_t i = 0; i < scalar.size(); ++i) {
      apart += std::fabs(packet[i] - scalar[i]) > (kSingle ? 1e-4 : 1e-12) * scalar[i] ? 1 : 0;
    }
    EXPECT_LT(static_cast<double>(apart), 2e-3 * static_cast<double>(scalar.size())) << estimator;
  }
}

TYPED_TEST(Kernels, TheBaselineHasNoFusedMultiplyAddAndStaysClose) {
  if (!supported(Isa::kAvx2)) GTEST_SKIP() << "this processor lacks AVX2";
  constexpr bool kSingle = std::is_same_v<TypeParam, float>;
  for (const std::string estimator : {"light", "bsdf", "balance", "power:7.3", "surface", "cosine"}) {
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
  for (const auto scene : {veach, diffuse_room, phong_room}) {
    for (const std::string& estimator : plain_estimators()) {
      // So many samples that one which jumps across a cutoff does not show.
      const auto f32 = estimates_by<float>(isa, estimator, 1024, scene),
                 f64 = estimates_by<double>(isa, estimator, 1024, scene);
      EXPECT_NEAR(mean(f32) / mean(f64), 1, 3e-4) << estimator;
      std::size_t apart = 0;
      for (std::size_t i = 0; i < f64.size(); ++i) apart += std::fabs(f32[i] - f64[i]) > 2e-3 * f64[i] ? 1 : 0;
      EXPECT_LT(static_cast<double>(apart), 1e-2 * static_cast<double>(f64.size())) << estimator;
    }
  }
}

}  // namespace
}  // namespace halfslope
