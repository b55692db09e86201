// The same for surfaces that transmit, layers, textures, and lights without a surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/scenes/wrong_scenes.h"

namespace halfslope {
namespace {

class LoaderErrorsMore : public testing::TestWithParam<Wrong> {};

TEST_P(LoaderErrorsMore, SayWhereWhatAndWhatIsAllowed) { EXPECT_EQ(failure(GetParam().text), GetParam().message); }

std::string light(const std::string& type, const std::string& inside) {
  return scene("<emitter type='" + type + "'>" + inside + "</emitter>");
}
std::string texture(const std::string& type, const std::string& inside) {
  return scene("<texture type='" + type + "'>" + inside + "</texture>");
}
std::string transform(const std::string& steps) { return "<transform name='to_world'>" + steps + "</transform>"; }

const std::vector<Wrong> kBsdf = {
    {"ThinDielectric", bsdf("thindielectric", ""),
     "wrong.xml:3: unknown bsdf 'thindielectric', allowed: diffuse, conductor, roughconductor, plastic, roughplastic, "
     "dielectric, roughdielectric, phong, twosided, mask; did you mean 'dielectric'?"},
    {"IorName", bsdf("dielectric", "<string name='int_ior' value='watr'/>"),
     "wrong.xml:3: 'int_ior' of bsdf 'dielectric' is 'watr', allowed: a number above 0, vacuum, helium, hydrogen, air, "
     "carbon dioxide, water, acetone, ethanol, carbon tetrachloride, glycerol, benzene, silicone oil, bromine, water "
     "ice, fused quartz, pyrex, acrylic glass, polypropylene, bk7, sodium chloride, amber, pet, diamond; did you mean "
     "'water'?"},
    {"IorZero", bsdf("plastic", "<float name='int_ior' value='0'/>"),
     "wrong.xml:3: 'int_ior' of bsdf 'plastic' is 0, allowed: above 0, or a name"},
    {"NoInterface", bsdf("roughdielectric", "<float name='int_ior' value='1.5'/><float name='ext_ior' value='1.5'/>"),
     "wrong.xml:3: 'int_ior' of bsdf 'roughdielectric' is 1.5, and so is ext_ior, allowed: two that differ"},
    {"CoatOfSmallerIor", bsdf("roughplastic", "<float name='int_ior' value='1'/><float name='ext_ior' value='1.25'/>"),
     "wrong.xml:3: 'int_ior' of bsdf 'roughplastic' is 0.8 of ext_ior, allowed: the larger of the two"},
    {"Transmittance", bsdf("dielectric", "<float name='specular_transmittance' value='2'/>"),
     "wrong.xml:3: 'specular_transmittance' of bsdf 'dielectric' is (2, 2, 2), allowed: from 0 to 1 in each channel"},
    {"RoughOfSmooth", bsdf("plastic", "<float name='alpha' value='0.1'/>"),
     "wrong.xml:3: unknown property of bsdf 'plastic' 'alpha', allowed: diffuse_reflectance, specular_reflectance, "
     "int_ior, ext_ior, nonlinear"},
    {"EmptyTwoSided", bsdf("twosided", ""), "wrong.xml:3: 0 bsdfs inside bsdf 'twosided', allowed: 1 or 2"},
    {"ThreeSided", bsdf("twosided", "<bsdf type='diffuse'/><bsdf type='diffuse'/><bsdf type='diffuse'/>"),
     "wrong.xml:3: 3 bsdfs inside bsdf 'twosided', allowed: 1 or 2"},
    {"TwoSidedGlass", bsdf("twosided", "<bsdf type='dielectric'/>"),
     "wrong.xml:3: bsdf 'dielectric' inside bsdf 'twosided', allowed: any but twosided, mask, dielectric, "
     "roughdielectric"},
    {"HoldsItself", scene("<bsdf type='twosided' id='a'><ref id='a'/></bsdf>"),
     "wrong.xml:3: bsdf 'twosided' inside bsdf 'twosided', allowed: any but twosided, mask, dielectric, "
     "roughdielectric"},
    {"MaskOfMask", scene("<bsdf type='mask' id='a'><ref id='a'/></bsdf>"),
     "wrong.xml:3: bsdf 'mask' inside bsdf 'mask', allowed: any but mask"},
    {"HoldEachOther",
     scene("<bsdf type='mask' id='a'><ref id='b'/></bsdf>\n<bsdf type='twosided' id='b'><ref id='a'/></bsdf>"),
     "wrong.xml:4: bsdf 'mask' inside bsdf 'twosided', allowed: any but twosided, mask, dielectric, roughdielectric"},
    {"Opacity", bsdf("mask", "<bsdf type='diffuse'/>\n<float name='opacity' value='-1'/>"),
     "wrong.xml:4: 'opacity' of bsdf 'mask' is (-1, -1, -1), allowed: from 0 to 1 in each channel"},
    {"TextureId", bsdf("diffuse", "<ref name='reflectance' id='tex'/>"),
     "wrong.xml:3: unknown texture id 'tex', allowed: none"},
    {"NamelessTexture", bsdf("diffuse", "<texture type='checkerboard'/>"),
     "wrong.xml:3: <texture> has no attribute 'name'"},
    {"TextureTwice",
     bsdf("diffuse",
          "<float name='reflectance' value='1'/>\n"
          "<texture name='reflectance' type='checkerboard'/>"),
     "wrong.xml:4: 'reflectance' is given a second time"},
    {"UnknownTextureName", bsdf("diffuse", "<texture name='albedo' type='checkerboard'/>"),
     "wrong.xml:3: unknown property of bsdf 'diffuse' 'albedo', allowed: reflectance"},
    {"CheckAboveOne",
     bsdf("diffuse",
          "<texture name='reflectance' type='checkerboard'>"
          "<float name='color0' value='1.5'/><float name='color1' value='0'/></texture>"),
     "wrong.xml:3: 'reflectance' of bsdf 'diffuse' is (1.5, 1.5, 1.5), allowed: from 0 to 1 in each channel"},
    {"PhongChecks",
     bsdf("phong",
          "<texture name='diffuse_reflectance' type='checkerboard'>"
          "<float name='color0' value='0.1'/><float name='color1' value='0.9'/></texture>"),
     "wrong.xml:3: 'specular_reflectance' of bsdf 'phong' is (0.2, 0.2, 0.2), which with diffuse_reflectance (0.9, "
     "0.9, 0.9) sums to 1.1, allowed: a sum up to 1 in each channel: divide both by 1.1"},
};
INSTANTIATE_TEST_SUITE_P(Bsdf, LoaderErrorsMore, testing::ValuesIn(kBsdf), name_of);

const std::vector<Wrong> kTexture = {
    {"Type", texture("bitmop", ""),
     "wrong.xml:3: unknown texture 'bitmop', allowed: bitmap, checkerboard; did you mean 'bitmap'?"},
    {"NoFile", texture("bitmap", "<string name='filename' value='none.png'/>"),
     "wrong.xml:3: there is no file 'none.png'"},
    {"Filter", texture("bitmap", "<string name='filter_type' value='trilinear'/>"),
     "wrong.xml:3: 'filter_type' of texture 'bitmap' is 'trilinear', allowed: bilinear, nearest; did you mean "
     "'bilinear'?"},
    {"Wrap", texture("bitmap", "<string name='wrap_mode' value='zero'/>"),
     "wrong.xml:3: 'wrap_mode' of texture 'bitmap' is 'zero', allowed: clamp, mirror, repeat"},
    {"OldScale", texture("checkerboard", "<float name='uscale' value='2'/>"),
     "wrong.xml:3: unknown property of texture 'checkerboard' 'uscale', allowed: to_uv, color0, color1"},
};
INSTANTIATE_TEST_SUITE_P(Texture, LoaderErrorsMore, testing::ValuesIn(kTexture), name_of);

const std::vector<Wrong> kLight = {
    {"Type", light("sunsky", ""),
     "wrong.xml:3: unknown emitter in <scene> 'sunsky', allowed: point, directional, spot, constant, envmap"},
    {"TwoPlaces", light("point", "<point name='position' value='1'/>\n" + transform("<translate x='1'/>")),
     "wrong.xml:4: 'to_world' of emitter 'point' is given beside position, allowed: one or the other"},
    {"Negative", light("point", "<rgb name='intensity' value='1 1 -1'/>"),
     "wrong.xml:3: 'intensity' of emitter 'point' is (1, 1, -1), allowed: 0 or more in each channel"},
    {"NoDirection", light("directional", "<vector name='direction' value='0'/>"),
     "wrong.xml:3: 'direction' of emitter 'directional' is a direction of length 0, allowed: directions of any other "
     "length"},
    {"Cutoff", light("spot", "<float name='cutoff_angle' value='120'/>"),
     "wrong.xml:3: 'cutoff_angle' of emitter 'spot' is 120, allowed: degrees, above 0, up to 90"},
    {"Beam", light("spot", "<float name='beam_width' value='30'/>"),
     "wrong.xml:3: 'beam_width' of emitter 'spot' is 30, allowed: above 0, up to cutoff_angle, 20"},
    {"SpotTexture", light("spot", "<texture name='texture' type='checkerboard'/>"),
     "wrong.xml:3: unknown element in <emitter> 'texture', allowed: float, integer, boolean, string, point, vector, "
     "rgb, spectrum, transform"},
    {"TwoSkies", scene("<emitter type='constant'/>\n<emitter type='constant'/>"),
     "wrong.xml:4: a second light from all around, allowed: one constant or envmap"},
    {"ShearedSky", light("envmap", transform("<scale x='2'/>")),
     "wrong.xml:3: 'to_world' of emitter 'envmap' is no rotation, allowed: rotations, translations and one scale for "
     "all axes"},
    {"EmitterId", scene("<shape type='sphere'><ref id='lamp'/></shape>"),
     "wrong.xml:3: unknown bsdf id 'lamp', allowed: none"},
};
INSTANTIATE_TEST_SUITE_P(Light, LoaderErrorsMore, testing::ValuesIn(kLight), name_of);

const std::vector<Wrong> kOther = {
    {"FlatCylinder", scene("<shape type='cylinder'>" + transform("<scale x='2'/>") + "</shape>"),
     "wrong.xml:3: 'to_world' of shape 'cylinder' is one that leaves no circular cylinder, allowed: rotations, "
     "translations, and scales that are equal across its axis"},
    {"LeaningCylinder",
     scene("<shape type='cylinder'>" + transform("<matrix value='1 0 1  0 1 0  0 0 1'/>") + "</shape>"),
     "wrong.xml:3: 'to_world' of shape 'cylinder' is one that leaves no circular cylinder, allowed: rotations, "
     "translations, and scales that are equal across its axis"},
    {"ShortCylinder", scene("<shape type='cylinder'><point name='p1' value='0'/></shape>"),
     "wrong.xml:3: 'p1' of shape 'cylinder' is equal to p0, allowed: two points apart from each other"},
    {"NoMeshName", scene("<shape type='ply'/>"),
     "wrong.xml:3: 'filename' of shape 'ply' is absent, allowed: the name of a mesh"},
    {"MissingMesh", scene("<shape type='ply'><string name='filename' value='a.ply'/></shape>"),
     "wrong.xml:3: there is no file 'a.ply'"},
    {"OtherMesh", scene("<shape type='ply'><string name='filename' value='a.obj'/></shape>"),
     "wrong.xml:3: 'filename' of shape 'ply' is 'a.obj', allowed: a file whose name ends in .ply"},
    {"FolderAsMesh", scene("<shape type='ply'><string name='filename' value='/'/></shape>"),
     "wrong.xml:3: 'filename' of shape 'ply' is '/', allowed: a file whose name ends in .ply"},
    {"NoLens", meter("thinlens", ""),
     "wrong.xml:3: 'aperture_radius' of sensor 'thinlens' is absent, allowed: above 0"},
    {"FovAndLength", camera("<string name='focal_length' value='50mm'/>"),
     "wrong.xml:3: 'focal_length' of sensor 'perspective' is given beside fov, allowed: one or the other"},
    {"FocalLength", meter("perspective", "<string name='focal_length' value='50cm'/>"),
     "wrong.xml:3: 'focal_length' of sensor 'perspective' is '50cm', allowed: millimetres above 0, such as 50mm"},
    {"ShearedOrthographic", meter("orthographic", transform("<matrix value='1 1 0  0 1 0  0 0 1'/>")),
     "wrong.xml:3: 'to_world' of sensor 'orthographic' is a transform that shears or leaves no image, allowed: "
     "rotations, translations, lookat and scales before them"},
    {"Filter", camera("<film type='hdrfilm'><rfilter type='lanczos'/></film>"),
     "wrong.xml:3: unknown rfilter 'lanczos', allowed: box, tent, gaussian"},
    {"FilterSize",
     camera("<film type='hdrfilm'><rfilter type='gaussian'><float name='stddev' value='0'/></rfilter>"
            "</film>"),
     "wrong.xml:3: 'stddev' of rfilter 'gaussian' is 0, allowed: above 0, up to 100 pixels"},
    {"Depth", scene("<integrator type='path'><integer name='max_depth' value='-2'/></integrator>"),
     "wrong.xml:3: 'max_depth' of integrator 'path' is -2, allowed: a whole number from 1, or -1 for no bound"},
    {"NoDepth", scene("<integrator type='volpath'><integer name='max_depth' value='0'/></integrator>"),
     "wrong.xml:3: 'max_depth' of integrator 'volpath' is 0, allowed: a whole number from 1, or -1 for no bound"},
    {"TwoIntegrators", scene("<integrator type='path'/><integrator type='direct'/>"),
     "wrong.xml:3: a second <integrator>, allowed: one"},
    {"RouletteDepth", scene("<integrator type='path'><integer name='rr_depth' value='0'/></integrator>"),
     "wrong.xml:3: 'rr_depth' of integrator 'path' is 0, allowed: a whole number from 1"},
    {"Alias", scene("<bsdf type='diffuse' id='a'/>\n<alias id='b' as='c'/>"),
     "wrong.xml:4: unknown id 'b', allowed: a"},
    {"AliasTaken", scene("<bsdf type='diffuse' id='a'/>\n<alias id='a' as='a'/>"),
     "wrong.xml:4: the id 'a' is taken, by wrong.xml:3"},
    {"Folder", scene("<path value='nowhere'/>"),
     "wrong.xml:3: there is no folder 'nowhere', allowed: one that is there, as seen from this file or the scene's"},
};
INSTANTIATE_TEST_SUITE_P(Other, LoaderErrorsMore, testing::ValuesIn(kOther), name_of);

std::string with_parameters(const SceneParameters& parameters) {
  const std::string text = scene(
      "<default name='width' value='2'/><default name='idle' value='2'/>"
      "<shape type='sphere'><float name='radius' value='$width'/></shape>");
  try {
    parse_scene(text, "wrong.xml", parameters);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "no error";
}

TEST(LoaderErrorsMore, ParametersThatTheSceneDoesNotUse) {
  EXPECT_EQ(with_parameters({{"width", "3"}}), "no error");
  EXPECT_EQ(with_parameters({{"widht", "3"}}),
            "wrong.xml:1: unknown parameter 'widht', allowed: idle, width; did you mean 'width'?");
  EXPECT_EQ(with_parameters({{"idle", "3"}}), "wrong.xml:1: the parameter 'idle' is used nowhere in the scene");
  EXPECT_EQ(with_parameters({{"width", "x"}}),
            "wrong.xml:3: attribute 'value' of <float> is 'x', allowed: 1 finite number");
}

}  // namespace
}  // namespace halfslope
