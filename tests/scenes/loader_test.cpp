#include "scenes/loader.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "core/error.h"

namespace halfslope {
namespace {

/// A scene around `body` with a ray down the z axis, so that files differ only in what they test.
Scene load(const std::string& body) {
  return parse_scene("<scene version=\"3.5.0\">\n<sensor type=\"radiancemeter\"/>\n" + body + "\n</scene>", "test.xml");
}

Primitive shape(const std::string& element) { return load(element).primitives.at(0); }

Flat rectangle(const std::string& steps) {
  return std::get<Flat>(
      shape("<shape type='rectangle'><transform name='to_world'>" + steps + "</transform></shape>").shape);
}

Sphere sphere(const std::string& properties) {
  return std::get<Sphere>(shape("<shape type='sphere'>" + properties + "</shape>").shape);
}

Bsdf bsdf(const std::string& element) { return shape("<shape type='sphere'>" + element + "</shape>").bsdf; }

Sensor sensor(const std::string& element) {
  return parse_scene("<scene version='3.0.0'>" + element + "<shape type='sphere'/></scene>", "test.xml").sensor;
}

void expect_vector(const Vec3& found, const Vec3& expected, double tolerance = 1e-15) {
  EXPECT_LE((found - expected).norm(), tolerance) << found.transpose() << " is not " << expected.transpose();
}

TEST(Loader, NamesTheSceneAfterTheFileAndShapesByPosition) {
  const Scene scene = parse_scene(
      "<scene version='3.0.0'><sensor type='radiancemeter'/><shape type='sphere' id='ball'/><shape "
      "type='sphere'/></scene>",
      "folder/two-balls.xml");
  EXPECT_EQ(scene.name, "two-balls");
  ASSERT_EQ(scene.primitives.size(), 2u);
  EXPECT_EQ(scene.primitives[0].id, "ball");
  EXPECT_EQ(scene.primitives[1].id, "shape2");
}

TEST(Loader, MissingFileIsBadInput) {
  try {
    load_scene("/nonexistent/scene.xml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
  }
}

TEST(Loader, IntegratorSamplerAndFilterDoNotMatter) {
  const Scene scene = parse_scene(R"(<?xml version="1.0"?>
<!-- a comment -->
<scene version="3.0.0">
  <integrator type="path"><integer name="max_depth" value="2"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <sampler type="multijitter"><integer name="sample_count" value="16"/></sampler>
    <film type="hdrfilm">
      <integer name="width" value="30"/><integer name="height" value="20"/>
      <string name="pixel_format" value="rgb"/>
      <rfilter type="gaussian"/>
    </film>
  </sensor>
  <shape type="sphere"/>
</scene>)",
                                  "test.xml");
  EXPECT_EQ(scene.sensor.width, 30);
  EXPECT_EQ(scene.sensor.height, 20);
}

TEST(Loader, SphereDefaultsAndParameters) {
  const Sphere unit = sphere("");
  expect_vector(unit.center, Vec3::Zero(), 0);
  EXPECT_EQ(unit.radius, 1);
  EXPECT_FALSE(unit.flip_normals);
  const Sphere given = sphere(
      "<point name='center' x='1' z='-3'/><float name='radius' value='2.5e-1'/>"
      "<boolean name='flip_normals' value='true'/>");
  expect_vector(given.center, Vec3(1, 0, -3), 0);
  EXPECT_EQ(given.radius, 0.25);
  EXPECT_TRUE(given.flip_normals);
}

TEST(Loader, SphereByTransform) {
  // Applied in order: (1, 0, 0) is doubled, turned to +y about z, and lifted.
  const Sphere moved = sphere(
      "<transform name='to_world'><scale value='2'/><rotate z='1' angle='90'/><translate z='5'/></transform>"
      "<point name='center' value='1 0 0'/><float name='radius' value='3'/>");
  expect_vector(moved.center, Vec3(0, 2, 5));
  EXPECT_DOUBLE_EQ(moved.radius, 6);
  EXPECT_FALSE(moved.flip_normals);
  EXPECT_TRUE(sphere("<transform name='to_world'><scale x='-1'/></transform>").flip_normals);  // mirrored: inside out
  EXPECT_FALSE(
      sphere("<transform name='to_world'><scale x='-1'/></transform><boolean name='flip_normals' value='true'/>")
          .flip_normals);
}

TEST(Loader, RectangleDefaultFacesPlusZ) {
  const auto plain = std::get<Flat>(shape("<shape type='rectangle'/>").shape);
  expect_vector(plain.center, Vec3::Zero(), 0);
  expect_vector(plain.half_u, Vec3::UnitX(), 0);
  expect_vector(plain.half_v, Vec3::UnitY(), 0);
  expect_vector(plain.normal, Vec3::UnitZ(), 0);
  const auto flipped =
      std::get<Flat>(shape("<shape type='rectangle'><boolean name='flip_normals' value='true'/></shape>").shape);
  expect_vector(flipped.half_u, Vec3::UnitX(), 0);
  expect_vector(flipped.normal, -Vec3::UnitZ(), 0);
}

TEST(Loader, RotatedRectangle) {
  // Laid flat as a floor: −90° about x takes +z to +y, exactly, for it is a whole quarter turn.
  const Flat floor = rectangle("<scale x='3' y='2'/><rotate x='1' angle='-90'/><translate y='-1'/>");
  expect_vector(floor.normal, Vec3::UnitY(), 0);
  expect_vector(floor.half_u, Vec3(3, 0, 0), 0);
  expect_vector(floor.half_v, Vec3(0, 0, -2), 0);
  expect_vector(floor.center, Vec3(0, -1, 0), 0);
  // 30° about y takes +z to (sin 30°, 0, cos 30°).
  expect_vector(rectangle("<rotate y='1' angle='30'/>").normal, Vec3(0.5, 0, std::sqrt(0.75)));
  // A third of a turn about the diagonal permutes the axes: x → y → z → x.
  const Flat turned = rectangle("<rotate value='0.577350269189626' angle='120'/>");
  expect_vector(turned.half_u, Vec3::UnitY());
  expect_vector(turned.half_v, Vec3::UnitZ());
  expect_vector(turned.normal, Vec3::UnitX());
}

TEST(Loader, MirroredRectangleKeepsItsFrontByTheInverseTranspose) {
  // Mirrored in x: the front stays at +z though u × v turns. Mirrored in z: the front goes along.
  expect_vector(rectangle("<scale x='-1'/>").normal, Vec3::UnitZ(), 0);
  expect_vector(rectangle("<scale z='-2'/>").normal, -Vec3::UnitZ(), 0);
  // A shear along the plane's own normal leaves the plane and its normal.
  expect_vector(rectangle("<matrix value='1 0 7 0  0 1 0 0  0 0 2 0  0 0 0 1'/>").normal, Vec3::UnitZ(), 0);
}

TEST(Loader, LookatAndMatrixInTransforms) {
  // As in Mitsuba: +z to the target, +x to up × forward.
  const Flat looking = rectangle("<lookat origin='1, 2, 3' target='5, 2, 3' up='0, 1, 0'/>");
  expect_vector(looking.center, Vec3(1, 2, 3), 0);
  expect_vector(looking.normal, Vec3::UnitX());
  expect_vector(looking.half_u, -Vec3::UnitZ());
  expect_vector(looking.half_v, Vec3::UnitY());
  const Flat nine = rectangle("<matrix value='0 0 1  1 0 0  0 1 0'/>");
  expect_vector(nine.half_u, Vec3::UnitY(), 0);
  expect_vector(nine.normal, Vec3::UnitX(), 0);
}

TEST(Loader, DiffuseInEveryNotation) {
  const auto reflectance = [](const std::string& value) {
    return bsdf("<bsdf type='diffuse'>" + value + "</bsdf>").reflectance;
  };
  EXPECT_TRUE((reflectance("") == Rgb(0.5, 0.5, 0.5)).all());
  EXPECT_TRUE((reflectance("<rgb name='reflectance' value='0.1, 0.2, 0.3'/>") == Rgb(0.1, 0.2, 0.3)).all());
  EXPECT_TRUE((reflectance("<rgb name='reflectance' value='0.1 0.2\n0.3'/>") == Rgb(0.1, 0.2, 0.3)).all());
  EXPECT_TRUE((reflectance("<rgb name='reflectance' value='0.25'/>") == Rgb(0.25, 0.25, 0.25)).all());
  EXPECT_TRUE((reflectance("<spectrum name='reflectance' value='1'/>") == Rgb(1, 1, 1)).all());
  EXPECT_TRUE((reflectance("<float name='reflectance' value='+.5'/>") == Rgb(0.5, 0.5, 0.5)).all());
}

TEST(Loader, ShapesWithoutBsdfAreGreyAndEmittersBlack) {
  EXPECT_TRUE((bsdf("").reflectance == 0.5).all());
  const Primitive lamp =
      shape("<shape type='sphere'><emitter type='area'><rgb name='radiance' value='1, 2, 3'/></emitter></shape>");
  EXPECT_TRUE(lamp.emits);
  EXPECT_TRUE((lamp.radiance == Rgb(1, 2, 3)).all());
  EXPECT_TRUE((lamp.bsdf.reflectance == 0).all());
  const Primitive both = shape(
      "<shape type='sphere'><bsdf type='diffuse'/><emitter type='area'><float name='radiance' "
      "value='4'/></emitter></shape>");
  EXPECT_TRUE((both.bsdf.reflectance == 0.5).all());
}

TEST(Loader, RoughConductor) {
  const std::string ggx = "<bsdf type='roughconductor'><string name='distribution' value='ggx'/>";
  const Bsdf plain = bsdf(ggx + "</bsdf>");  // Mitsuba's defaults: material none, alpha 0.1
  EXPECT_EQ(plain.kind, BsdfKind::kRoughConductor);
  EXPECT_TRUE(plain.unit_fresnel);
  EXPECT_EQ(plain.alpha, 0.1);
  EXPECT_TRUE((plain.reflectance == 1).all());
  const Bsdf gold =
      bsdf(ggx +
           "<rgb name='eta' value='0.14, 0.38, 1.44'/><rgb name='k' value='4, 2.4, 1.6'/>"
           "<float name='alpha_u' value='0.3'/><float name='alpha_v' value='0.3'/>"
           "<rgb name='specular_reflectance' value='0.9'/><boolean name='sample_visible' value='true'/></bsdf>");
  EXPECT_FALSE(gold.unit_fresnel);
  EXPECT_TRUE((gold.eta == Rgb(0.14, 0.38, 1.44)).all());
  EXPECT_TRUE((gold.k == Rgb(4, 2.4, 1.6)).all());
  EXPECT_EQ(gold.alpha, 0.3);
  EXPECT_TRUE((gold.reflectance == 0.9).all());
}

TEST(Loader, Disk) {
  const auto plain = std::get<Flat>(shape("<shape type='disk'/>").shape);  // Mitsuba's: radius 1, front towards +z
  EXPECT_EQ(plain.outline, Flat::Outline::kDisk);
  expect_vector(plain.half_u, Vec3::UnitX(), 0);
  expect_vector(plain.half_v, Vec3::UnitY(), 0);
  expect_vector(plain.normal, Vec3::UnitZ(), 0);
  EXPECT_EQ(std::get<Flat>(shape("<shape type='rectangle'/>").shape).outline, Flat::Outline::kRectangle);
  const auto ellipse = std::get<Flat>(
      shape("<shape type='disk'><transform name='to_world'><scale x='3' y='2'/><rotate x='1' angle='-90'/>"
            "<translate y='-1'/></transform><boolean name='flip_normals' value='true'/></shape>")
          .shape);
  expect_vector(ellipse.center, Vec3(0, -1, 0), 0);
  expect_vector(ellipse.half_u, Vec3(3, 0, 0), 0);
  expect_vector(ellipse.half_v, Vec3(0, 0, -2), 0);
  expect_vector(ellipse.normal, -Vec3::UnitY(), 0);
}

TEST(Loader, Phong) {
  const Bsdf plain = bsdf("<bsdf type='phong'/>");  // Mitsuba 0.6's defaults
  EXPECT_EQ(plain.kind, BsdfKind::kPhong);
  EXPECT_EQ(plain.exponent, 30);
  EXPECT_TRUE((plain.reflectance == 0.5).all());
  EXPECT_TRUE((plain.specular == 0.2).all());
  for (const auto& [diffuse, specular] : {std::pair("diffuse_reflectance", "specular_reflectance"),
                                          std::pair("diffuseReflectance", "specularReflectance")}) {
    const Bsdf given =
        bsdf(fmt::format("<bsdf type='phong'><rgb name='{}' value='0.3 0.2 0.1'/><spectrum name='{}' value='0.7'/>"
                         "<integer name='exponent' value='0'/></bsdf>",
                         diffuse, specular));
    EXPECT_TRUE((given.reflectance == Rgb(0.3, 0.2, 0.1)).all());
    EXPECT_TRUE((given.specular == 0.7).all());
    EXPECT_EQ(given.exponent, 0);
  }
}

TEST(Loader, ReferencesFindBsdfsBeforeAndAfter) {
  const Scene scene = load(
      "<shape type='sphere'><ref id='late'/></shape>"
      "<bsdf type='diffuse' id='late'><float name='reflectance' value='0.1'/></bsdf>"
      "<shape type='sphere'><bsdf type='diffuse' id='inner'><float name='reflectance' value='0.2'/></bsdf></shape>"
      "<shape type='sphere'><ref name='bsdf' id='inner'/></shape>");
  EXPECT_EQ(scene.primitives[0].bsdf.reflectance[0], 0.1);
  EXPECT_EQ(scene.primitives[2].bsdf.reflectance[0], 0.2);
}

TEST(Loader, DefaultsAreSubstitutedLongestNameFirst) {
  const Sphere given = sphere("<float name='radius' value='3'/>");
  EXPECT_EQ(given.radius, 3);
  const Scene scene = load(
      "<default name='r' value='3'/><default name='radius' value='0.5'/><default name='r' value='9'/>"
      "<shape type='sphere'><float name='radius' value='$radius'/><point name='center' value='$r $r 1$r'/></shape>");
  const auto& found = std::get<Sphere>(scene.primitives[0].shape);
  EXPECT_EQ(found.radius, 0.5);
  expect_vector(found.center, Vec3(3, 3, 13), 0);  // the first <default> of a name stands
}

TEST(Loader, PerspectiveCameraByLookat) {
  const Sensor camera = sensor(
      "<sensor type='perspective'><float name='fov' value='60'/><string name='fov_axis' value='larger'/>"
      "<transform name='to_world'><lookat origin='0 0 4' target='0 0 0' up='0 1 0'/></transform></sensor>");
  EXPECT_EQ(camera.kind, Sensor::Kind::kPerspective);
  EXPECT_EQ(camera.fov_axis, Sensor::FovAxis::kLarger);
  EXPECT_EQ(camera.width, 768);  // Mitsuba's film
  EXPECT_EQ(camera.height, 576);
  expect_vector(camera.forward, -Vec3::UnitZ(), 0);
  expect_vector(camera.left, -Vec3::UnitX(), 0);
  expect_vector(camera.up, Vec3::UnitY(), 0);
  // What stands at +x is on the right.
  EXPECT_GT(camera.ray(767, 288, 768, 576).direction.x(), 0);
}

TEST(Loader, Radiancemeter) {
  const Sensor plain = sensor("<sensor type='radiancemeter'/>");
  ASSERT_EQ(plain.rays.size(), 1u);
  expect_vector(plain.rays[0].origin, Vec3::Zero(), 0);
  expect_vector(plain.rays[0].direction, Vec3::UnitZ(), 0);
  const Sensor given = sensor(
      "<sensor type='radiancemeter'><point name='origin' x='1' y='2' z='3'/><vector name='direction' x='0' y='3' "
      "z='4'/>"
      "<film type='hdrfilm'><integer name='width' value='1'/><integer name='height' value='1'/></film></sensor>");
  EXPECT_EQ(given.kind, Sensor::Kind::kRays);
  EXPECT_EQ(given.width, 1);
  EXPECT_EQ(given.height, 1);
  expect_vector(given.rays[0].origin, Vec3(1, 2, 3), 0);
  expect_vector(given.rays[0].direction, Vec3(0, 0.6, 0.8));
  const Sensor moved = sensor(
      "<sensor type='radiancemeter'><transform name='to_world'><rotate y='1' angle='90'/><translate x='7'/></transform>"
      "</sensor>");
  expect_vector(moved.rays[0].origin, Vec3(7, 0, 0), 0);
  expect_vector(moved.rays[0].direction, Vec3::UnitX(), 0);
}

TEST(Loader, Mradiancemeter) {
  const Sensor meters = sensor(
      "<sensor type='mradiancemeter'><string name='origins' value='0, 0, 1, 2, 3, 4'/>"
      "<string name='directions' value='0, 0, -2, 1, 0, 0'/><film type='hdrfilm'><integer name='width' value='2'/>"
      "<integer name='height' value='1'/></film></sensor>");
  EXPECT_EQ(meters.width, 2);
  EXPECT_EQ(meters.height, 1);
  ASSERT_EQ(meters.rays.size(), 2u);
  expect_vector(meters.ray(0, 0, 2, 1).origin, Vec3(0, 0, 1), 0);
  expect_vector(meters.ray(0, 0, 2, 1).direction, -Vec3::UnitZ(), 0);
  expect_vector(meters.ray(1, 0, 2, 1).origin, Vec3(2, 3, 4), 0);
  expect_vector(meters.ray(1, 0, 2, 1).direction, Vec3::UnitX(), 0);
}

}  // namespace
}  // namespace halfslope
