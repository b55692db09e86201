// Every way to be wrong: exit code 3, the file and line, what was found and what is allowed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/scenes/wrong_scenes.h"

namespace halfslope {
namespace {

class LoaderErrors : public testing::TestWithParam<Wrong> {};

TEST_P(LoaderErrors, SayWhereWhatAndWhatIsAllowed) { EXPECT_EQ(failure(GetParam().text), GetParam().message); }

const std::vector<Wrong> kFile = {
    {"Malformed", "<scene version='3.0.0'>\n  <shape type='sphere'>\n</scene>",
     "wrong.xml:3:3: malformed XML: Start-end tags mismatch"},
    {"Empty", "", "wrong.xml:1:1: malformed XML: No document element found"},
    {"TwoRoots", "<scene version='3.0.0'/>\n<scene/>", "wrong.xml:2: a second root element <scene>, allowed: one"},
    {"OtherRoot", "<scen version='3.0.0'/>",
     "wrong.xml:1: unknown root element 'scen', allowed: scene; did you mean 'scene'?"},
    {"NoVersion", "<scene/>", "wrong.xml:1: <scene> has no attribute 'version'"},
    {"NewVersion", "<scene version='4.0.0'/>",
     "wrong.xml:1: the scene's version is '4.0.0', allowed: 0.x.x to 3.x.x, as Mitsuba's"},
    {"NoSensor", "\n<scene version='3.0.0'><shape type='sphere'/></scene>",
     "wrong.xml:2: the scene has no <sensor>, allowed: one"},
    {"NoShape", "<scene version='3.0.0'><sensor type='radiancemeter'/></scene>",
     "wrong.xml:1: the scene has no <shape>, allowed: one or more"},
    {"TwoSensors", scene("<sensor type='radiancemeter'/>"), "wrong.xml:3: a second <sensor>, allowed: one"},
    {"Text", scene("hello\nyou"), "wrong.xml:3: unexpected text 'hello' in <scene>, allowed: elements"},
    {"Element", scene("<shap type='sphere'/>"),
     "wrong.xml:3: unknown element in <scene> 'shap', allowed: default, include, path, alias, integrator, sensor, "
     "texture, bsdf, emitter, shape; did you mean 'shape'?"},
    {"TopLevelArea", scene("<emitter type='area'/>"),
     "wrong.xml:3: emitter 'area' outside of a shape, allowed: inside the shape that emits"},
    {"SameId", scene("<bsdf type='diffuse' id='a'/><bsdf type='diffuse' id='a'/>"),
     "wrong.xml:3: the id 'a' is taken, by wrong.xml:3"},
    {"Parameter", scene("<default name='width' value='2'/><bsdf type='diffuse' id='$widht'/>"),
     "wrong.xml:3: unknown parameter '$widht', allowed: $width; did you mean '$width'?"},
};
INSTANTIATE_TEST_SUITE_P(File, LoaderErrors, testing::ValuesIn(kFile), name_of);

const std::vector<Wrong> kShape = {
    {"Type", scene("<shape type='spere'/>"),
     "wrong.xml:3: unknown shape 'spere', allowed: sphere, rectangle, disk, cylinder, cube, obj, ply; did you mean "
     "'sphere'?"},
    {"NearDisk", scene("<shape type='disc'/>"),
     "wrong.xml:3: unknown shape 'disc', allowed: sphere, rectangle, disk, cylinder, cube, obj, ply; did you mean "
     "'disk'?"},
    {"ShearedDisk",
     scene("<shape type='disk'>\n<transform name='to_world'><matrix value='1 1 0  0 1 0  0 0 1'/></transform></shape>"),
     "wrong.xml:4: 'to_world' of shape 'disk' is a shear, allowed: transforms that keep the disk's axes perpendicular"},
    {"FlatDisk", scene("<shape type='disk'><transform name='to_world'>\n<scale x='0'/></transform></shape>"),
     "wrong.xml:3: 'to_world' of shape 'disk' is degenerate, allowed: a matrix with a finite inverse, which leaves the "
     "disk its area"},
    {"DiskRadius", scene("<shape type='disk'><float name='radius' value='2'/></shape>"),
     "wrong.xml:3: unknown property of shape 'disk' 'radius', allowed: to_world, flip_normals"},
    {"NoType", scene("<shape/>"), "wrong.xml:3: <shape> has no attribute 'type'"},
    {"Attribute", scene("<shape type='sphere' ID='a'/>"),
     "wrong.xml:3: unknown attribute of <shape> 'ID', allowed: type, id, name"},
    {"AttributeTwice", scene("<shape type='sphere' type='sphere'/>"), "wrong.xml:3: attribute 'type' stands twice"},
    {"Property", sphere("\n<float name='radios' value='1'/>"),
     "wrong.xml:4: unknown property of shape 'sphere' 'radios', allowed: to_world, center, radius, flip_normals; did "
     "you "
     "mean 'radius'?"},
    {"PropertyTwice", sphere("<float name='radius' value='1'/>\n<float name='radius' value='1'/>"),
     "wrong.xml:4: 'radius' is given a second time"},
    {"PropertyType", sphere("<string name='radius' value='1'/>"),
     "wrong.xml:3: 'radius' of shape 'sphere' is given as string, allowed: as float, integer"},
    {"Child", sphere("<medium type='homogeneous'/>"),
     "wrong.xml:3: unknown element in <shape> 'medium', allowed: bsdf, ref, emitter, float, integer, boolean, string, "
     "point, vector, rgb, spectrum, transform"},
    {"NotANumber", sphere("<float name='radius' value='1x'/>"),
     "wrong.xml:3: attribute 'value' of <float> is '1x', allowed: 1 finite number"},
    {"NaN", sphere("<float name='radius' value='nan'/>"),
     "wrong.xml:3: attribute 'value' of <float> is 'nan', allowed: 1 finite number"},
    {"Huge", sphere("<float name='radius' value='1e999'/>"),
     "wrong.xml:3: attribute 'value' of <float> is '1e999', allowed: 1 finite number"},
    {"ZeroRadius", sphere("<float name='radius' value='0'/>"),
     "wrong.xml:3: 'radius' of shape 'sphere' is 0, allowed: above 0"},
    {"Boolean", sphere("<boolean name='flip_normals' value='yes'/>"),
     "wrong.xml:3: 'flip_normals' of shape 'sphere' is 'yes', allowed: true, false"},
    {"Ellipsoid", sphere("<transform name='to_world'><scale x='2'/></transform>"),
     "wrong.xml:3: 'to_world' of shape 'sphere' is not a uniform scale, allowed: rotations, translations and one scale "
     "for all axes"},
    {"Shear", rectangle("<matrix value='1 0.1 0  0 1 0  0 0 1'/>"),
     "wrong.xml:3: 'to_world' of shape 'rectangle' is a shear, allowed: transforms that keep the rectangle's sides "
     "perpendicular"},
    {"Flat", rectangle("<scale y='0'/>"),
     "wrong.xml:3: 'to_world' of shape 'rectangle' is degenerate, allowed: a matrix with a finite inverse, which "
     "leaves "
     "the rectangle its area"},
    {"Overflow", rectangle("<scale value='1e200'/><scale value='1e200'/>"),
     "wrong.xml:3: 'to_world' of shape 'rectangle' is degenerate, allowed: a matrix with a finite inverse, which "
     "leaves "
     "the rectangle its area"},
    {"Step", rectangle("<rotat x='1' angle='3'/>"),
     "wrong.xml:3: unknown element in <transform> 'rotat', allowed: translate, scale, rotate, lookat, matrix; did you "
     "mean 'rotate'?"},
    {"Axis", rectangle("<rotate x='1' y='1' angle='3'/>"),
     "wrong.xml:3: the axis of <rotate> is (1, 1, 0), allowed: a vector of unit length"},
    {"Angle", rectangle("<rotate x='1'/>"), "wrong.xml:3: <rotate> has no attribute 'angle'"},
    {"Matrix", rectangle("<matrix value='1 2 3'/>"),
     "wrong.xml:3: <matrix> is '1 2 3', allowed: 16 finite numbers, or 9, row by row"},
    {"Projective", rectangle("<matrix value='1 0 0 0  0 1 0 0  0 0 1 0  0 0 1 1'/>"),
     "wrong.xml:3: the last row of <matrix> must be 0 0 0 1"},
    {"Lookat", rectangle("<lookat origin='0 0 0' target='0 3 0' up='0 1 0'/>"),
     "wrong.xml:3: <lookat> has no direction, allowed: a target apart from the origin, and an up not parallel to the "
     "view"},
    {"ValueAndX", rectangle("<translate x='1' value='2'/>"),
     "wrong.xml:3: <translate> has both 'value' and 'x', allowed: one or the other"},
    {"Emitter", sphere("<emitter type='aera'/>"),
     "wrong.xml:3: unknown emitter 'aera', allowed: area; did you mean 'area'?"},
    {"TwoEmitters", sphere("<emitter type='area'/>\n<emitter type='area'/>"),
     "wrong.xml:4: a second <emitter> in <shape>, allowed: one"},
    {"NoRadiance", emitter(""),
     "wrong.xml:3: 'radiance' of emitter 'area' is absent, allowed: <rgb>, <spectrum>, <float>"},
    {"NegativeRadiance", emitter("<rgb name='radiance' value='1 -2 3'/>"),
     "wrong.xml:3: 'radiance' of emitter 'area' is (1, -2, 3), allowed: 0 or more in each channel"},
    {"InfiniteRadiance", emitter("<rgb name='radiance' value='inf'/>"),
     "wrong.xml:3: attribute 'value' of <rgb> is 'inf', allowed: one finite number or three"},
    {"Reference", scene("<bsdf type='diffuse' id='white'/>\n<shape type='sphere'><ref id='whit'/></shape>"),
     "wrong.xml:4: unknown bsdf id 'whit', allowed: white; did you mean 'white'?"},
    {"ReferenceAndBsdf", sphere("<bsdf type='diffuse' id='a'/><ref id='a'/>"),
     "wrong.xml:3: a <ref> beside a <bsdf> in one shape, allowed: one or the other"},
};
INSTANTIATE_TEST_SUITE_P(Shape, LoaderErrors, testing::ValuesIn(kShape), name_of);

const std::vector<Wrong> kBsdf = {
    {"Type", bsdf("difuse", ""),
     "wrong.xml:3: unknown bsdf 'difuse', allowed: diffuse, conductor, roughconductor, plastic, roughplastic, "
     "dielectric, "
     "roughdielectric, phong, twosided, mask; did you mean 'diffuse'?"},
    {"Reflectance", bsdf("diffuse", "<rgb name='reflectance' value='0 0 1.5'/>"),
     "wrong.xml:3: 'reflectance' of bsdf 'diffuse' is (0, 0, 1.5), allowed: from 0 to 1 in each channel"},
    {"Texture", bsdf("diffuse", "<texture type='bitmap' name='reflectance'/>"),
     "wrong.xml:3: 'filename' of texture 'bitmap' is absent, allowed: the name of an image"},
    {"TwoChannels", bsdf("diffuse", "<rgb name='reflectance' value='0.1 0.2'/>"),
     "wrong.xml:3: attribute 'value' of <rgb> is '0.1 0.2', allowed: one finite number or three"},
    {"Hex", bsdf("diffuse", "<rgb name='reflectance' value='#ff8000'/>"),
     "wrong.xml:3: 'reflectance' of bsdf 'diffuse' is '#ff8000', an sRGB code, which is not linear, allowed: linear "
     "numbers \"r, g, b\", or one number"},
    {"Spectrum", bsdf("diffuse", "<spectrum name='reflectance' value='400:0.1, 700:0.2'/>"),
     "wrong.xml:3: 'reflectance' of bsdf 'diffuse' is '400:0.1, 700:0.2', allowed: one number, the same at every "
     "wavelength"},
    {"SpectrumFile", bsdf("diffuse", "<spectrum name='reflectance' filename='a.spd'/>"),
     "wrong.xml:3: unknown attribute of <spectrum> 'filename', allowed: name, value"},
    {"Distribution", bsdf("roughconductor", "<string name='distribution' value='phong'/>"),
     "wrong.xml:3: 'distribution' of bsdf 'roughconductor' is 'phong', allowed: ggx, beckmann"},
    {"Material", ggx("<string name='material' value='Av'/>"),
     "wrong.xml:3: 'material' of bsdf 'roughconductor' is 'Av', allowed: none, a-C, Ag, Al, Au, Be, Cr, CsI, Cu, Cu2O, "
     "CuO, d-C, Hg, HgTe, Ir, K, Li, MgO, Mo, Na_palik, Nb, Ni_palik, Rh, Se, SnTe, Ta, Te, ThF4, TiC, TiN, VC, VN, V, "
     "W, or eta and k instead of a material"},
    {"MaterialAndEta", ggx("<string name='material' value='none'/><float name='eta' value='1'/>"),
     "wrong.xml:3: 'material' of bsdf 'roughconductor' is given beside eta or k, allowed: one or the other"},
    {"EtaAlone", ggx("<float name='eta' value='1'/>"),
     "wrong.xml:3: 'eta' of bsdf 'roughconductor' is alone, allowed: both eta and k"},
    {"NegativeEta", ggx("<float name='eta' value='-1'/><float name='k' value='3'/>"),
     "wrong.xml:3: 'eta' of bsdf 'roughconductor' is negative, or zero where k is zero, allowed: eta >= 0 and k >= 0, "
     "not "
     "both 0"},
    {"AlphaZero", ggx("<float name='alpha' value='0'/>"),
     "wrong.xml:3: 'alpha' of bsdf 'roughconductor' is 0, allowed: above 0, up to 1"},
    {"AlphaAboveOne", ggx("<float name='alpha' value='1.01'/>"),
     "wrong.xml:3: 'alpha' of bsdf 'roughconductor' is 1.01, allowed: above 0, up to 1"},
    {"AlphaV", ggx("<float name='alpha_u' value='0.1'/><float name='alpha_v' value='2'/>"),
     "wrong.xml:3: 'alpha_v' of bsdf 'roughconductor' is 2, allowed: above 0, up to 1"},
    {"TexturedAlpha", ggx("\n<texture type='checkerboard' name='alpha'/>"),
     "wrong.xml:4: 'alpha' of bsdf 'roughconductor' is given as texture, allowed: as float, integer"},
    {"AlphaUAlone", ggx("<float name='alpha_u' value='0.1'/>"),
     "wrong.xml:3: 'alpha_u' of bsdf 'roughconductor' is alone, allowed: both alpha_u and alpha_v"},
    {"NotVisible", ggx("<boolean name='sample_visible' value='false'/>"),
     "wrong.xml:3: 'sample_visible' of bsdf 'roughconductor' is false, allowed: true"},
    {"Property", ggx("<float name='alhpa' value='0.1'/>"),
     "wrong.xml:3: unknown property of bsdf 'roughconductor' 'alhpa', allowed: distribution, sample_visible, "
     "specular_reflectance, material, eta, k, alpha, alpha_u, alpha_v; did you mean 'alpha'?"},
    {"NearPhong", bsdf("pong", ""),
     "wrong.xml:3: unknown bsdf 'pong', allowed: diffuse, conductor, roughconductor, plastic, roughplastic, "
     "dielectric, "
     "roughdielectric, phong, twosided, mask; did you mean 'phong'?"},
    {"Exponent", bsdf("phong", "\n<float name='exponent' value='-1'/>"),
     "wrong.xml:4: 'exponent' of bsdf 'phong' is -1, allowed: 0 or more"},
    {"InfiniteExponent", bsdf("phong", "\n<float name='exponent' value='inf'/>"),
     "wrong.xml:4: attribute 'value' of <float> is 'inf', allowed: 1 finite number"},
    {"BothSpellings",
     bsdf("phong", "<float name='specular_reflectance' value='0.1'/>\n<float name='specularReflectance' value='0.1'/>"),
     "wrong.xml:4: 'specularReflectance' of bsdf 'phong' is given beside specular_reflectance, allowed: one or the "
     "other"},
    {"NegativeSpecular", bsdf("phong", "<rgb name='specularReflectance' value='0 -0.1 0'/>"),
     "wrong.xml:3: 'specularReflectance' of bsdf 'phong' is (0, -0.1, 0), allowed: from 0 to 1 in each channel"},
    {"TooMuchDiffuse", bsdf("phong", "<rgb name='diffuse_reflectance' value='1.5'/>"),
     "wrong.xml:3: 'diffuse_reflectance' of bsdf 'phong' is (1.5, 1.5, 1.5), allowed: from 0 to 1 in each channel"},
    {"TooMuchInAll",
     bsdf("phong",
          "<float name='diffuseReflectance' value='0.5'/>\n<rgb name='specularReflectance' value='0.1 0.75 0'/>"),
     "wrong.xml:4: 'specularReflectance' of bsdf 'phong' is (0.1, 0.75, 0), which with diffuseReflectance (0.5, 0.5, "
     "0.5) sums to 1.25, allowed: a sum up to 1 in each channel: divide both by 1.25"},
    {"PhongProperty", bsdf("phong", "<float name='exponet' value='3'/>"),
     "wrong.xml:3: unknown property of bsdf 'phong' 'exponet', allowed: diffuse_reflectance, diffuseReflectance, "
     "specular_reflectance, specularReflectance, exponent; did you mean 'exponent'?"},
};
INSTANTIATE_TEST_SUITE_P(Bsdf, LoaderErrors, testing::ValuesIn(kBsdf), name_of);

const std::vector<Wrong> kSensor = {
    {"Type", meter("thinlense", ""),
     "wrong.xml:3: unknown sensor 'thinlense', allowed: perspective, thinlens, orthographic, radiancemeter, "
     "mradiancemeter; did you mean 'thinlens'?"},
    {"Fov", meter("perspective", "<float name='fov' value='180'/>"),
     "wrong.xml:3: 'fov' of sensor 'perspective' is 180, allowed: degrees, above 0 and below 180"},
    {"Axis", camera("<string name='fov_axis' value='z'/>"),
     "wrong.xml:3: 'fov_axis' of sensor 'perspective' is 'z', allowed: x, y, diagonal, smaller, larger"},
    {"Scale", camera("<transform name='to_world'><scale value='2'/></transform>"),
     "wrong.xml:3: 'to_world' of sensor 'perspective' is a transform that scales or shears, allowed: rotations, "
     "translations and lookat"},
    {"Property", camera("<float name='principal_point_offset_x' value='1'/>"),
     "wrong.xml:3: unknown property of sensor 'perspective' 'principal_point_offset_x', allowed: to_world, fov, "
     "fov_axis, focal_length, near_clip, far_clip, focus_distance, shutter_open, shutter_close"},
    {"Film", camera("<film type='ldrfilm'/>"),
     "wrong.xml:3: unknown film 'ldrfilm', allowed: hdrfilm; did you mean 'hdrfilm'?"},
    {"Width", camera("<film type='hdrfilm'><integer name='width' value='0'/></film>"),
     "wrong.xml:3: 'width' of film 'hdrfilm' is 0, allowed: 1 to 65536"},
    {"WidthFraction", camera("<film type='hdrfilm'><integer name='width' value='1.5'/></film>"),
     "wrong.xml:3: 'width' of film 'hdrfilm' is 1.5, allowed: a whole number"},
    {"Crop", camera("<film type='hdrfilm'><integer name='crop_width' value='1'/></film>"),
     "wrong.xml:3: unknown property of film 'hdrfilm' 'crop_width', allowed: width, height, file_format, pixel_format, "
     "component_format, banner, sample_border, compensate"},
    {"Direction", meter("radiancemeter", "<point name='origin' value='0'/>"),
     "wrong.xml:3: 'origin' of sensor 'radiancemeter' is alone, allowed: both origin and direction"},
    {"ZeroDirection", meter("radiancemeter", "<point name='origin' value='0'/><vector name='direction' value='0'/>"),
     "wrong.xml:3: 'direction' of sensor 'radiancemeter' is a direction of length 0, allowed: directions of any other "
     "length"},
    {"BigFilm", meter("radiancemeter", "<film type='hdrfilm'/>"),
     "wrong.xml:3: the film is 768 x 576, allowed: 1 x 1, a pixel for each ray"},
    {"NoOrigins", meter("mradiancemeter", ""),
     "wrong.xml:3: 'origins' of sensor 'mradiancemeter' is absent, allowed: x, y, z of each ray, finite numbers"},
    {"Triples", meter("mradiancemeter", "<string name='origins' value='1 2 3 4'/>"),
     "wrong.xml:3: 'origins' of sensor 'mradiancemeter' is '1 2 3 4', allowed: x, y, z of each ray, finite numbers"},
    {"Counts",
     meter("mradiancemeter", "<string name='origins' value='1 2 3'/><string name='directions' value='1 2 3 4 5 6'/>"),
     "wrong.xml:3: 'directions' of sensor 'mradiancemeter' is 2 of them, allowed: as many as origins, 1"},
};
INSTANTIATE_TEST_SUITE_P(Sensor, LoaderErrors, testing::ValuesIn(kSensor), name_of);

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(LoaderErrors, DeepNestingIsRefusedWithoutExhaustingTheStack) {
  const int depth = 200'000;
  const std::string deep = repeated("<integrator>", depth) + repeated("</integrator>", depth);
  EXPECT_EQ(failure("<scene version='3.0.0'>\n" + deep + "</scene>"),
            "wrong.xml:2: elements are nested more than 64 deep");
}

TEST(LoaderErrors, LargeFilesLoad) {
  const int count = 20'000;
  const std::string many = repeated("<shape type='sphere'/>\n", count);
  const auto loaded = parse_scene(scene(many), "many.xml");
  EXPECT_EQ(loaded.primitives.size(), static_cast<std::size_t>(count) + 1);
}

TEST(LoaderErrors, EveryPrefixOfASceneIsAnError) {
  const std::string whole = sphere("<float name='radius' value='1'/>");
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_THAT(failure(whole.substr(0, length)), testing::StartsWith("wrong.xml:")) << length;
  }
}

}  // namespace
}  // namespace halfslope
