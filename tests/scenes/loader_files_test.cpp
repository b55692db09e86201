// Scenes of several files: includes, references among them, parameters, meshes, images.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/exr.h"
#include "core/png.h"
#include "scenes/loader.h"
#include "tests/scenes/scene_folder.h"

namespace halfslope {
namespace {

constexpr const char* kTriangle = R"(ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property float u
property float v
element face 1
property list uchar int vertex_indices
end_header
0 0 0 0 0
1 0 0 1 0
0 1 0 0 1
3 0 1 2
)";

class LoaderFiles : public testing::Test {
 protected:
  /// A scene around `body`, in the folder.
  Scene load(const std::string& body, const SceneParameters& parameters = {}) {
    folder_.write("scene.xml", "<scene version='3.0.0'>\n<sensor type='radiancemeter'/>\n" + body + "\n</scene>");
    return load_scene(folder_ / "scene.xml", parameters);
  }
  std::string failure(const std::string& body) {
    try {
      load(body);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "no error";
  }
  /// "FOLDER/NAME", as messages have it.
  std::string place(const std::string& name) { return (folder_ / name).string(); }

  SceneFolder folder_;
};

TEST_F(LoaderFiles, AnIncludeStandsWhereItIs) {
  folder_.write("parts/walls.xml",
                "<scene version='3.0.0'><default name='albedo' value='0.25'/>"
                "<bsdf type='diffuse' id='white'><float name='reflectance' value='$albedo'/></bsdf>"
                "<include filename='more.xml'/></scene>");
  folder_.write("parts/more.xml", "<scene version='3.0.0'><shape type='sphere' id='inner'/></scene>");
  folder_.write("gold.xml", "<bsdf type='conductor' version='3.0.0'><string name='material' value='Au'/></bsdf>");
  const Scene scene = load(
      "<shape type='rectangle'><ref id='white'/></shape><include filename='parts/walls.xml'/>"
      "<shape type='disk'><include filename='gold.xml'/></shape>");
  ASSERT_EQ(scene.primitives.size(), 3u);
  EXPECT_EQ(scene.primitives[0].bsdf.reflectance[0], 0.25);
  EXPECT_EQ(scene.primitives[1].id, "inner");
  EXPECT_EQ(scene.primitives[2].bsdf.kind, BsdfKind::kConductor);
}

TEST_F(LoaderFiles, AnIncludedFileMayBeOlder) {
  folder_.write("old.xml",
                "<scene version='0.5.0'><shape type='sphere'><boolean name='flipNormals' value='true'/>"
                "</shape></scene>");
  const Scene scene = load("<include filename='old.xml'/><shape type='sphere'/>");
  EXPECT_TRUE(std::get<Sphere>(scene.primitives[0].shape).flip_normals);
}

TEST_F(LoaderFiles, ErrorsInAnIncludedFileNameIt) {
  folder_.write("walls.xml", "<scene version='3.0.0'>\n<shape type='cub'/></scene>");
  EXPECT_EQ(failure("<include filename='walls.xml'/>"),
            place("walls.xml") +
                ":2: unknown shape 'cub', allowed: sphere, rectangle, disk, cylinder, cube, obj, ply; did you mean "
                "'cube'?");
  folder_.write("walls.xml", "<scene version='3.0.0'>\n<bsdf type='diffuse' id='a'/></scene>");
  EXPECT_EQ(failure("<bsdf type='diffuse' id='a'/>\n<include filename='walls.xml'/>"),
            place("walls.xml") + ":2: the id 'a' is taken, by " + place("scene.xml") + ":3");
  EXPECT_EQ(failure("\n<include filename='wals.xml'/>"),
            place("scene.xml") + ":4: there is no file '" + place("wals.xml") + "'");
  EXPECT_EQ(failure("<include filename='.'/>"),
            place("scene.xml") + ":3: '" + place(".") + "' is a folder, allowed: a file");
}

TEST_F(LoaderFiles, AnIncludeOfItselfIsRefused) {
  EXPECT_EQ(failure("<include filename='scene.xml'/>"),
            place("scene.xml") + ":3: a cyclic <include>: scene.xml includes scene.xml");
  folder_.write("a.xml", "<scene version='3.0.0'>\n<include filename='../" +
                             (folder_ / "").parent_path().filename().string() + "/scene.xml'/></scene>");
  EXPECT_EQ(failure("<include filename='a.xml'/>"),
            place("a.xml") + ":2: a cyclic <include>: scene.xml includes a.xml includes scene.xml");
}

TEST_F(LoaderFiles, IncludesThatMultiplyAreBounded) {
  for (int level = 0; level < 12; ++level) {
    std::string twice;
    for (int i = 0; i < 10; ++i) twice += "<include filename='level" + std::to_string(level + 1) + ".xml'/>";
    folder_.write("level" + std::to_string(level) + ".xml", "<scene version='3.0.0'>" + twice + "</scene>");
  }
  folder_.write("level12.xml", "<scene version='3.0.0'/>");
  EXPECT_THAT(failure("<include filename='level0.xml'/>"), testing::HasSubstr("more than 1000 <include>s"));
  for (int level = 0; level < 40; ++level) {
    folder_.write("deep" + std::to_string(level) + ".xml",
                  "<scene version='3.0.0'><include filename='deep" + std::to_string(level + 1) + ".xml'/></scene>");
  }
  EXPECT_THAT(failure("<include filename='deep0.xml'/>"),
              testing::HasSubstr("deep14.xml:1: <include>s are nested more than 15 deep"));
}

TEST_F(LoaderFiles, ValuesFromOutsideReplaceDefaults) {
  const std::string body =
      "<default name='what' value='sphere'/><default name='size' value='2'/><shape type='$what' id='a'/>"
      "<shape type='sphere'><float name='radius' value='$size'/></shape>";
  EXPECT_TRUE(std::holds_alternative<Sphere>(load(body).primitives[0].shape));
  const Scene scene = load(body, {{"what", "disk"}, {"size", "5"}});
  EXPECT_TRUE(std::holds_alternative<Flat>(scene.primitives[0].shape));
  EXPECT_EQ(std::get<Sphere>(scene.primitives[1].shape).radius, 5);
  // Nor need a file that says $name give it.
  EXPECT_EQ(
      std::get<Sphere>(
          load("<shape type='sphere'><float name='radius' value='$r'/></shape>", {{"r", "7"}}).primitives[0].shape)
          .radius,
      7);
}

TEST_F(LoaderFiles, AliasesAreOtherNames) {
  const Scene scene = load(
      "<bsdf type='diffuse' id='a'><float name='reflectance' value='0.125'/></bsdf><alias id='a' as='b'/>"
      "<shape type='sphere'><ref id='b'/></shape>");
  EXPECT_EQ(scene.primitives[0].bsdf.reflectance[0], 0.125);
}

TEST_F(LoaderFiles, MeshesAreReadRelativeToTheFileAndToPaths) {
  folder_.write("meshes/triangle.ply", kTriangle);
  const std::string ply =
      "<shape type='ply'><string name='filename' value='{}'/>"
      "<transform name='to_world'><translate x='2'/></transform></shape>";
  for (const std::string& body : {fmt::format(fmt::runtime(ply), "meshes/triangle.ply"),
                                  fmt::format(fmt::runtime(ply), (folder_ / "meshes/triangle.ply").string()),
                                  "<path value='meshes'/>" + fmt::format(fmt::runtime(ply), "triangle.ply")}) {
    const Scene scene = load(body);
    const auto& mesh = *std::get<std::shared_ptr<const Mesh>>(scene.primitives.at(0).shape);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions.at(1), (Mesh::Point{3, 0, 0}));
    EXPECT_EQ(mesh.uvs.at(2), (std::array<float, 2>{0, 1}));
  }
  const Scene flipped = load(
      "<shape type='ply'><string name='filename' value='meshes/triangle.ply'/>"
      "<boolean name='flip_tex_coords' value='true'/><boolean name='face_normals' value='true'/></shape>");
  const auto& mesh = *std::get<std::shared_ptr<const Mesh>>(flipped.primitives.at(0).shape);
  EXPECT_EQ(mesh.uvs.at(2), (std::array<float, 2>{0, 0}));
  EXPECT_TRUE(mesh.normals.empty());
}

TEST_F(LoaderFiles, AMeshThatIsWrongIsToldWithTheShapesPlace) {
  folder_.write("broken.ply", "ply\nformat ascii 1.0\n");
  EXPECT_THAT(failure("\n<shape type='ply'><string name='filename' value='broken.ply'/></shape>"),
              testing::StartsWith(place("scene.xml") + ":4: " + place("broken.ply")));
  std::filesystem::create_directory(folder_ / "folder.ply");
  EXPECT_EQ(failure("<shape type='ply'><string name='filename' value='folder.ply'/></shape>"),
            place("scene.xml") + ":3: '" + place("folder.ply") + "' is a folder, allowed: a file");
  // A light without area, and a mesh that a scale takes its area.
  folder_.write("triangle.ply", kTriangle);
  EXPECT_THAT(failure("<shape type='ply'><string name='filename' value='triangle.ply'/>"
                      "<transform name='to_world'><scale x='0'/></transform>"
                      "<emitter type='area'><float name='radiance' value='1'/></emitter></shape>"),
              testing::StartsWith(place("scene.xml") + ":3: "));
}

TEST_F(LoaderFiles, PicturesAsTextures) {
  RgbImage image(2, 1);
  const std::array<std::uint8_t, 6> values = {255, 0, 128, 64, 32, 0};
  std::copy(values.begin(), values.end(), image.values.begin());
  folder_.write("picture.png", encode_png(image));
  const std::string bsdf =
      "<bsdf type='diffuse'><texture type='bitmap' name='reflectance'>"
      "<string name='filename' value='picture.png'/>{}</texture></bsdf>";
  const Scene scene =
      load("<shape type='rectangle'>" + fmt::format(fmt::runtime(bsdf), "") + "</shape><shape type='disk'>" +
           fmt::format(fmt::runtime(bsdf),
                       "<boolean name='raw' value='true'/>"
                       "<string name='filter_type' value='nearest'/>"
                       "<string name='wrap_mode' value='clamp'/>") +
           "</shape><shape type='sphere'>" + fmt::format(fmt::runtime(bsdf), "") + "</shape>");
  const Texture& texture = *scene.primitives[0].bsdf.reflectance_texture;
  EXPECT_EQ(texture.kind, Texture::Kind::kBitmap);
  EXPECT_EQ(texture.filter, Texture::Filter::kBilinear);
  EXPECT_EQ(texture.wrap, Texture::Wrap::kRepeat);
  EXPECT_FLOAT_EQ(texture.bitmap->rgb[0], 1);
  EXPECT_NEAR(texture.bitmap->rgb[2], 0.21586, 1e-5);  // sRGB 128
  EXPECT_NEAR(scene.primitives[0].bsdf.reflectance[0], (1 + 0.05127) / 2, 1e-5);
  const Texture& raw = *scene.primitives[1].bsdf.reflectance_texture;
  EXPECT_EQ(raw.filter, Texture::Filter::kNearest);
  EXPECT_EQ(raw.wrap, Texture::Wrap::kClamp);
  EXPECT_FLOAT_EQ(raw.bitmap->rgb[2], 128.0f / 255);
  EXPECT_NE(raw.bitmap, texture.bitmap);
  EXPECT_EQ(scene.primitives[2].bsdf.reflectance_texture->bitmap, texture.bitmap);  // read once
}

TEST_F(LoaderFiles, TheTopRowHasVZeroAsInMitsuba) {
  RgbImage image(1, 4);
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t c = 0; c < 3; ++c) image.values[3 * row + c] = static_cast<std::uint8_t>(60 * row);
  }
  folder_.write("rows.png", encode_png(image));
  const Scene scene = load(
      "<shape type='rectangle'><bsdf type='diffuse'><texture type='bitmap' name='reflectance'>"
      "<string name='filename' value='rows.png'/><boolean name='raw' value='true'/>"
      "<string name='filter_type' value='nearest'/></texture></bsdf></shape>");
  const Texture& texture = *scene.primitives[0].bsdf.reflectance_texture;
  for (int row = 0; row < 4; ++row) {
    EXPECT_NEAR(texture_value(texture, 0.5, (row + 0.5) / 4)[0], 60 * row / 255.0, 1e-6) << row;
  }
}

TEST_F(LoaderFiles, PicturesAsOpacityAreOneNumber) {
  RgbImage image(1, 1);
  image.values = {255, 0, 0};
  folder_.write("red.png", encode_png(image));
  const Scene scene = load(
      "<shape type='rectangle'><bsdf type='mask'><texture type='bitmap' name='opacity'>"
      "<string name='filename' value='red.png'/></texture><bsdf type='diffuse'/></bsdf></shape>");
  const Bsdf& bsdf = scene.primitives[0].bsdf;
  ASSERT_TRUE(bsdf.opacity_texture);
  EXPECT_NEAR(bsdf.opacity, 0.2127, 1e-4);  // the luminance of BT.709's red
  EXPECT_TRUE(is_grey(*bsdf.opacity_texture->bitmap));
}

TEST_F(LoaderFiles, AnEnvironmentIsAnExr) {
  write_exr(
      folder_ / "sky.exr",
      {2, 3, {{"B", std::vector<float>(6, 3)}, {"G", std::vector<float>(6, 2)}, {"R", std::vector<float>(6, 1)}}});
  const Scene scene = load(
      "<emitter type='envmap'><string name='filename' value='sky.exr'/><float name='scale' value='2'/>"
      "<boolean name='mis_compensation' value='true'/>"
      "<transform name='to_world'><rotate y='1' angle='90'/><scale value='3'/></transform></emitter>"
      "<shape type='sphere'/>");
  ASSERT_TRUE(scene.environment && scene.environment->map);
  EXPECT_EQ(scene.environment->map->width, 2);
  EXPECT_EQ(scene.environment->map->height, 3);
  EXPECT_THAT(std::vector<float>(scene.environment->map->rgb.begin(), scene.environment->map->rgb.begin() + 3),
              testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(scene.environment->scale, 2);
  EXPECT_TRUE(scene.environment->mis_compensation);
  // What the map holds along +z is seen along +x.
  EXPECT_LE((scene.environment->from_world * Vec3::UnitX() - Vec3::UnitZ()).norm(), 1e-15);

  write_exr(folder_ / "small.exr", {1, 1, {{"Y", {1}}}});
  EXPECT_EQ(
      failure("<emitter type='envmap'><string name='filename' value='small.exr'/></emitter>"),
      place("scene.xml") +
          ":3: 'filename' of emitter 'envmap' is an image of 1 x 1 pixels, allowed: 2 x 3 or more, as in Mitsuba");
}

TEST_F(LoaderFiles, CheckTellsEveryProblemOnce) {
  folder_.write("scene.xml",
                "<scene version='3.0.0'>\n<sensor type='perspektive'/>\n<bsdf type='difuse' id='a'/>\n"
                "<shape type='sphere'><ref id='a'/></shape>\n<shape type='sphere'><ref id='a'/></shape>\n</scene>");
  const SceneCheck check = check_scene(folder_ / "scene.xml");
  EXPECT_FALSE(check.scene);
  EXPECT_THAT(check.problems, testing::ElementsAre(testing::HasSubstr(":2: unknown sensor 'perspektive'"),
                                                   testing::HasSubstr(":3: unknown bsdf 'difuse'")));
}

TEST_F(LoaderFiles, CheckTellsWhatNobodyReads) {
  folder_.write("scene.xml",
                "<scene version='0.6.0'><integrator type='volpath'/><sensor type='perspective'>"
                "<float name='nearClip' value='1'/><sampler type='independent'/></sensor><shape type='cube'/></scene>");
  const SceneCheck check = check_scene(folder_ / "scene.xml");
  ASSERT_TRUE(check.scene) << check.problems.front();
  EXPECT_TRUE(check.upgraded);
  EXPECT_EQ(check.version, "0.6.0");
  EXPECT_THAT(check.ignored, testing::ElementsAre(testing::Pair("<sampler>", 1),
                                                  testing::Pair("near_clip of sensor 'perspective'", 1)));
}

}  // namespace
}  // namespace halfslope
