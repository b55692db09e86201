#include "scenes/upgrade.h"

#include <gtest/gtest.h>

#include "scenes/loader.h"

namespace halfslope {
namespace {

TEST(Upgrade, NamesBecomeSnakeCase) {
  EXPECT_EQ(snake_case("toWorld"), "to_world");
  EXPECT_EQ(snake_case("intIOR"), "int_ior");
  EXPECT_EQ(snake_case("maxDepth"), "max_depth");
  EXPECT_EQ(snake_case("specularReflectance"), "specular_reflectance");
  EXPECT_EQ(snake_case("wrapModeU"), "wrap_mode_u");
  EXPECT_EQ(snake_case("alpha"), "alpha");
  EXPECT_EQ(snake_case("radius2X"), "radius2X");  // Mitsuba splits between two letters only
  EXPECT_EQ(snake_case(""), "");
}

/// A scene in the spelling of Mitsuba 0.6 and what it is in that of 3.
TEST(Upgrade, AnOldSceneIsRead) {
  const Scene scene = parse_scene(R"(<?xml version="1.0" encoding="utf-8"?>
<scene version="0.6.0">
  <integrator type="path"><integer name="maxDepth" value="8"/><integer name="rrDepth" value="3"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="35"/>
    <string name="fovAxis" value="smaller"/>
    <transform name="toWorld"><lookAt origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sampleCount" value="64"/></sampler>
    <film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="30"/>
      <string name="pixelFormat" value="rgb"/><boolean name="banner" value="false"/>
      <rfilter type="tent"/></film>
  </sensor>
  <bsdf type="diffuse" id="_floor">
    <rgb name="diffuseReflectance" value="0.1, 0.2, 0.3"/>
  </bsdf>
  <bsdf type="diffuse" id="checked">
    <texture name="reflectance" type="checkerboard">
      <float name="uoffset" value="0.25"/><float name="uscale" value="8"/><float name="vscale" value="4"/>
    </texture>
  </bsdf>
  <shape type="rectangle"><ref id="_floor"/></shape>
  <shape type="disk"><ref id="checked"/></shape>
  <shape type="sphere">
    <boolean name="flipNormals" value="true"/>
    <bsdf type="dielectric"><float name="intIOR" value="1.5"/><string name="extIOR" value="air"/></bsdf>
  </shape>
</scene>)",
                                  "old.xml");
  EXPECT_EQ(scene.max_depth, 8);
  EXPECT_EQ(scene.rr_depth, 3);
  EXPECT_EQ(scene.sensor.fov_axis, Sensor::FovAxis::kSmaller);
  EXPECT_EQ(scene.sensor.origin, Vec3(0, 0, 4));
  EXPECT_EQ(scene.sensor.filter.kind, ReconstructionFilter::Kind::kTent);
  EXPECT_TRUE((scene.primitives[0].bsdf.reflectance == Rgb(0.1, 0.2, 0.3)).all());
  // Mitsuba's upgrade translates first and scales then.
  ASSERT_TRUE(scene.primitives[1].bsdf.reflectance_texture);
  const Eigen::Vector2d uv = scene.primitives[1].bsdf.reflectance_texture->to_uv * Eigen::Vector3d(0.5, 0.5, 1);
  EXPECT_EQ(uv, Eigen::Vector2d(8 * 0.75, 4 * 0.5));
  EXPECT_TRUE(std::get<Sphere>(scene.primitives[2].shape).flip_normals);
  EXPECT_DOUBLE_EQ(scene.primitives[2].bsdf.ior, 1.5 / 1.000277);
}

TEST(Upgrade, NewerScenesKeepTheirSpelling) {
  for (const char* version : {"2.0.0", "3.6.1"}) {
    EXPECT_ANY_THROW(parse_scene(fmt::format("<scene version='{}'><sensor type='radiancemeter'/><shape type='sphere'>"
                                             "<boolean name='flipNormals' value='true'/></shape></scene>",
                                             version),
                                 "new.xml"));
  }
}

}  // namespace
}  // namespace halfslope
