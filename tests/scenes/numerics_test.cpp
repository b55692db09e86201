// The stable forms against 30-digit answers, at inputs where the textbook formulas fail (numerics.json beside this
// file: inputs are exact binary32 numbers, f64 and f32 the relative errors that a form with a few roundings stays
// under).
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "scenes/beckmann.h"
#include "scenes/closed_form.h"
#include "scenes/ggx.h"
#include "scenes/intersection.h"
#include "scenes/measure.h"
#include "scenes/phong.h"
#include "scenes/solid_angle.h"
#include "scenes/sphere_cone.h"
#include "scenes/spherical_rectangle.h"
#include "scenes/spherical_triangle.h"
#include "scenes/warp.h"

namespace halfslope {
namespace {

using nlohmann::json;

json cases() {
  std::ifstream file(HALFSLOPE_SOURCE_DIR "/tests/scenes/numerics.json");
  return json::parse(file);
}

template <class F>
F evaluate(const json& entry) {
  const std::string function = entry.at("function");
  const json& inputs = entry.at("inputs");
  const auto in = [&](const char* name) { return static_cast<F>(inputs.at(name).get<double>()); };
  const auto vec = [&](const char* name) {
    const auto v = inputs.at(name).get<std::vector<double>>();
    return Vec<F>{static_cast<F>(v[0]), static_cast<F>(v[1]), static_cast<F>(v[2])};
  };
  if (function == "cone_solid_angle") return cone_solid_angle(in("theta"));
  if (function == "sphere_cap_solid_angle") return sphere_cap_solid_angle(in("R"), in("d"));
  if (function == "cone_pdf") return cone_pdf(in("R"), in("d"));
  if (function == "pdf_solid_angle_from_area") return pdf_solid_angle_from_area(in("pdfA"), in("r"), in("cos"));
  if (function == "geometry_term") return geometry_term(in("c1"), in("c2"), in("r"));
  if (function == "area_contribution") return area_contribution(in("f"), in("c1"), in("c2"), in("r"), in("pdfA"));
  if (function == "beckmann_d") return beckmann_d(in("alpha"), in("cos_h"));
  if (function == "ggx_d") return ggx_d(in("alpha"), in("cos_h"));
  if (function == "ggx_lambda") return ggx_lambda(in("alpha"), in("cos"));
  if (function == "ggx_g1_over_cos") return ggx_g1_over_cos(in("alpha"), in("cos"));
  if (function == "phong_lobe_pdf") {
    const F sine = std::sin(in("theta"));
    return phong_lobe_pdf(in("n"), sine * sine);
  }
  if (function == "phong_sample_sin") return sample_phong_angle(in("n"), F(1) - in("u")).sin;  // u is (cos α)^(n+1)
  if (function == "cosine_hemisphere_z") {
    return cosine_hemisphere(in("u"), in("phi") / (2 * std::numbers::pi_v<F>)).z;
  }
  if (function == "sphere_discriminant") {  // b² − 4ac
    const Vec<F> from_center = {in("off"), F(0), -in("o")}, direction = {F(0), F(0), F(1)};
    return 4 * half_chord_squared(from_center, direction, dot(from_center, direction), in("r"));
  }
  if (function == "polygon_form_factor") {  // in binary64 alone
    std::vector<Vec3> vertices;
    for (const json& input : inputs) {
      const std::vector<double> vertex = input;
      vertices.emplace_back(vertex.at(0), vertex.at(1), vertex.at(2));
    }
    return static_cast<F>(polygon_form_factor(vertices));
  }
  if (function == "triangle_solid_angle") {
    const Vec<F> corner = vec("v0");
    return triangle_solid_angle(corner, vec("v1") - corner, vec("v2") - corner);
  }
  if (function == "rectangle_solid_angle") {
    return rectangle_solid_angle<F>({in("x0"), in("y0"), in("z")}, {in("x1") - in("x0"), F(0), F(0)},
                                    {F(0), in("y1") - in("y0"), F(0)});
  }
  if (function == "cone_sample_sin") {  // a sphere one unit away
    const Vec<F> d = sample_sphere_solid_angle<F>({F(0), F(0), F(1)}, in("sinThetaMax"), in("u"), F(0)).direction;
    return std::hypot(d.x, d.y);
  }
  if (function == "ggx_visible_normal_pdf") return ggx_visible_normal_pdf(in("alpha"), vec("w"), vec("h"));
  throw std::runtime_error("no function " + function);
}

template <class F>
void check(const json& entry, const json& accepted) {
  const long double exact = std::stold(entry.at("exact").get<std::string>());
  const F found = evaluate<F>(entry);
  if (accepted.is_string()) {  // outside the type's normal range: the rounded answer itself, ∞ or subnormal
    EXPECT_EQ(found, static_cast<F>(exact)) << entry;
    return;
  }
  const long double error = std::fabs(static_cast<long double>(found) - exact) / std::fabs(exact);
  EXPECT_LE(error, accepted.get<long double>()) << entry << " found " << found;
}

TEST(Numerics, StableFormsHoldInBinary64) {
  for (const json& entry : cases()) check<double>(entry, entry.at("f64"));
}

TEST(Numerics, StableFormsHoldInBinary32) {
  for (const json& entry : cases()) check<float>(entry, entry.at("f32"));
}

template <class T>
void check_packets_agree() {
  using F = NativePacket<T>;
  const auto lane = [](const F& x) {
    alignas(64) std::array<T, static_cast<std::size_t>(kWidth<F>)> lanes;
    store(lanes.data(), x);
    return lanes.back();
  };
  const T alpha(0.1f), w_z(0.6f), u1(0.3f), u2(0.7f), eta(0.2f), k(3.9f);
  const Vec<T> w{T(0.8f), T(0), w_z};
  const Vec<F> packet_w{F(w.x), F(w.y), F(w.z)};
  const Vec<T> h = sample_ggx_visible_normal(alpha, w, u1, u2);
  const Vec<F> packet_h = sample_ggx_visible_normal(F(alpha), packet_w, F(u1), F(u2));
  const T ulps = 8 * std::numeric_limits<T>::epsilon();
  EXPECT_NEAR(lane(packet_h.x), h.x, ulps);
  EXPECT_NEAR(lane(packet_h.y), h.y, ulps);
  EXPECT_NEAR(lane(packet_h.z), h.z, ulps);
  const auto expect_same = [&](const F& packet, T scalar) { EXPECT_NEAR(lane(packet) / scalar, 1, ulps); };
  const Vec<F> same_h{F(h.x), F(h.y), F(h.z)};
  expect_same(ggx_visible_normal_pdf(F(alpha), packet_w, same_h), ggx_visible_normal_pdf(alpha, w, h));
  expect_same(ggx_visibility(F(alpha), F(w_z), F(h.z)), ggx_visibility(alpha, w_z, h.z));
  expect_same(ggx_lambda(F(alpha), F(w_z)), ggx_lambda(alpha, w_z));
  expect_same(fresnel_conductor(F(w_z), F(eta), F(k)), fresnel_conductor(w_z, eta, k));
  expect_same(cone_pdf(F(alpha), F(k)), cone_pdf(alpha, k));
  expect_same(pdf_solid_angle_from_area(F(alpha), F(k), F(w_z)), pdf_solid_angle_from_area(alpha, k, w_z));
}

TEST(Numerics, PacketsComputeWhatScalarsDo) {
  check_packets_agree<float>();
  check_packets_agree<double>();
}

TEST(Numerics, ContributionIsGeometryTermTimesValueOverDensity) {
  EXPECT_NEAR(area_contribution(3.0, 0.5, 0.25, 2.0, 0.7), 3 * geometry_term(0.5, 0.25, 2.0) / 0.7, 1e-15);
  // A density per area is carried over exactly: dω p_ω = dA p_A with dω = G dA for cos₁ = 1.
  EXPECT_NEAR(pdf_solid_angle_from_area(0.7, 2.0, -0.25) * geometry_term(1.0, 0.25, 2.0), 0.7, 1e-15);
}

}  // namespace
}  // namespace halfslope
