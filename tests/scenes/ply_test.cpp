// PLY files: the three formats say the same thing, what is not understood is skipped, and what is wrong is said with
// its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/error.h"
#include "scenes/mesh_readers.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A binary file's values, in either byte order.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}
  template <class T>
  Bytes& add(T value) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (big_endian_) std::reverse(bytes.begin(), bytes.end());
    text_ += bytes;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  bool big_endian_;
  std::string text_;
};

std::string header(const std::string& format, const std::string& vertex, const std::string& face) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\n" + vertex + face + "end_header\n";
}
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kFace = "property list uchar int vertex_indices\n";
std::string ascii(const std::string& vertices, const std::string& faces, int vertex_count = 4, int face_count = 1) {
  return header("ascii", "element vertex " + std::to_string(vertex_count) + "\n" + kXyz,
                "element face " + std::to_string(face_count) + "\n" + kFace) +
         vertices + faces;
}
const std::string kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Ply, APolygonIsAFan) {
  const Mesh mesh = parse_ply(ascii(kSquare, "4 0 1 2 3\n"), "a.ply");
  EXPECT_THAT(mesh.positions,
              ElementsAre(Mesh::Point{0, 0, 0}, Mesh::Point{1, 0, 0}, Mesh::Point{1, 1, 0}, Mesh::Point{0, 1, 0}));
  EXPECT_THAT(mesh.triangles,
              ElementsAre(std::array<std::uint32_t, 3>{0, 1, 2}, std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Ply, OtherElementsPropertiesAndLineEndsDoNotMatter) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement camera 2\r\nproperty float fov\r\nproperty list uint8 double "
      "k\r\n"
      "element face 1\r\nproperty uchar material\r\nproperty list uchar uint vertex_index\r\nproperty list uchar int "
      "more\r\n"
      "element nothing 7\r\n"
      "element vertex 3\r\nproperty float32 z\r\nproperty uint8 red\r\nproperty float64 x\r\nproperty list int8 char "
      "tags\r\n"
      "property int16 y\r\nelement edge 1\r\nproperty int vertex1\r\nend_header\r\n"
      "45 3 1 2 3\r\n46 0\r\n9 3 2 1 0 2 7 7\r\n"
      "1.5 255 2e-1 2 -1 -1 3\r\n  2.5 0 .25 0 4\r\n\r\n3.5 1 +0.5 0 5\r\n12";
  const Mesh mesh = parse_ply(text, "a.ply");
  EXPECT_THAT(mesh.positions,
              ElementsAre(Mesh::Point{0.2F, 3, 1.5F}, Mesh::Point{0.25F, 4, 2.5F}, Mesh::Point{0.5F, 5, 3.5F}));
  EXPECT_THAT(mesh.triangles, ElementsAre(std::array<std::uint32_t, 3>{2, 1, 0}));
}

class PlyFormats : public testing::TestWithParam<bool> {};

TEST_P(PlyFormats, EveryTypeOfBothByteOrders) {
  Bytes data(GetParam());
  for (int i = 0; i < 3; ++i) {
    data.add(static_cast<std::int8_t>(-i)).add(static_cast<std::uint8_t>(200 + i));
    data.add(static_cast<std::int16_t>(-300 * i)).add(static_cast<std::uint16_t>(60000 + i));
    data.add(std::int32_t{-70000 * i}).add(static_cast<std::uint32_t>(4000000000 + i));
    data.add(0.5F + static_cast<float>(i)).add(0.1 * i);
  }
  data.add(std::uint16_t{3}).add(std::int16_t{0}).add(std::int16_t{1}).add(std::int16_t{2});
  const std::string text =
      header(GetParam() ? "binary_big_endian" : "binary_little_endian",
             "element vertex 3\nproperty char x\nproperty uchar y\nproperty short nx\nproperty ushort ny\n"
             "property int nz\nproperty uint u\nproperty float v\nproperty double z\n",
             "element face 1\nproperty list ushort short vertex_indices\n") +
      data.text();
  const Mesh mesh = parse_ply(text, "a.ply");
  ASSERT_EQ(mesh.positions.size(), 3U);
  EXPECT_EQ(mesh.positions[2], (Mesh::Point{-2, 202, 0.2F}));
  EXPECT_EQ(mesh.normals[2], (Mesh::Point{-600, 60002, -140000}));
  EXPECT_EQ(mesh.uvs[2], (std::array<float, 2>{4000000002.0F, 2.5F}));
  EXPECT_THAT(mesh.triangles, ElementsAre(std::array<std::uint32_t, 3>{0, 1, 2}));
}
INSTANTIATE_TEST_SUITE_P(Both, PlyFormats, testing::Bool());

TEST(Ply, TextureCoordinatesHaveThreeNames) {
  for (const auto& [u, v] : {std::pair("u", "v"), std::pair("s", "t"), std::pair("texture_u", "texture_v")}) {
    const std::string text =
        header("ascii",
               "element vertex 3\nproperty float " + std::string(v) + "\n" + kXyz + "property float " + u + "\n",
               "element face 1\n" + kFace) +
        "0.25 0 0 0 0.5\n1 1 0 0 1\n1 0 1 0 1\n3 0 1 2\n";
    EXPECT_EQ(parse_ply(text, "a.ply").uvs[0], (std::array<float, 2>{0.5F, 0.25F})) << u;
  }
}

struct Wrong {
  const char* name;
  std::string text;
  std::string message;
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }
std::string name_of(const testing::TestParamInfo<Wrong>& info) { return info.param.name; }

class PlyErrors : public testing::TestWithParam<Wrong> {};

TEST_P(PlyErrors, SayWhereWhatAndWhatIsAllowed) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    parse_ply(GetParam().text, "a.ply");
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_EQ(error.what(), GetParam().message);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

std::string binary(const std::string& vertex, const std::string& face, const std::string& data) {
  return header("binary_little_endian", "element vertex " + vertex + "\n" + kXyz,
                "element face " + face + "\n" + kFace) +
         data;
}
/// The header of binary("1", …) is this long.
const std::size_t kHeader = binary("1", "1", "").size();
std::string byte(std::size_t n) { return "a.ply, byte " + std::to_string(n) + ": "; }

const std::vector<Wrong> kHeaders = {
    {"Empty", "", "a.ply:1: the first line is '', allowed: ply"},
    {"Garbage", "\x7f\x45LF\1", "a.ply:1: the first line is '?ELF?', allowed: ply"},
    {"NoEnd", "ply\nformat ascii 1.0\nelement vertex 3\n",
     "a.ply:3: the file ends in its header, allowed: 'end_header' first"},
    {"NoFormat", "ply\nend_header\n", "a.ply:2: the header has no 'format', allowed: one"},
    {"Format", "ply\nformat binary 1.0\n",
     "a.ply:2: format 'binary', allowed: ascii, binary_little_endian, binary_big_endian"},
    {"Version", "ply\nformat ascii 2.0\n", "a.ply:2: 'format ascii 2.0', allowed: format NAME 1.0"},
    {"TwoFormats", "ply\nformat ascii 1.0\nformat ascii 1.0\n", "a.ply:3: a second 'format', allowed: one"},
    {"Word", "ply\nformat ascii 1.0\nelements 3\n",
     "a.ply:3: 'elements 3' in the header, allowed: format, comment, obj_info, element, property, end_header"},
    {"NegativeCount", "ply\nformat ascii 1.0\nelement vertex -3\n",
     "a.ply:3: 'element vertex -3', allowed: element NAME COUNT"},
    {"HugeCount", "ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n",
     "a.ply:3: 'element vertex 99999999999999999999', allowed: element NAME COUNT"},
    {"Property", "ply\nformat ascii 1.0\nproperty float x\n",
     "a.ply:3: a property before any element, allowed: after one"},
    {"Type", "ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\n",
     "a.ply:4: type 'half', allowed: char, uchar, short, ushort, int, uint, float, double, int8 … float64"},
    {"ListOfFloatLength", "ply\nformat ascii 1.0\nelement face 3\nproperty list float int vertex_indices\n",
     "a.ply:4: a list's length is 'float', allowed: integer types"},
    {"TwiceX", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float x\n",
     "a.ply:5: a second property 'x' of 'vertex', allowed: one"},
    {"NoVertices", "ply\nformat ascii 1.0\nelement face 1\n" + kFace + "end_header\n3 0 1 2\n",
     "a.ply: no element 'vertex', allowed: one"},
    {"NoFaces", "ply\nformat ascii 1.0\nelement vertex 1\n" + kXyz + "end_header\n0 0 0\n",
     "a.ply: no element 'face', allowed: one"},
    {"TwoVertexElements", header("ascii", "element vertex 0\nelement vertex 0\n", "element face 0\n"),
     "a.ply: a second element 'vertex', allowed: one"},
    {"NoZ", header("ascii", "element vertex 1\nproperty float x\nproperty float y\n", "element face 1\n" + kFace),
     "a.ply: 'vertex' has no x, y and z, allowed: all three"},
    {"ListX",
     header("ascii", "element vertex 1\nproperty list int float x\nproperty float y\nproperty float z\n",
            "element face 1\n" + kFace),
     "a.ply: property 'x' of 'vertex' is a list, allowed: a number"},
    {"NoCorners", header("ascii", "element vertex 1\n" + kXyz, "element face 1\nproperty int a\n"),
     "a.ply: 'face' has no list vertex_indices or vertex_index, allowed: one"},
    {"FloatCorners",
     header("ascii", "element vertex 1\n" + kXyz, "element face 1\nproperty list int float vertex_index\n"),
     "a.ply: property 'vertex_index' of 'face' is no list of integers"},
};
INSTANTIATE_TEST_SUITE_P(Headers, PlyErrors, testing::ValuesIn(kHeaders), name_of);

const std::vector<Wrong> kData = {
    {"FourGigabytes", binary("4294967295", "1", "abc"),
     byte(kHeader + 9) + "an element claims 4294967295 items of 12 bytes or more, but the file has 3 left"},
    {"BeyondIndices", binary("18446744073709551615", "1", "abc"),
     "a.ply: 18446744073709551615 vertices, allowed: up to 4294967295"},
    {"ManyFaces", binary("0", "4000000000", "abc"),
     byte(kHeader + 9) + "an element claims 4000000000 items of 1 bytes or more, but the file has 3 left"},
    {"LongList",
     header("binary_little_endian", "element vertex 0\n" + kXyz,
            "element face 1\nproperty list uint int vertex_indices\n") +
         std::string(8, '\xff'),
     byte(kHeader + 3) + "a list claims 4294967295 values of 4 bytes or more, but the file has 4 left"},
    {"NegativeList",
     header("binary_little_endian", "element vertex 0\n" + kXyz,
            "element face 1\nproperty list char int vertex_indices\n") +
         std::string(8, '\xff'),
     byte(kHeader) + "a list of -1 values, allowed: 0 or more"},
    {"Truncated", binary("1", "1", std::string(12, '\0') + '\3' + std::string(7, '\0')),
     byte(kHeader + 13) + "a list claims 3 values of 4 bytes or more, but the file has 7 left"},
    {"Trailing", binary("0", "0", "abc"), byte(kHeader) + "3 bytes after the last element, allowed: none"},
    {"BinaryIndex", binary("1", "1", std::string(12, '\0') + '\3' + std::string(8, '\0') + std::string("\1\0\0\0", 4)),
     byte(kHeader + 25) + "index 1 in face 0, allowed: 0 to 0"},
    {"BinaryNaN", binary("1", "0", std::string("\0\0\xc0\x7f", 4) + std::string(8, '\0')),
     byte(kHeader + 4) + "'x' of vertex 0 is nan, allowed: what binary32 holds"},
    {"AsciiNaN", ascii("0 0 0\n1 0 0\n1 nan 0\n0 1 0\n", "4 0 1 2 3\n"),
     "a.ply:13: 'y' of vertex 2 is nan, allowed: what binary32 holds"},
    {"AsciiInfinity", ascii("0 0 0\n1 0 0\n1 -inf 0\n0 1 0\n", "4 0 1 2 3\n"),
     "a.ply:13: 'y' of vertex 2 is -inf, allowed: what binary32 holds"},
    {"BeyondBinary32", ascii("0 0 0\n1 0 0\n1 1 1e39\n0 1 0\n", "4 0 1 2 3\n"),
     "a.ply:13: 'z' of vertex 2 is 1e+39, allowed: what binary32 holds"},
    {"Word", ascii("0 0 0\n1 0 0\n1 one 0\n0 1 0\n", "4 0 1 2 3\n"), "a.ply:13: 'one', allowed: a number"},
    {"Fraction", ascii(kSquare, "4 0 1 2.5 3\n"), "a.ply:15: '2.5', allowed: an integer"},
    {"Index", ascii(kSquare, "4 0 1 2 4\n"), "a.ply:15: index 4 in face 0, allowed: 0 to 3"},
    {"NegativeIndex", ascii(kSquare, "4 0 1 2 -1\n"), "a.ply:15: index -1 in face 0, allowed: 0 to 3"},
    {"TwoCorners", ascii(kSquare, "2 0 1\n"), "a.ply:15: face 0 has 2 corners, allowed: 3 or more"},
    {"AsciiClaim", ascii("0 0 0\n", "", 1000000000),
     "a.ply:11: an element claims 1000000000 items of 6 bytes or more, but the file has 6 left"},
    {"AsciiLongList", ascii(kSquare, "1000000000 0 1 2\n"),
     "a.ply:15: a list claims 1000000000 values of 2 bytes or more, but the file has 7 left"},
    {"AsciiTruncated", ascii("0 0 0\n1 0 0\n1 1 0\n0 1      ", ""), "a.ply:14: the file ends where a number should be"},
    {"AsciiTrailing", ascii(kSquare, "4 0 1 2 3\nmore"), "a.ply:16: 4 bytes after the last element, allowed: none"},
};
INSTANTIATE_TEST_SUITE_P(Data, PlyErrors, testing::ValuesIn(kData), name_of);

}  // namespace
}  // namespace halfslope
