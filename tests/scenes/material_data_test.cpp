#include "scenes/material_data.h"

#include <gtest/gtest.h>

#include "tests/scenes/bsdf_materials.h"

namespace halfslope {
namespace {

TEST(MaterialData, RoughnessIsAtLeastOneTenThousandth) {
  Bsdf bsdf = rough(BsdfKind::kRoughConductor, Distribution::kGgx, 1e-9);
  EXPECT_FLOAT_EQ(material_data<float>(bsdf).alpha_u, 1e-4f);
  EXPECT_FLOAT_EQ(material_data<float>(bsdf).alpha_v, 1e-4f);
  bsdf.alpha = 0.2;
  EXPECT_EQ(material_data<double>(bsdf).alpha_v, 0.2);
  bsdf.alpha_v = 0.7;
  EXPECT_EQ(material_data<double>(bsdf).alpha_u, 0.2);
  EXPECT_EQ(material_data<double>(bsdf).alpha_v, 0.7);
}

TEST(MaterialData, ARoughSurfaceBetweenEqualIndicesIsNone) {
  Bsdf bsdf = rough(BsdfKind::kRoughDielectric, Distribution::kGgx, 0.3);
  bsdf.ior = 1;
  EXPECT_EQ(material_data<float>(bsdf).kind, BsdfKind::kDielectric);
  const auto glass = bsdf_of<float>(bsdf);
  const BsdfSample<float, 1> s = glass->sample(at_cosine<float>(0.3), 0, 0.2f, 0.3f);
  EXPECT_EQ(s.weight[0], 1);
  EXPECT_NEAR(length(s.wi + at_cosine<float>(0.3)), 0, 1e-7);
}

TEST(MaterialData, AConductorWithoutIndexReflectsAllToTheBit) {
  Bsdf bsdf = white(BsdfKind::kConductor);
  bsdf.eta = bsdf.k = Rgb::Constant(2);  // not looked at
  const auto mirror_f32 = bsdf_of<float>(bsdf);
  for (const double cosine : {1.0, 0.3, 1e-6}) {
    EXPECT_EQ(mirror_f32->sample(at_cosine<float>(cosine), 0, 0, 0).weight[0], 1);
    for (const float k : {0.1f, 1.0f, 7.3f}) {
      EXPECT_EQ(fresnel_conductor(static_cast<float>(cosine), 0.0f, k), 1) << "what lets kernels skip it";
    }
  }
}

TEST(MaterialData, ALoneLobeIsAlwaysChosenAndAMissingOneNever) {
  for (const BsdfKind kind : {BsdfKind::kPhong, BsdfKind::kPlastic, BsdfKind::kRoughPlastic}) {
    Bsdf bsdf = white(kind);
    bsdf.alpha = 0.1;
    bsdf.reflectance = Rgb::Zero();
    EXPECT_EQ(material_data<float>(bsdf).specular_share, 1);
    const float last = 0x1.fffffep-1f;
    const auto shiny = bsdf_of<float>(bsdf)->sample(at_cosine<float>(0.6), last, 0.3f, 0.4f);
    EXPECT_GT(shiny.weight[0], 0.01);
    bsdf.reflectance = Rgb::Ones();
    bsdf.specular = Rgb::Zero();
    EXPECT_EQ(material_data<float>(bsdf).specular_share, 0);
    const auto matt = bsdf_of<float>(bsdf)->sample(at_cosine<float>(0.6), 0, 0.3f, 0.4f);
    EXPECT_GT(matt.weight[0], 0.01);
    EXPECT_FALSE(matt.delta);
  }
  // Neither part is dropped by rounding, however small.
  Bsdf bsdf = white(BsdfKind::kPhong);
  bsdf.specular = Rgb::Constant(1e-12);
  EXPECT_GT(material_data<float>(bsdf).specular_share, 0);
  bsdf.specular = Rgb::Constant(1);
  bsdf.reflectance = Rgb::Constant(1e-12);
  EXPECT_LT(material_data<float>(bsdf).specular_share, 1);
}

using F = NativePacket<double>;
constexpr std::size_t kLanesOfF = static_cast<std::size_t>(kWidth<F>);

/// What a BSDF class is constructed from, with a material for each lane.
struct PerLane {
  const std::vector<MaterialData<double>>& materials;
  template <class Read>
  F gather(const Read& read) const {
    alignas(64) double lanes[kLanesOfF];
    for (std::size_t i = 0; i < kLanesOfF; ++i) lanes[i] = read(materials[i]);
    return load<F>(lanes);
  }
  F operator()(double MaterialData<double>::*field) const {
    return gather([&](const auto& m) { return m.*field; });
  }
  template <std::size_t N, std::size_t C>
  void operator()(double (MaterialData<double>::*field)[N], F (&out)[C]) const {
    for (std::size_t c = 0; c < C; ++c) out[c] = gather([&](const auto& m) { return (m.*field)[c]; });
  }
};

/// Lanes of one packet with materials of their own give what each gives alone.
TEST(MaterialData, EachLaneHasItsOwnMaterial) {
  std::vector<MaterialData<double>> materials;
  for (std::size_t i = 0; i < kLanesOfF; ++i) {
    Bsdf bsdf = rough(BsdfKind::kRoughConductor, Distribution::kGgx, 0.05 + 0.3 * static_cast<double>(i));
    bsdf.unit_fresnel = i % 2 == 0;
    bsdf.eta = bsdf.k = Rgb::Constant(1.5);
    materials.push_back(material_data<double>(bsdf));
  }
  const GgxConductorBsdf<F, 1> mixed(PerLane{materials});
  const Vec<double> wo = at_cosine(0.5), wi = at_cosine(0.7, 3.5);
  const auto value = mixed.evaluate({F(wo.x), F(wo.y), F(wo.z)}, {F(wi.x), F(wi.y), F(wi.z)});
  alignas(64) double lanes[kLanesOfF];
  store(lanes, value.cosine_bsdf[0]);
  for (std::size_t i = 0; i < kLanesOfF; ++i) {
    EXPECT_EQ(lanes[i], bsdf_of<double>(materials[i])->evaluate(wo, wi).cosine_bsdf[0]) << i;
  }
}

}  // namespace
}  // namespace halfslope
