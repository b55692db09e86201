// Each sample of the kernels against a reference that knows no shortcut: over random scenes, whether the sample is
// worth anything, what it is worth, and all five densities of its direction.
#include "estimators/occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "samplers/catalogue.h"
#include "scenes/ggx.h"
#include "tests/estimators/random_scenes.h"
#include "tests/estimators/reference_tracer.h"

namespace halfslope {
namespace {

constexpr int kSamples = 16;  // × kLanes at each receiver

/// How closely a kernel in T must follow, and what is left out as a matter of rounding.
template <class T>
struct Closeness {
  static constexpr bool kSingle = std::is_same_v<T, float>;
  static constexpr double kNudge = kSingle ? 2e-4 : 1e-7;
  static constexpr double kRelative = kSingle ? 5e-3 : 1e-7;
  static constexpr double kLeastAlpha = kSingle ? 0.1 : 0.03;
};

/// A coordinate as the kernels of T see it.
template <class T>
double seen_as(const PointBlock& points, int dim, int sample, int lane) {
  const double u = points.coordinate(dim, sample, lane);
  return std::is_same_v<T, float> ? std::floor(u * 0x1p24) * 0x1p-24 : u;
}

constexpr const char* kTechniques[] = {"light", "bsdf", "hemisphere", "cosine", "surface"};

/// A local direction by height and azimuth.
Vec<double> around(double z, double u) {
  const double ring = std::sqrt(std::max(0.0, 1 - z * z)), azimuth = 2 * std::numbers::pi * u;
  return {ring * std::cos(azimuth), ring * std::sin(azimuth), z};
}

/// The axes of Duff and others, "Building an orthonormal basis, revisited" (2017).
std::array<Vec3, 3> frame_about(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  return {Vec3(1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()), Vec3(b, sign + n.y() * n.y() * a, -n.y()), n};
}

/// The local direction of a sample of `bsdf`: by the cosine, a mirrored visible normal, or about the mirror direction.
Vec<double> bsdf_direction(const Bsdf& bsdf, double share, const Vec<double>& wo, double u_lobe, double u1, double u2) {
  if (bsdf.kind == BsdfKind::kRoughConductor) {
    const Vec<double> h = sample_ggx_visible_normal(bsdf.alpha, wo, u1, u2);
    return 2 * dot(wo, h) * h - wo;
  }
  if (bsdf.kind == BsdfKind::kDiffuse || u_lobe >= share) {
    return around(std::sqrt(1 - u1), u2);
  }
  const Vec<double> lobe = around(std::pow(1 - u1, 1 / (bsdf.exponent + 1)), u2);
  const auto [x, y, z] = frame_about({-wo.x, -wo.y, wo.z});
  const Vec3 wi = lobe.x * x + lobe.y * y + lobe.z * z;
  return {wi.x(), wi.y(), wi.z()};
}

/// The world direction of a sample of `bsdf` (1), `hemisphere` (2) or `cosine` (3).
Vec3 direction(const ReferenceTracer& tracer, int technique, double u_lobe, double u1, double u2) {
  const auto [x, y, z] = frame_about(tracer.normal());
  const Vec<double> wo = {x.dot(tracer.to_eye()), y.dot(tracer.to_eye()), z.dot(tracer.to_eye())};
  const bool is_phong = tracer.bsdf().kind == BsdfKind::kPhong;
  const Vec<double> local =
      technique == 1 ? bsdf_direction(tracer.bsdf(), is_phong ? tracer.specular_share() : 0, wo, u_lobe, u1, u2)
                     : around(technique == 2 ? 1 - u1 : std::sqrt(1 - u1), u2);
  return local.x * x + local.y * y + local.z * z;
}

struct Tally {
  long compared = 0, grazing = 0, lit = 0, blocked = 0, blocked_by_own_inside = 0, lit_by_own_inside = 0;
};

/// Whether the primitive alone is in the way from just above the receiver to the point.
bool stands_between(const Primitive& primitive, const Vec3& from, const Vec3& to, double slack) {
  Scene alone;
  alone.primitives = {primitive};
  return first_hit(alone, {from, (to - from).normalized()}).distance < (to - from).norm() - slack &&
         first_hit(alone, {from, (to - from).normalized()}).primitive == 0;
}

/// The promises of light_reaches and can_occlude, for a light sample whose cosines are both positive.
void check_promises(const Scene& scene, const Receiver& receiver, const ExpectedTerm& term, Tally& tally) {
  const Primitive& light = scene.primitives[static_cast<std::size_t>(term.light)];
  const bool contributes = term.densities[0] > 0, own = term.light == receiver.primitive;
  ASSERT_TRUE(!contributes || light_reaches(receiver, light, own));
  if (contributes && own) ++tally.lit_by_own_inside;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    if (static_cast<int>(i) == term.light) continue;
    const Primitive& shape = scene.primitives[i];
    if (!stands_between(shape, receiver.position + 1e-6 * receiver.normal, term.point, 1e-6)) continue;
    ++tally.blocked;
    if (static_cast<int>(i) == receiver.primitive) ++tally.blocked_by_own_inside;
    ASSERT_TRUE(can_occlude(receiver, light, shape)) << "primitive " << i << " before light " << term.light;
  }
}

/// Every sample of one technique at one receiver.
template <class T>
void check_receiver(const Scene& scene, const DirectLighting& source, int pixel, int technique, Tally& tally) {
  const Ray& ray = scene.sensor.rays[static_cast<std::size_t>(pixel)];
  const Hit seen = first_hit(scene, ray);
  ReferenceTracer tracer(scene, seen, -ray.direction, Closeness<T>::kNudge);
  const Layout& layout = source.techniques()[static_cast<std::size_t>(technique)].layout;
  const auto sampler = SamplerCatalogue::built_in().make("independent");
  sampler->prepare(
      {kSamples, &layout, stream_key(5, "independent", "test"), static_cast<std::uint32_t>(pixel), 0, true});
  PointBlock points;
  points.reset(layout.dims(), kSamples, true);
  sampler->fill(0, points);
  TermBlock<T> terms;
  terms.reset(1, source.channels(), 5, kSamples);
  const std::vector<int> all = {0, 1, 2, 3, 4};
  const PixelIntegral integral = source.pixel(pixel);
  if (integral.integral) {
    integral.integral->sample({technique, 0, 0, all}, points, terms);
  } else {  // no light reaches it: the tracer must say so of every sample
    std::fill_n(terms.value(0, 0), static_cast<std::size_t>(source.channels() + 5) * terms.stride(), T(0));
  }

  for (int s = 0; s < kSamples; ++s) {
    for (int l = 0; l < kLanes; ++l) {
      const int pair = layout.dims() - 2;
      const double u1 = seen_as<T>(points, pair, s, l), u2 = seen_as<T>(points, pair + 1, s, l);
      const double lobe = pair == 1 ? seen_as<T>(points, 0, s, l) : 0;
      const double choice = pair == 1 ? points.high(0)[static_cast<std::size_t>(s * kLanes + l)] * 0x1p-32 : 0;
      ExpectedTerm expected = technique == 0   ? tracer.light_sample(choice, u1, u2)
                              : technique == 4 ? tracer.surface_sample(choice, u1, u2)
                                               : tracer.direction_sample(direction(tracer, technique, lobe, u1, u2));
      // Which part of a Phong BSDF a number chooses is a matter of rounding beside the border.
      if (technique == 1 && tracer.bsdf().kind == BsdfKind::kPhong) {
        expected.grazing = expected.grazing || std::abs(lobe - tracer.specular_share()) < Closeness<T>::kNudge;
      }
      ++(expected.grazing ? tally.grazing : tally.compared);
      if (expected.grazing) continue;
      const std::size_t i = static_cast<std::size_t>(s * kLanes + l);
      const std::string what = "pixel " + std::to_string(pixel) + ' ' + kTechniques[technique] + " sample " +
                               std::to_string(i) + ", receiver on " + std::to_string(seen.primitive);
      const bool worth = expected.densities[0] > 0;
      const double surface_rounding = worth ? tracer.choice_rounding(expected.light) : 0;
      const auto close = [&](double found, double exact, double more = 0) {
        ASSERT_LE(std::fabs(found - exact), (Closeness<T>::kRelative + more) * exact)
            << what << ": " << found << " is not " << exact;
      };
      for (int c = 0; c < source.channels(); ++c) {
        const double exact = worth ? expected.value[c] / expected.densities[static_cast<std::size_t>(technique)] : 0;
        close(terms.value(0, c)[i], exact, technique == 4 ? surface_rounding : 0);
      }
      if (worth) {  // a sample that is worth nothing may have any densities
        ++tally.lit;
        for (int t = 0; t < 5; ++t) {
          close(terms.pdf(0, t)[i], expected.densities[static_cast<std::size_t>(t)], t == 4 ? surface_rounding : 0);
        }
      }
      if ((technique == 0 || technique == 4) && expected.faces && !Closeness<T>::kSingle) {
        check_promises(scene, {seen.position, seen.normal, seen.primitive}, expected, tally);
      }
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
}

template <class T>
Tally check_random_scenes(std::uint64_t seed, int scenes, int rays) {
  Tally tally;
  RandomScenes random(seed);
  for (int k = 0; k < scenes; ++k) {
    SCOPED_TRACE("scene " + std::to_string(k));
    const Scene scene = random.scene(rays, Closeness<T>::kLeastAlpha);
    if (scene.sensor.rays.empty()) continue;
    const DirectLighting source = lighting(scene);
    for (int pixel = 0; pixel < source.pixels(); ++pixel) {
      for (const int technique : {0, 1, 2, 3, 4}) {
        check_receiver<T>(scene, source, pixel, technique, tally);
        if (::testing::Test::HasFatalFailure()) return tally;
      }
    }
  }
  return tally;
}

TEST(Occlusion, EverySampleIsWorthWhatTheReferenceSaysInBinary64) {
  const Tally tally = check_random_scenes<double>(1, 400, 12);
  // The scenes are hard enough to mean something.
  EXPECT_GT(tally.lit, 100'000);
  EXPECT_GT(tally.blocked, 50'000);
  EXPECT_GT(tally.blocked_by_own_inside, 1'000);
  EXPECT_GT(tally.lit_by_own_inside, 1'000);
  EXPECT_LT(tally.grazing, tally.compared / 200);
}

TEST(Occlusion, EverySampleIsWorthWhatTheReferenceSaysInBinary32) {
  const Tally tally = check_random_scenes<float>(2, 150, 12);
  EXPECT_GT(tally.lit, 30'000);
  EXPECT_LT(tally.grazing, tally.compared / 5);
}

}  // namespace
}  // namespace halfslope
