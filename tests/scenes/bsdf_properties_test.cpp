// What every BSDF class promises (scenes/bsdf_values.h), and reciprocity.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/scenes/bsdf_materials.h"

namespace halfslope {
namespace {

const std::vector<double> kAlphas = {1e-4, 0.001, 0.01, 0.1, 0.3, 1};

template <class T>
class BsdfProperties : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(BsdfProperties, Numbers);

template <class T>
Vec<T> random_direction(Uniform<T>& uniform) {
  const T z = 2 * uniform() - 1;
  return at_cosine<T>(z, 6.28 * uniform());
}

TYPED_TEST(BsdfProperties, WeightTimesDensityIsTheValue) {
  using T = TypeParam;
  const T ulps = 64 * std::numeric_limits<T>::epsilon();
  for (const NamedBsdf& named : all_bsdfs(kAlphas)) {
    const auto bsdf = bsdf_of<T>(named.bsdf);
    Uniform<T> uniform(5);
    for (int i = 0; i < 3000; ++i) {
      const Vec<T> wo = random_direction(uniform);
      const T u_lobe = uniform(), u1 = uniform(), u2 = uniform();
      const BsdfSample<T, 1> s = bsdf->sample(wo, u_lobe, u1, u2);
      if (s.delta || s.pdf == 0) continue;
      const BsdfValue<T, 1> value = bsdf->evaluate(wo, s.wi);
      ASSERT_EQ(s.pdf, value.pdf) << named << " to the bit";
      ASSERT_NEAR(s.weight[0] * s.pdf, value.cosine_bsdf[0], ulps * value.cosine_bsdf[0]) << named;
    }
  }
}

TYPED_TEST(BsdfProperties, OneSidedKindsScatterNothingFromBelow) {
  using T = TypeParam;
  for (const NamedBsdf& named : all_bsdfs({0.1})) {
    if (transmits(named.bsdf.kind)) continue;
    const auto bsdf = bsdf_of<T>(named.bsdf);
    Uniform<T> uniform(6);
    for (int i = 0; i < 1000; ++i) {
      Vec<T> wo = random_direction(uniform), wi = random_direction(uniform);
      if (wo.z > 0 && wi.z > 0) wo.z = -wo.z;
      const BsdfValue<T, 1> value = bsdf->evaluate(wo, wi);
      ASSERT_EQ(value.pdf, 0) << named;
      ASSERT_EQ(value.cosine_bsdf[0], 0) << named;
      if (wo.z > 0) continue;
      const BsdfSample<T, 1> s = bsdf->sample(wo, uniform(), uniform(), uniform());
      ASSERT_EQ(s.pdf, 0) << named;
      ASSERT_EQ(s.weight[0], 0) << named;
    }
  }
}

/// All corners of what may be asked: grazing, normal and exactly horizontal directions, first and last numbers.
TYPED_TEST(BsdfProperties, NothingIsEverNotANumber) {
  using T = TypeParam;
  const T last = 1 - std::numeric_limits<T>::epsilon() / 2;
  const std::array<T, 5> numbers = {0, std::numeric_limits<T>::epsilon() / 2, T(0.5), T(0.999), last};
  std::vector<Vec<T>> directions;
  for (const double cosine : {1.0, 0.7, 0.1, 1e-3, 1e-6, 1e-12, 1e-20, 0.0}) {
    for (const double azimuth : {0.0, 0.7, 3.14159}) {
      directions.push_back(at_cosine<T>(cosine, azimuth));
      directions.push_back(at_cosine<T>(-cosine, azimuth));
    }
  }
  std::vector<NamedBsdf> bsdfs = all_bsdfs(kAlphas);
  for (const double ior : {1.0 + 1e-6, 1.0003, 3.0, 0.4}) {
    for (NamedBsdf named : all_bsdfs({1e-4, 0.1, 1})) {
      named.bsdf.ior = ior;
      if (named.bsdf.kind != BsdfKind::kRoughPlastic && transmits(named.bsdf.kind)) bsdfs.push_back(named);
    }
  }
  for (NamedBsdf named : rough_bsdfs({0.01})) {
    if (named.bsdf.kind == BsdfKind::kRoughPlastic) continue;
    named.bsdf.alpha_v = 1;
    bsdfs.push_back(named);
  }
  for (const NamedBsdf& named : bsdfs) {
    const auto bsdf = bsdf_of<T>(named.bsdf);
    for (const Vec<T>& wo : directions) {
      for (const Vec<T>& wi : directions) {
        const BsdfValue<T, 1> value = bsdf->evaluate(wo, wi);
        ASSERT_TRUE(std::isfinite(value.pdf) && value.pdf >= 0) << named << ' ' << wo.z << ' ' << wi.z;
        ASSERT_TRUE(std::isfinite(value.cosine_bsdf[0]) && value.cosine_bsdf[0] >= 0) << named << ' ' << wo.z;
        // Density where there is value: but a value may be so small that its density underflows.
        ASSERT_TRUE(value.pdf > 0 || value.cosine_bsdf[0] < std::numeric_limits<T>::min() * 1e6)
            << named << ' ' << wo.z << ' ' << wi.z << ' ' << value.cosine_bsdf[0];
      }
      for (const T u_lobe : numbers) {
        for (const T u1 : numbers) {
          for (const T u2 : numbers) {
            const BsdfSample<T, 1> s = bsdf->sample(wo, u_lobe, u1, u2);
            ASSERT_NEAR(length(s.wi), 1, 1e-5) << named << ' ' << wo.z << ' ' << u_lobe << ' ' << u1 << ' ' << u2;
            ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0) << named << ' ' << wo.z << ' ' << u1 << ' ' << u2;
            ASSERT_TRUE(std::isfinite(s.weight[0]) && s.weight[0] >= 0) << named << ' ' << wo.z;
            ASSERT_TRUE(s.pdf > 0 || s.weight[0] == 0) << named << ' ' << wo.z;
          }
        }
      }
    }
  }
}

/// f(w_o, w_i) = f(w_i, w_o); across a surface, where f carries radiance, f(w_o, w_i) n_i² = f(w_i, w_o) n_o² with n
/// the index on either's side (Veach's thesis, 1997, §5.2).
TEST(BsdfReciprocity, HoldsForReflectionAndRefraction) {
  for (const NamedBsdf& named : all_bsdfs({0.001, 0.1, 1})) {
    const auto bsdf = bsdf_of<double>(named.bsdf);
    if (!bsdf->continuous) continue;
    Uniform<double> uniform(8);
    int scattered = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec<double> wo = random_direction(uniform);
      // Half of them where a narrow lobe is.
      Vec<double> wi = random_direction(uniform);
      const double u_lobe = uniform(), u1 = uniform(), u2 = uniform();
      if (i % 2) wi = bsdf->sample(wo, u_lobe, u1, u2).wi;
      const double forth = bsdf->evaluate(wo, wi).cosine_bsdf[0] / std::fabs(wi.z);
      const double back = bsdf->evaluate(wi, wo).cosine_bsdf[0] / std::fabs(wo.z);
      const double n = named.bsdf.ior;
      const double side_i = wi.z > 0 ? 1 : n, side_o = wo.z > 0 ? 1 : n;
      const bool crosses = (wi.z > 0) != (wo.z > 0);
      const double scale_i = crosses ? side_i * side_i : 1, scale_o = crosses ? side_o * side_o : 1;
      // A lobe of width α magnifies the directions' rounding by its steepness, and the root at the critical angle does.
      const double tolerance = 1e-12 + (crosses ? 1e-10 : 0) + 1e-13 / (named.bsdf.alpha * named.bsdf.alpha * 1e2);
      ASSERT_NEAR(forth * scale_i, back * scale_o, tolerance * (forth * scale_i + 1e-300) + 1e-290)
          << named << ' ' << wo.z << ' ' << wi.z;
      scattered += forth > 0;
    }
    EXPECT_GT(scattered, 500) << named;
  }
}

TEST(BsdfProperties, ARoughLobeOfNoRoughnessIsTheDeltaLobe) {
  // Albedos per outcome: reflection and refraction by a barely rough dielectric against Fresnel's F.
  for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
    const auto rough_glass = bsdf_of<double>(rough(BsdfKind::kRoughDielectric, distribution, 1e-4));
    const auto glass = bsdf_of<double>(white(BsdfKind::kDielectric));
    for (const double cosine : {1.0, 0.5, -0.5, -0.9}) {
      const Vec<double> wo = at_cosine(cosine);
      for (const double u_lobe : {0.0, 0.03, 0.2, 0.9}) {
        const BsdfSample<double, 1> a = rough_glass->sample(wo, u_lobe, 0.3, 0.4),
                                    b = glass->sample(wo, u_lobe, 0.3, 0.4);
        EXPECT_NEAR(length(a.wi - b.wi), 0, 2e-3) << cosine << ' ' << u_lobe;
        EXPECT_NEAR(a.weight[0], b.weight[0], 1e-3);
        EXPECT_EQ(a.eta, b.eta);
        EXPECT_FALSE(a.delta);
        EXPECT_TRUE(b.delta);
      }
    }
  }
}

TEST(BsdfProperties, RefractionObeysSnell) {
  const auto glass = bsdf_of<double>(white(BsdfKind::kDielectric));
  for (const double cosine : {1.0, 0.6, 0.1, -0.8, -0.95}) {
    const Vec<double> wo = at_cosine(cosine);
    const BsdfSample<double, 1> s = glass->sample(wo, 0.999, 0, 0);
    const double n = cosine > 0 ? 1.5 : 1 / 1.5;
    EXPECT_NEAR(std::hypot(s.wi.x, s.wi.y) * n, std::hypot(wo.x, wo.y), 1e-15);
    EXPECT_LE(s.wi.x * wo.x, 0);
    EXPECT_LT(s.wi.z * wo.z, 0);
    EXPECT_NEAR(s.weight[0] * n * n, 1, 1e-15);
    EXPECT_NEAR(s.eta, n, 1e-15);
  }
  // Beyond the critical angle, sin θ = 2/3, all is reflected.
  const BsdfSample<double, 1> total = glass->sample(at_cosine(-0.74), 0x1.fffffffffffffp-1, 0, 0);
  EXPECT_EQ(total.wi.z, -0.74);
  EXPECT_EQ(total.pdf, 1);
}

TEST(BsdfProperties, ClassesSayWhetherTheyChooseAndWhetherTheyAreContinuous) {
  for (const NamedBsdf& named : all_bsdfs({0.1})) {
    const BsdfKind kind = named.bsdf.kind;
    const auto bsdf = bsdf_of<double>(named.bsdf);
    EXPECT_EQ(bsdf->continuous, kind != BsdfKind::kConductor && kind != BsdfKind::kDielectric);
    const Vec<double> wo = at_cosine(0.9);
    const bool same = bsdf->sample(wo, 0, 0.3, 0.4).wi.z == bsdf->sample(wo, 0.999, 0.3, 0.4).wi.z;
    EXPECT_EQ(bsdf->chooses, !same) << named;
  }
}

/// All lanes of a packet at once against one at a time: each lane its own directions, numbers and material. Arithmetic
/// gives the same bits; exp, log, log1p, expm1 and erf have other roundings one at a time.
template <class T>
void expect_lanes_agree(const NamedBsdf& named) {
  using F = NativePacket<T>;
  constexpr std::size_t kLanesOfF = static_cast<std::size_t>(kWidth<F>);
  struct Lanes {
    alignas(64) std::array<T, kLanesOfF> x;
    F packet() const { return load<F>(x.data()); }
  };
  const auto lanes_of = [](const F& packet) {
    Lanes lanes;
    store(lanes.x.data(), packet);
    return lanes.x;
  };
  const auto packets = bsdf_of<F>(material_data<T>(named.bsdf));
  const auto scalars = bsdf_of<T>(named.bsdf);
  const bool transcendental = named.bsdf.distribution == Distribution::kBeckmann ||
                              named.bsdf.kind == BsdfKind::kPhong || named.bsdf.kind == BsdfKind::kRoughPlastic;
  const T slack = transcendental ? 4096 * std::numeric_limits<T>::epsilon() : 0;
  Uniform<T> uniform(9);
  for (int round = 0; round < 200; ++round) {
    Lanes ox, oy, oz, lobe, u1, u2;
    for (std::size_t i = 0; i < kLanesOfF; ++i) {
      const Vec<T> wo = random_direction(uniform);
      ox.x[i] = wo.x, oy.x[i] = wo.y, oz.x[i] = wo.z;
      lobe.x[i] = uniform(), u1.x[i] = uniform(), u2.x[i] = uniform();
    }
    const Vec<F> wo{ox.packet(), oy.packet(), oz.packet()};
    const BsdfSample<F, 1> sample = packets->sample(wo, lobe.packet(), u1.packet(), u2.packet());
    const BsdfValue<F, 1> value = packets->evaluate(wo, sample.wi);
    const auto x = lanes_of(sample.wi.x), y = lanes_of(sample.wi.y), z = lanes_of(sample.wi.z);
    const auto weight = lanes_of(sample.weight[0]), pdf = lanes_of(sample.pdf), eta = lanes_of(sample.eta);
    const auto delta = lanes_of(select(sample.delta, F(T(1)), F(T(0))));
    const auto cosine_bsdf = lanes_of(value.cosine_bsdf[0]), value_pdf = lanes_of(value.pdf);
    for (std::size_t i = 0; i < kLanesOfF; ++i) {
      const Vec<T> o{ox.x[i], oy.x[i], oz.x[i]};
      const BsdfValue<T, 1> v = scalars->evaluate(o, {x[i], y[i], z[i]});
      const auto near = [&](T found, T promised) {
        EXPECT_NEAR(found, promised, slack * std::fabs(promised)) << named << " lane " << i;
      };
      near(cosine_bsdf[i], v.cosine_bsdf[0]);
      near(value_pdf[i], v.pdf);
      if (transcendental) continue;  // the direction itself differs by roundings, and a narrow lobe magnifies them
      const BsdfSample<T, 1> s = scalars->sample(o, lobe.x[i], u1.x[i], u2.x[i]);
      near(x[i], s.wi.x), near(y[i], s.wi.y), near(z[i], s.wi.z);
      near(weight[i], s.weight[0]), near(pdf[i], s.pdf), near(eta[i], s.eta);
      EXPECT_EQ(delta[i] != 0, s.delta);
    }
  }
}

TYPED_TEST(BsdfProperties, PacketsAreTheirLanes) {
  for (const NamedBsdf& named : all_bsdfs({0.01, 0.3})) expect_lanes_agree<TypeParam>(named);
}

}  // namespace
}  // namespace halfslope
