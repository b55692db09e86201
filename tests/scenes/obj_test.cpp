// OBJ files: positions, normals and texture coordinates come together, and what the library would take for 0 is an
// error with its line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <string>

#include "core/error.h"
#include "scenes/mesh_readers.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;

using Triangle = std::array<std::uint32_t, 3>;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, APolygonIsAFan) {
  const Mesh mesh = parse_obj(kSquare + "f 1 2 3 4\n", "a.obj");
  EXPECT_THAT(mesh.positions,
              ElementsAre(Mesh::Point{0, 0, 0}, Mesh::Point{1, 0, 0}, Mesh::Point{1, 1, 0}, Mesh::Point{0, 1, 0}));
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Obj, NegativeIndicesCountBackwards) {
  const Mesh mesh = parse_obj(kSquare + "f -4 -3 -2\nv 5 5 5\nf -1 -2 -3", "a.obj");
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 4, 2}));
  EXPECT_EQ(mesh.positions[3], (Mesh::Point{5, 5, 5}));
  EXPECT_EQ(mesh.positions[4], (Mesh::Point{0, 1, 0}));
}

TEST(Obj, CornersThatDifferInAnythingArePositionsOfTheirOwn) {
  const Mesh mesh = parse_obj(kSquare +
                                  "vt 0.25 0.5\nvt 1 1 0\nvn 0 0 1\nvn 0 1 0\n"
                                  "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/2 4/2/1\n",
                              "a.obj");
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 3, 4}));
  EXPECT_EQ(mesh.positions[2], mesh.positions[3]);
  EXPECT_EQ(mesh.normals[2], (Mesh::Point{0, 0, 1}));
  EXPECT_EQ(mesh.normals[3], (Mesh::Point{0, 1, 0}));
  // v is turned over.
  EXPECT_EQ(mesh.uvs[0], (std::array<float, 2>{0.25F, 0.5F}));
  EXPECT_EQ(mesh.uvs[4], (std::array<float, 2>{1, 0}));
}

TEST(Obj, NormalsWithoutTextureCoordinatesAndOtherWayRound) {
  const Mesh normals = parse_obj(kSquare + "vn 0 0 1\nf 1//1 2//1 3//-1\n", "a.obj");
  EXPECT_EQ(normals.normals.size(), 3U);
  EXPECT_TRUE(normals.uvs.empty());
  const Mesh uvs = parse_obj(kSquare + "vt 0 0\nvn 0 0 1\nf 1/1 2/1 3/1\n", "a.obj");
  EXPECT_EQ(uvs.uvs.size(), 3U);
  EXPECT_TRUE(uvs.normals.empty());
}

TEST(Obj, NumbersInEverySpelling) {
  const Mesh mesh = parse_obj("v 1. -.5 +2.5e-1\nv 1E2 -1e+1 0007 1 \nv\t1e-30 -0 3 0.5 0.5 0.5\nf 1 2 3", "a.obj");
  EXPECT_EQ(mesh.positions[0], (Mesh::Point{1, -0.5F, 0.25F}));
  EXPECT_EQ(mesh.positions[1], (Mesh::Point{100, -10, 7}));
  EXPECT_FLOAT_EQ(mesh.positions[2][0], 1e-30F);
}

TEST(Obj, OtherLinesDoNotMatter) {
  const std::string text =
      "# a comment: f 9 9 9\nmtllib none.mtl\no thing\ng\ns off\nt 9999/9999/9999\nusemtl\n\xff\xfe\n" + kSquare +
      "g a b\nl 1 2\np 1\ncurv 0 1 f\nf 1 2 3\nusemtl x";
  EXPECT_EQ(parse_obj(text, "a.obj").triangles.size(), 1U);
}

TEST(Obj, LineEndsOfEverySystem) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char* line : {"v 0 0 0", "v 1 0 0", "", "v 1 1 0", "f 1 2 3", "f 1 2 4"}) text += line + end;
    try {
      parse_obj(text, "a.obj");
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "a.obj:6: position 4 in 'f', allowed: 1 to 3 or -1 to -3, those before it");
    }
  }
}

struct Wrong {
  const char* name;
  std::string text;
  std::string message;
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }
std::string name_of(const testing::TestParamInfo<Wrong>& info) { return info.param.name; }

class ObjErrors : public testing::TestWithParam<Wrong> {};

TEST_P(ObjErrors, SayWhereWhatAndWhatIsAllowed) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    parse_obj(GetParam().text, "a.obj");
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_EQ(error.what(), GetParam().message);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

const std::string kCorners = "', allowed: indices as i, i/j, i//k or i/j/k, from 1 up or from -1 down";

const std::vector<Wrong> kWrong = {
    {"Word", "v 0 0 zero\n", "a.obj:1: 'zero' in 'v', allowed: numbers"},
    {"NaN", "v 0 0 0\nv nan 0 0\n", "a.obj:2: 'nan' in 'v', allowed: numbers"},
    {"Infinity", "vn 0 inf 0\n", "a.obj:1: 'inf' in 'vn', allowed: numbers"},
    {"Dot", "v . 0 0\n", "a.obj:1: '.' in 'v', allowed: numbers"},
    {"Sign", "v - 0 0\n", "a.obj:1: '-' in 'v', allowed: numbers"},
    {"Huge", "v 1e39 0 0\n", "a.obj:1: a number in 'v' leaves binary32, allowed: up to 3.4e38"},
    {"HugeUv", "vt 1e39 0\n", "a.obj:1: a number in 'vt' leaves binary32, allowed: up to 3.4e38"},
    {"ManyDigits", "v " + std::string(400, '9') + " 0 0\n",
     "a.obj:1: a number in 'v' leaves binary32, allowed: up to 3.4e38"},
    {"HugeExponent", "v 1e2147483647 0 0\n", "a.obj:1: '1e2147483647' in 'v', allowed: numbers"},
    {"NoExponent", "v 1e 0 0\n", "a.obj:1: '1e' in 'v', allowed: numbers"},
    {"TwoNumbers", "v 0 0\n", "a.obj:1: 2 numbers in 'v', allowed: 3 or more"},
    {"OneUv", "vt 0\n", "a.obj:1: 1 numbers in 'vt', allowed: 2 or more"},
    {"Zero", kSquare + "f 0 1 2\n", "a.obj:5: '0' in 'f" + kCorners},
    {"ZeroUv", kSquare + "f 1/0 1 2\n", "a.obj:5: '1/0' in 'f" + kCorners},
    {"HugeIndex", kSquare + "f 1 2 4294967297\n", "a.obj:5: '4294967297' in 'f" + kCorners},
    {"Fraction", kSquare + "f 1 2 2.5\n", "a.obj:5: '2.5' in 'f" + kCorners},
    {"FourParts", kSquare + "f 1 2 3/1/1/1\n", "a.obj:5: '3/1/1/1' in 'f" + kCorners},
    {"NoIndex", kSquare + "f 1 2 /1\n", "a.obj:5: '/1' in 'f" + kCorners},
    {"Nul", kSquare + std::string("f 1 2 3\0 4\n", 11), "a.obj:5: '3?' in 'f" + kCorners},
    {"Continued", kSquare + "f 1 2 \\\n3\n", "a.obj:5: '\\' in 'f" + kCorners},
    {"TwoCorners", kSquare + "f 1 2\n", "a.obj:5: 2 corners in 'f', allowed: 3 or more"},
    {"OutOfRange", kSquare + "f 1 2 5\n", "a.obj:5: position 5 in 'f', allowed: 1 to 4 or -1 to -4, those before it"},
    {"BeforeTheFirst", kSquare + "f 1 2 -5\n",
     "a.obj:5: position -5 in 'f', allowed: 1 to 4 or -1 to -4, those before it"},
    {"NoNormal", kSquare + "f 1//1 2//1 3//1\n", "a.obj:5: normal 1 in 'f', but none comes before it"},
    {"NoUv", kSquare + "vt 0 0\nf 1/1 2/1 3/2\n",
     "a.obj:6: texture coordinate 2 in 'f', allowed: 1 to 1 or -1 to -1, those before it"},
};
INSTANTIATE_TEST_SUITE_P(Lines, ObjErrors, testing::ValuesIn(kWrong), name_of);

TEST(Obj, OnePositionWithManyNormalsIsReadInLinearTime) {
  std::string text = kSquare;
  for (int i = 1; i <= 100000; ++i) {
    text += "vn 0 0 " + std::to_string(i) + "\nf 1//" + std::to_string(i) + " 2//1 3//1\n";
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(parse_obj(text, "a.obj").positions.size(), 100002U);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));  // a minute if it were quadratic
}

}  // namespace
}  // namespace halfslope
