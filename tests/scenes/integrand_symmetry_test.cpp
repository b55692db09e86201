// What is odd about the middle of the cube is exactly so, and every instruction set gives the same values.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/kernel_library.h"
#include "scenes/integrand.h"
#include "tests/estimators/isa_scope.h"
#include "tests/scenes/integrand_data.h"
#include "tests/scenes/integrand_samples.h"

namespace halfslope {
namespace {

/// Random points of `bits` digits, none 0, and their mirror images 1 − x.
struct Mirrored {
  PointBlock points, images;
  Mirrored(int dims, int bits) {
    points.reset(dims, kSamples, true);
    images.reset(dims, kSamples, true);
    std::mt19937_64 random(static_cast<std::uint64_t>(bits));
    constexpr std::uint64_t kOne = std::uint64_t{1} << 53;
    const auto put = [](PointBlock& block, int d, std::size_t i, std::uint64_t word) {
      block.high(d)[i] = static_cast<std::uint32_t>(word >> 21);
      block.low(d)[i] = static_cast<std::uint32_t>(word & ((1u << 21) - 1));
    };
    for (int d = 0; d < dims; ++d) {
      for (std::size_t i = 0; i < points.stride(); ++i) {
        std::uint64_t word = (random() >> (64 - bits) | 1) << (53 - bits);
        if (i < 8) word = (i + 1) << 50 < kOne ? (i + 1) << 50 : kOne / 2;  // eighths, where sines change their branch
        put(points, d, i, word);
        put(images, d, i, kOne - word);
      }
    }
  }
};

template <class T>
std::vector<double> values_at(const IntegralSource& scene, const PointBlock& points) {
  TermBlock<T> terms;
  terms.reset(1, 1, 1, points.samples());
  const std::vector<int> set = {0};
  scene.pixel(0).integral->sample({0, 0, 0, set}, points, terms);
  return {terms.value(0, 0), terms.value(0, 0) + points.stride()};
}

template <class T>
class IntegrandSymmetry : public testing::Test {};
TYPED_TEST_SUITE(IntegrandSymmetry, Numbers);

TYPED_TEST(IntegrandSymmetry, OddOnesAddUpToTwiceTheirIntegral) {
  for (const std::string name : {"sin2pix", "sinxy", "oddprod:d=1", "oddprod:d=3", "oddprod:d=7", "linearx", "triangle",
                                 "triangleramp", "simplex:d=3", "simplex:d=4", "simplex:d=9"}) {
    const auto scene = make_analytic_scene(name);
    for (const int bits : {24, 53}) {
      if (std::is_same_v<TypeParam, float> && bits > 24) continue;  // the image's own digits would be cut off
      const Mirrored mirrored(scene->techniques()[0].layout.dims(), bits);
      const auto values = values_at<TypeParam>(*scene, mirrored.points),
                 images = values_at<TypeParam>(*scene, mirrored.images);
      const double twice = 2 * (*scene->closed_form(0))[0];
      const bool step = name.starts_with("triangle") || name.starts_with("simplex");
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (step && i < 8) continue;  // may lie on the edge itself
        ASSERT_EQ(values[i] + images[i], twice) << name << ", " << bits << " bits, point " << i;
      }
    }
  }
}

TYPED_TEST(IntegrandSymmetry, InstructionSetsAgree) {
  const double epsilon = std::numeric_limits<TypeParam>::epsilon();
  for (const KnownIntegrand& known : known_integrands()) {
    SCOPED_TRACE(known.id);
    const auto by = [&](Isa isa) {
      const IsaScope scope(isa);
      const auto scene = make_analytic_scene(known.id);
      return values_at<TypeParam>(*scene, random_points(scene->techniques()[0].layout.dims()));
    };
    const auto scalar = by(Isa::kScalar);
    std::vector<double> fused;
    for (const Isa isa : supported_isas()) {
      if (isa == Isa::kScalar) continue;
      const auto values = by(isa);
      if (isa_class(isa) == "fma") {
        if (fused.empty()) fused = values;
        ASSERT_EQ(values, fused) << to_string(isa);
      }
      std::size_t far = 0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] == scalar[i]) continue;
        // An edge or a whole turn near the origin may fall to the other side.
        const double scale = known.id == "sininvr" ? 1e4 : known.id == "zoneplate100" ? 400 : 100;
        far += !(std::fabs(values[i] - scalar[i]) <= scale * epsilon * (1 + std::fabs(scalar[i])));
      }
      EXPECT_LE(far, known.id == "sininvr" ? 4u : 0u) << to_string(isa);
    }
  }
}

}  // namespace
}  // namespace halfslope
