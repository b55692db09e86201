// Shapes, BSDFs, textures, lights and cameras as Mitsuba's documentation describes them, with its defaults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "scenes/loader.h"
#include "scenes/materials.h"

namespace halfslope {
namespace {

Scene load(const std::string& body) {
  return parse_scene("<scene version=\"3.5.0\">\n<sensor type=\"radiancemeter\"/>\n" + body + "\n</scene>", "test.xml");
}
Primitive shape(const std::string& element) { return load(element).primitives.at(0); }
Primitive coated(const std::string& bsdf) { return shape("<shape type='sphere'>" + bsdf + "</shape>"); }
Bsdf bsdf(const std::string& type, const std::string& inside = "") {
  return coated("<bsdf type='" + type + "'>" + inside + "</bsdf>").bsdf;
}
Sensor sensor(const std::string& type, const std::string& inside) {
  return parse_scene(
             "<scene version='3.0.0'><sensor type='" + type + "'>" + inside + "</sensor><shape type='sphere'/></scene>",
             "test.xml")
      .sensor;
}
Scene lit(const std::string& type, const std::string& inside = "") {
  return load("<emitter type='" + type + "'>" + inside + "</emitter><shape type='sphere'/>");
}
bool equal(const Rgb& found, double r, double g, double b) { return (found == Rgb(r, g, b)).all(); }
bool equal(const Rgb& found, double grey) { return (found == grey).all(); }

TEST(LoaderSurfaces, CylinderDefaultsAndTransform) {
  const auto plain = std::get<Cylinder>(shape("<shape type='cylinder'/>").shape);
  EXPECT_EQ(plain.p0, Vec3::Zero());
  EXPECT_EQ(plain.p1, Vec3::UnitZ());
  EXPECT_EQ(plain.radius, 1);
  EXPECT_FALSE(plain.flip_normals);
  // Twice as long, three times as thick, laid along x.
  const auto laid = std::get<Cylinder>(
      shape("<shape type='cylinder'><point name='p0' value='0 0 1'/><point name='p1' value='0 0 2'/>"
            "<float name='radius' value='0.5'/><boolean name='flip_normals' value='true'/>"
            "<transform name='to_world'><scale x='3' y='3' z='2'/><rotate y='1' angle='90'/></transform></shape>")
          .shape);
  EXPECT_LE((laid.p0 - Vec3(2, 0, 0)).norm(), 1e-15);
  EXPECT_LE((laid.p1 - Vec3(4, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(laid.radius, 1.5);
  EXPECT_TRUE(laid.flip_normals);
  EXPECT_NEAR(laid.start.dot(laid.p1 - laid.p0), 0, 1e-15);
}

TEST(LoaderSurfaces, CubeIsAMeshOfTwelveTriangles) {
  const Primitive cube = shape("<shape type='cube'><transform name='to_world'><scale value='2'/></transform></shape>");
  EXPECT_EQ(std::get<std::shared_ptr<const Mesh>>(cube.shape)->triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(area(cube), 6 * 16);
}

TEST(LoaderSurfaces, SixDigitsOfARotationAreEnough) {
  // 40 degrees about z and 30 about x, as a file prints it.
  const auto flat = std::get<Flat>(
      shape(
          "<shape type='rectangle'><transform name='to_world'><matrix value='0.766044 -0.642788 0 0  0.55667 0.663414 "
          "-0.5 0  0.321394 0.383022 0.866025 0  0 0 0 1'/></transform></shape>")
          .shape);
  EXPECT_LE(std::abs(flat.half_u.dot(flat.half_v)), 1e-12);
}

TEST(LoaderSurfaces, ConductorsAreMirrorsUnlessAMetalIsNamed) {
  const Bsdf mirror = bsdf("conductor");
  EXPECT_EQ(mirror.kind, BsdfKind::kConductor);
  EXPECT_TRUE(mirror.unit_fresnel);
  EXPECT_TRUE(equal(mirror.reflectance, 1));
  const Bsdf gold = bsdf("roughconductor", "<string name='material' value='Au'/>");
  EXPECT_EQ(gold.distribution, Distribution::kBeckmann);  // Mitsuba's default
  EXPECT_FALSE(gold.unit_fresnel);
  EXPECT_GT(gold.eta[2], gold.eta[0]);
}

/// The reflectance of metals at normal incidence: handbooks have gold yellow, copper red, silver and aluminium white.
TEST(LoaderSurfaces, MetalsHaveTheirColours) {
  const auto reflectance = [](const char* name) -> Rgb {
    const auto metal = find_metal(name);
    const Rgb k2 = metal->k.square();
    return ((metal->eta - 1).square() + k2) / ((metal->eta + 1).square() + k2);
  };
  // CRC Handbook, at 620, 550 and 450 nm: to the width of the primaries.
  EXPECT_NEAR(reflectance("Ag").minCoeff(), 0.9, 0.07);
  EXPECT_NEAR(reflectance("Al").minCoeff(), 0.91, 0.03);
  EXPECT_GT(reflectance("Au")[0], 0.9);
  EXPECT_LT(reflectance("Au")[2], 0.5);
  EXPECT_GT(reflectance("Cu")[0], 0.9);
  EXPECT_LT(reflectance("Cu")[1], 0.7);
  for (const std::string& name : metal_names()) {
    const auto metal = find_metal(name);
    EXPECT_TRUE((metal->eta > 0).all() && (metal->k >= 0).all()) << name;
  }
  EXPECT_FALSE(find_metal("none"));
}

TEST(LoaderSurfaces, Anisotropy) {
  const Bsdf brushed = bsdf("roughconductor", "<float name='alpha_u' value='0.1'/><float name='alpha_v' value='0.4'/>");
  EXPECT_EQ(brushed.alpha, 0.1);
  EXPECT_EQ(brushed.alpha_v, 0.4);
  EXPECT_FALSE(
      bsdf("roughconductor", "<float name='alpha_u' value='0.1'/><float name='alpha_v' value='0.1'/>").alpha_v);
}

TEST(LoaderSurfaces, PlasticsAndTheirDefaults) {
  const Bsdf smooth = bsdf("plastic");
  EXPECT_EQ(smooth.kind, BsdfKind::kPlastic);
  EXPECT_DOUBLE_EQ(smooth.ior, 1.49 / 1.000277);  // polypropylene in air
  EXPECT_TRUE(equal(smooth.reflectance, 0.5));
  EXPECT_TRUE(equal(smooth.specular, 1));
  EXPECT_FALSE(smooth.nonlinear);
  const Bsdf rough =
      bsdf("roughplastic",
           "<string name='distribution' value='ggx'/><float name='alpha' value='0.3'/>"
           "<float name='int_ior' value='1.61'/><float name='ext_ior' value='1'/>"
           "<rgb name='diffuse_reflectance' value='0.1 0.2 0.3'/><boolean name='nonlinear' value='True'/>"
           "<rgb name='specular_reflectance' value='0.7'/>");
  EXPECT_EQ(rough.kind, BsdfKind::kRoughPlastic);
  EXPECT_EQ(rough.distribution, Distribution::kGgx);
  EXPECT_EQ(rough.alpha, 0.3);
  EXPECT_EQ(rough.ior, 1.61);
  EXPECT_TRUE(rough.nonlinear);
  EXPECT_TRUE(equal(rough.reflectance, 0.1, 0.2, 0.3));
  EXPECT_TRUE(equal(rough.specular, 0.7));
}

TEST(LoaderSurfaces, DielectricsAndTheirDefaults) {
  const Bsdf glass = bsdf("dielectric");
  EXPECT_EQ(glass.kind, BsdfKind::kDielectric);
  EXPECT_DOUBLE_EQ(glass.ior, 1.5046 / 1.000277);  // BK7 in air
  EXPECT_TRUE(equal(glass.specular, 1));
  EXPECT_TRUE(equal(glass.transmittance, 1));
  const Bsdf frosted = bsdf("roughdielectric",
                            "<string name='int_ior' value='Diamond'/><string name='ext_ior' value='water'/>"
                            "<float name='alpha' value='0.2'/><float name='specular_transmittance' value='0.5'/>");
  EXPECT_EQ(frosted.kind, BsdfKind::kRoughDielectric);
  EXPECT_DOUBLE_EQ(frosted.ior, 2.419 / 1.333);
  EXPECT_EQ(frosted.distribution, Distribution::kBeckmann);
  EXPECT_TRUE(equal(frosted.transmittance, 0.5));
}

TEST(LoaderSurfaces, TwoSides) {
  EXPECT_FALSE(coated("<bsdf type='diffuse'/>").back);
  const Primitive same =
      coated("<bsdf type='twosided'><bsdf type='diffuse'><float name='reflectance' value='0.3'/></bsdf></bsdf>");
  ASSERT_TRUE(same.back);
  EXPECT_TRUE(equal(same.bsdf.reflectance, 0.3));
  EXPECT_TRUE(equal(same.back->reflectance, 0.3));
  const Primitive other = coated("<bsdf type='twosided'><bsdf type='diffuse'/><bsdf type='plastic'/></bsdf>");
  EXPECT_EQ(other.bsdf.kind, BsdfKind::kDiffuse);
  EXPECT_EQ(other.back->kind, BsdfKind::kPlastic);
}

TEST(LoaderSurfaces, Masks) {
  const Primitive half = coated("<bsdf type='mask'><bsdf type='twosided'><bsdf type='diffuse'/></bsdf></bsdf>");
  EXPECT_EQ(half.bsdf.opacity, 0.5);  // Mitsuba's default
  EXPECT_EQ(half.back->opacity, 0.5);
  EXPECT_EQ(bsdf("mask", "<float name='opacity' value='0.25'/><bsdf type='dielectric'/>").opacity, 0.25);
  const Bsdf checked = bsdf("mask",
                            "<texture type='checkerboard' name='opacity'><float name='color0' value='1'/>"
                            "<float name='color1' value='0'/></texture><bsdf type='diffuse'/>");
  EXPECT_EQ(checked.opacity, 0.5);
  EXPECT_TRUE(equal(checked.opacity_texture->color0, 1));
}

TEST(LoaderSurfaces, CheckerboardsAndReferencesToThem) {
  const Scene scene = load(
      "<texture type='checkerboard' id='tiles'><rgb name='color0' value='0.1 0.2 0.3'/>"
      "<transform name='to_uv'><scale x='4' y='2'/><translate x='0.5' y='0.25'/></transform></texture>"
      "<shape type='rectangle'><bsdf type='diffuse'><ref id='tiles' name='reflectance'/></bsdf></shape>");
  const Bsdf& bsdf = scene.primitives[0].bsdf;
  ASSERT_TRUE(bsdf.reflectance_texture);
  EXPECT_TRUE(equal(bsdf.reflectance_texture->color0, 0.1, 0.2, 0.3));
  EXPECT_TRUE(equal(bsdf.reflectance_texture->color1, 0.2));  // Mitsuba's default
  EXPECT_EQ(Eigen::Vector2d(bsdf.reflectance_texture->to_uv * Eigen::Vector3d(1, 1, 1)), Eigen::Vector2d(4.5, 2.25));
  EXPECT_TRUE((bsdf.reflectance == 0.5 * (Rgb(0.1, 0.2, 0.3) + 0.2)).all());
}

TEST(LoaderSurfaces, PointLights) {
  const auto plain = std::get<PointLight>(lit("point").delta_lights.at(0));
  EXPECT_EQ(plain.position, Vec3::Zero());
  EXPECT_TRUE(equal(plain.intensity, 1));
  const auto moved = std::get<PointLight>(
      lit("point", "<point name='position' x='1' y='2' z='3'/><rgb name='intensity' value='4 5 6'/>").delta_lights[0]);
  EXPECT_EQ(moved.position, Vec3(1, 2, 3));
  EXPECT_TRUE(equal(moved.intensity, 4, 5, 6));
  EXPECT_EQ(
      std::get<PointLight>(
          lit("point", "<transform name='to_world'><translate x='1'/><scale value='2'/></transform>").delta_lights[0])
          .position,
      Vec3(2, 0, 0));
}

TEST(LoaderSurfaces, DirectionalLights) {
  EXPECT_EQ(std::get<DirectionalLight>(lit("directional").delta_lights.at(0)).direction, Vec3::UnitZ());
  const auto sun = std::get<DirectionalLight>(
      lit("directional", "<vector name='direction' value='0 -3 4'/><float name='irradiance' value='2'/>")
          .delta_lights[0]);
  EXPECT_LE((sun.direction - Vec3(0, -0.6, 0.8)).norm(), 1e-15);
  EXPECT_TRUE(equal(sun.irradiance, 2));
  const auto turned = std::get<DirectionalLight>(
      lit("directional", "<transform name='to_world'><rotate y='1' angle='90'/><scale value='5'/></transform>")
          .delta_lights[0]);
  EXPECT_EQ(turned.direction, Vec3::UnitX());
}

TEST(LoaderSurfaces, SpotLights) {
  const auto plain = std::get<SpotLight>(lit("spot").delta_lights.at(0));  // 20 degrees, three quarters of it full
  EXPECT_DOUBLE_EQ(plain.cutoff_angle, std::numbers::pi / 9);
  EXPECT_DOUBLE_EQ(plain.beam_width, std::numbers::pi / 12);
  EXPECT_EQ(plain.axis, Vec3::UnitZ());
  // A lookat without an up.
  const auto aimed =
      std::get<SpotLight>(lit("spot",
                              "<transform name='to_world'><lookat origin='1 1 1' target='1 2 1'/></transform>"
                              "<float name='cutoff_angle' value='60'/>")
                              .delta_lights[0]);
  EXPECT_EQ(aimed.position, Vec3(1, 1, 1));
  EXPECT_LE((aimed.axis - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(aimed.beam_width, std::numbers::pi / 4);
}

TEST(LoaderSurfaces, AConstantSky) {
  const Scene scene = lit("constant", "<rgb name='radiance' value='0.1 0.2 0.3'/>");
  ASSERT_TRUE(scene.environment);
  EXPECT_FALSE(scene.environment->map);
  EXPECT_TRUE(equal(scene.environment->radiance, 0.1, 0.2, 0.3));
  EXPECT_TRUE(equal(lit("constant").environment->radiance, 1));
}

TEST(LoaderSurfaces, EmittersMayBeReferredTo) {
  const std::string lamp =
      "<shape type='sphere'><emitter type='area' id='lamp'><float name='radiance' value='3'/>"
      "</emitter></shape>";
  EXPECT_TRUE(equal(load(lamp + "<shape type='disk'><ref id='lamp'/></shape>").primitives[1].radiance, 3));
}

TEST(LoaderSurfaces, FocalLengths) {
  // 50 mm on a full-frame film, 36 x 24 mm, sees 46.8 degrees across its diagonal.
  for (const char* given :
       {"", "<string name='focal_length' value='50mm'/>", "<string name='focal_length' value='50'/>"}) {
    const Sensor camera = sensor("perspective", given);
    EXPECT_EQ(camera.fov_axis, Sensor::FovAxis::kDiagonal);
    EXPECT_NEAR(camera.fov_degrees, 46.793, 1e-3);
  }
}

TEST(LoaderSurfaces, ThinLens) {
  const Sensor camera =
      sensor("thinlens",
             "<float name='aperture_radius' value='0.1'/><float name='focus_distance' value='7'/>"
             "<float name='fov' value='40'/><transform name='to_world'><translate z='2'/></transform>");
  EXPECT_EQ(camera.kind, Sensor::Kind::kThinLens);
  EXPECT_EQ(camera.aperture_radius, 0.1);
  EXPECT_EQ(camera.focus_distance, 7);
  const Ray ray = camera.ray(384, 288, 769, 577);  // the middle, through the middle of the lens
  EXPECT_EQ(ray.origin, Vec3(0, 0, 2));
  EXPECT_LE((ray.direction - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_EQ(sensor("thinlens", "<float name='aperture_radius' value='0.1'/>").focus_distance, 10'000);
}

TEST(LoaderSurfaces, Orthographic) {
  const Sensor camera = sensor(
      "orthographic",
      "<transform name='to_world'><scale x='10' y='10'/><lookat origin='0 0 5' target='0 0 0' up='0 1 0'/></transform>"
      "<film type='hdrfilm'><integer name='width' value='200'/><integer name='height' value='100'/></film>");
  EXPECT_EQ(camera.kind, Sensor::Kind::kOrthographic);
  // 20 wide and, at twice the width, 10 high; every ray looks along -z.
  const Ray top_left = camera.ray(0, 0, 200, 100), bottom_right = camera.ray(199, 99, 200, 100);
  EXPECT_LE((top_left.origin - Vec3(-9.95, 4.95, 5)).norm(), 1e-14);
  EXPECT_LE((bottom_right.origin - Vec3(9.95, -4.95, 5)).norm(), 1e-14);
  EXPECT_LE((top_left.direction + Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_EQ(top_left.direction, bottom_right.direction);
}

TEST(LoaderSurfaces, ReconstructionFilters) {
  using Kind = ReconstructionFilter::Kind;
  const auto filter = [](const std::string& inside) {
    return sensor("perspective", "<film type='hdrfilm'>" + inside + "</film>").filter;
  };
  EXPECT_EQ(filter("").kind, Kind::kGaussian);
  EXPECT_EQ(filter("").radius, 2);
  EXPECT_EQ(filter("<rfilter type='box'/>").kind, Kind::kBox);
  EXPECT_EQ(filter("<rfilter type='box'/>").radius, 0.5);
  EXPECT_EQ(filter("<rfilter type='tent'/>").radius, 1);
  const ReconstructionFilter wide = filter("<rfilter type='gaussian'><float name='stddev' value='0.75'/></rfilter>");
  EXPECT_EQ(wide.stddev, 0.75);
  EXPECT_EQ(wide.radius, 3);
}

TEST(LoaderSurfaces, PathIntegrators) {
  const auto path = [](const std::string& inside) {
    return load("<integrator type='path'>" + inside + "</integrator><shape type='sphere'/>");
  };
  EXPECT_EQ(path("<integer name='max_depth' value='6'/>").max_depth, 6);
  EXPECT_EQ(path("<integer name='max_depth' value='-1'/>").max_depth, -1);
  EXPECT_FALSE(path("").max_depth);
  EXPECT_FALSE(path("").rr_depth);
  EXPECT_EQ(path("<integer name='rr_depth' value='9'/><boolean name='hide_emitters' value='true'/>").rr_depth, 9);
  EXPECT_EQ(load("<integrator type='direct'/><shape type='sphere'/>").max_depth, 2);
  EXPECT_EQ(load("<integrator type='aov'><integrator type='volpath'><integer name='max_depth' value='7'/></integrator>"
                 "</integrator><shape type='sphere'/>")
                .max_depth,
            7);
}

}  // namespace
}  // namespace halfslope
