#include "samplers/point_file.h"

#include <gmock/gmock.h>

#include <fstream>
#include <vector>

#include "core/error.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::uint64_t kOne = std::uint64_t{1} << 53;

class PointFiles : public testing::Test {
 protected:
  PointFile read(const std::string& text, Outside outside = Outside::kRefuse, const PointFileLimits& limits = {}) {
    std::ofstream(folder_ / "points.txt", std::ios::binary) << text;
    return read_point_file(folder_ / "points.txt", outside, limits);
  }
  std::vector<std::uint64_t> words(const std::string& text, Outside outside = Outside::kRefuse) {
    const PointFile file = read(text, outside);
    return {file.words.begin(), file.words.end()};
  }
  /// The message of a file that must be refused, after the name of the file.
  std::string refusal(const std::string& text, Outside outside = Outside::kRefuse, const PointFileLimits& limits = {}) {
    try {
      read(text, outside, limits);
    } catch (const Error& error) {
      return rest_of(error);
    }
    ADD_FAILURE() << "was read: " << text.substr(0, 100);
    return "";
  }
  std::string refusal_of(const std::filesystem::path& path, const std::string& name) {
    try {
      read_point_file(path, Outside::kRefuse);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_THAT(error.what(), StartsWith(name + ": "));
      return error.what() + name.size() + 2;
    }
    ADD_FAILURE() << "was read: " << path;
    return "";
  }
  std::string rest_of(const Error& error) {
    const std::string name = (folder_ / "points.txt").string() + ":";
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_THAT(error.what(), StartsWith(name));
    return std::string(error.what()).substr(name.size());
  }
  const TemporaryFolder folder_;
};

TEST_F(PointFiles, AnySeparatorSeparates) {
  const std::vector<std::uint64_t> expected = {kOne / 2, kOne / 4, kOne / 8, 3 * (kOne / 4)};
  for (const char* text : {"0.5 0.25\n0.125 0.75\n", "0.5\t0.25\n0.125\t0.75\n", "0.5,0.25\n0.125,0.75\n",
                           "0.5;0.25\n0.125;0.75\n", "  0.5 ,\t0.25  \n.125   +7.5e-1", "0.5, 0.25,\n0.125, 0.75,\n",
                           "0.5 0.25\r\n0.125 0.75\r\n", "\n\n0.5 0.25\n \t \n0.125 0.75\n\n",
                           "\xef\xbb\xbf"
                           "0.5 0.25\n0.125 0.75"}) {
    const PointFile file = read(text);
    EXPECT_EQ(std::vector<std::uint64_t>(file.words.begin(), file.words.end()), expected) << text;
    EXPECT_EQ(file.dims, 2);
    EXPECT_EQ(file.count, 2u);
    EXPECT_EQ(file.sets, 1u);
  }
}

TEST_F(PointFiles, CommentsBetweenPointsEndSets) {
  for (const char* text :
       {"0.1\n0.2\n#\n0.3\n0.4\n#\n0.5\n0.6\n", "0.1\n0.2\n#\n0.3\n0.4\n#\n0.5\n0.6\n#\n",
        "// Table\n// Sequence 0:\n0.1\n0.2\n\n// Sequence 1:\n0.3\n0.4\n\n//\n# 2\n\n# 2\n0.5\n0.6\n",
        "#\n#\n  # x\n0.1\n\n0.2\n\t// y\n0.3\n0.4\n#0.5\n0.5\n0.6"}) {
    const PointFile file = read(text);
    EXPECT_EQ(file.sets, 3u) << text;
    EXPECT_EQ(file.count, 2u);
    EXPECT_EQ(file.words.size(), 6u);
  }
}

TEST_F(PointFiles, TheFirstLineMayNameTheColumns) {
  EXPECT_THAT(words("x0,x1\n0.5,0.25\n"), ElementsAre(kOne / 2, kOne / 4));
  EXPECT_THAT(words("# made by hand\nu v_2\n0.5 0.25\n"), ElementsAre(kOne / 2, kOne / 4));
  EXPECT_EQ(refusal("x0,x1\n0.5\n"), "2: found 1 coordinate, line 1 has 2");
  EXPECT_THAT(refusal("x0,x1\n0.5,0.5\nx0,x1\n"), StartsWith("3: coordinate 1: found 'x0';"));
  EXPECT_THAT(refusal("nan,inf\n"), StartsWith("1: coordinate 1: found 'nan'; a finite number is allowed"));
}

TEST_F(PointFiles, DecimalsGoToTheNearestNumberAndAreCutTo53Bits) {
  // 0.1 is 3602879701896397/2⁵⁵ in binary64, 1/3 to 16 digits 6004799503160661/2⁵⁴; two bits and one fall off.
  EXPECT_THAT(words("0.1"), ElementsAre(3602879701896397u / 4));
  EXPECT_THAT(words("0.3333333333333333"), ElementsAre(6004799503160661u / 2));
  EXPECT_THAT(words("0.99999999999999988897769753748434596"), ElementsAre(kOne - 1));
  EXPECT_THAT(words("0.500000000000000055511151231257827021181583404541015625"), ElementsAre(kOne / 2));  // a tie
  EXPECT_THAT(words("1.1102230246251565e-16\n1.1e-16\n5e-324\n1e-400\n0.00000e5\n-0\n-1e-999\n0e999999999999999999999"),
              ElementsAre(1, 0, 0, 0, 0, 0, 0, 0));
}

TEST_F(PointFiles, CoordinatesOutsideAreRefusedUnlessWrappedOrClamped) {
  EXPECT_THAT(refusal("0.5 0.5\n0.5 1\n"),
              AllOf(StartsWith("2: coordinate 2 is 1, outside [0, 1); `file-wrap:"), HasSubstr("`measure --wrap`"),
                    HasSubstr("`file-clamp:"), HasSubstr("`measure --clamp`")));
  EXPECT_THAT(refusal("-1e-300"), StartsWith("1: coordinate 1 is -1e-300, outside"));
  EXPECT_THAT(refusal("0.99999999999999999999"), StartsWith("1: coordinate 1 is 1, outside"));  // as binary64
  const std::string text = "0.5\n1\n1.25\n-0.25\n-1\n-1e-300\n1e300\n123456789.5\n-3.75\n";
  EXPECT_THAT(words(text, Outside::kWrap),
              ElementsAre(kOne / 2, 0, kOne / 4, 3 * (kOne / 4), 0, kOne - 1, 0, kOne / 2, kOne / 4));
  EXPECT_THAT(words(text, Outside::kClamp), ElementsAre(kOne / 2, kOne - 1, kOne - 1, 0, 0, 0, kOne - 1, kOne - 1, 0));
  EXPECT_EQ(read(text, Outside::kWrap).moved, 8u);
  EXPECT_EQ(read(text, Outside::kClamp).moved, 8u);
}

TEST_F(PointFiles, WhatIsNoFiniteNumberIsNamedWithItsPlace) {
  for (const Outside outside : {Outside::kRefuse, Outside::kWrap, Outside::kClamp}) {
    EXPECT_EQ(refusal("# x\n0.5 0.5\n\n0.5 nan\n", outside),
              "4: coordinate 2: found 'nan'; a finite number is allowed");
    EXPECT_EQ(refusal("0.5 -inf", outside), "1: coordinate 2: found '-inf'; a finite number is allowed");
    EXPECT_EQ(refusal("0.5 1e999", outside), "1: coordinate 2: found '1e999'; a finite number is allowed");
    EXPECT_EQ(refusal("0.5 0.5x 0.5", outside), "1: coordinate 2: found '0.5x'; a finite number is allowed");
    EXPECT_EQ(refusal("0.5 0x1p-3", outside), "1: coordinate 2: found '0x1p-3'; a finite number is allowed");
    EXPECT_EQ(refusal("0.5,,0.5", outside), "1: coordinate 2 is missing; found ','");
    EXPECT_EQ(refusal(",0.5", outside), "1: coordinate 1 is missing; found ','");
    EXPECT_EQ(refusal("0.5 # half", outside), "1: coordinate 2: found '#'; a finite number is allowed");
  }
}

TEST_F(PointFiles, BinaryGarbageIsShownHarmlessly) {
  const std::string message = refusal(std::string("\x1b[2J\x00\x01\xff\x7f", 8));
  EXPECT_THAT(message, StartsWith(R"(1: coordinate 1: found '\x1b[2J\x00\x01\xff\x7f'; a finite number is allowed.)"));
  EXPECT_THAT(message, EndsWith("Is this a text file?"));
  EXPECT_THAT(refusal(std::string(1000, 'z') + "?"),
              AllOf(HasSubstr("found 'zzzz"), HasSubstr("z…'"), HasSubstr("1: ")));
}

TEST_F(PointFiles, RaggedRowsAndSetsAreRefused) {
  EXPECT_EQ(refusal("#\n0.5 0.5\n0.5 0.5\n0.5 0.5 0.5\n"), "4: found 3 coordinates, line 2 has 2");
  EXPECT_EQ(refusal("0.5 0.5\n#\n0.5\n"), "3: found 1 coordinate, line 1 has 2");
  EXPECT_EQ(refusal("0.1\n0.2\n#\n0.3\n0.4\n#\n0.5\n#\n0.6\n0.7\n"),
            "7: set 3 begins here and has 1 point, the first has 2; they must be alike");
  EXPECT_EQ(refusal("0.1\n#\n0.3\n0.4\n"),
            "3: set 2 begins here and has 2 points, the first has 1; they must be alike");
}

TEST_F(PointFiles, NoPointsAreRefused) {
  EXPECT_EQ(refusal(""), " holds no points, it is empty; a line for each is needed");
  EXPECT_EQ(refusal("# nothing\n\n"), " holds no points; a line for each is needed");
  EXPECT_EQ(refusal("x0,x1\n"), " holds no points; a line for each is needed");
}

TEST_F(PointFiles, FilesThatAreNoneAreRefused) {
  const std::string missing = (folder_ / "nothing").string(), folder = folder_.path().string();
  EXPECT_EQ(refusal_of(missing, missing), "cannot be read: No such file or directory");
  EXPECT_EQ(refusal_of(folder, folder), "is a folder, not a file");
}

TEST_F(PointFiles, ALineWithoutEndIsRefusedWithoutBeingRead) {
  // Sparse, so it costs nothing; but read to its end it would take half a minute and 64 GiB.
  read("0.5\n");
  std::filesystem::resize_file(folder_ / "points.txt", std::uintmax_t{1} << 36);
  try {
    read_point_file(folder_ / "points.txt", Outside::kRefuse);
    FAIL() << "was read";
  } catch (const Error& error) {
    EXPECT_EQ(rest_of(error),
              "2: the line is longer than 1048576 bytes, the most that is allowed; a point takes a line");
  }
}

TEST_F(PointFiles, MorePointsThanMemoryIsMeantToHoldAreRefused) {
  EXPECT_EQ(read("0.1 0.2\n0.3 0.4\n0.5 0.6\n", Outside::kRefuse, {.coordinates = 6}).words.size(), 6u);
  EXPECT_THAT(refusal("0.1 0.2\n0.3 0.4\n0.5 0.6\n", Outside::kRefuse, {.coordinates = 5}),
              AllOf(StartsWith(" too many points: about "), HasSubstr("; at most 5 (")));
  // A large file is refused by what its first lines show: 2²¹ coordinates, long before the limit is met.
  std::string text;
  for (int i = 0; i < 1 << 20; ++i) text += "0.5 0.5\n";
  EXPECT_EQ(refusal(text, Outside::kRefuse, {.coordinates = 1u << 19}),
            " too many points: about 2097136 coordinates, 0.0156 GiB; at most 524288 (0.00391 GiB) are read");
}

TEST_F(PointFiles, TheHashIsOfThePointsAlone) {
  const std::uint64_t hash = read("0.5 0.25\n0.125 0.75\n").hash;
  EXPECT_EQ(read("# a\nx y\n5e-1,0.250\r\n\n0.125;0.75").hash, hash);
  EXPECT_NE(read("0.5 0.25\n0.125 0.7500000000000001\n").hash, hash);
  EXPECT_NE(read("0.5 0.25\n#\n0.125 0.75\n").hash, hash);
  EXPECT_NE(read("0.5\n0.25\n0.125\n0.75\n").hash, hash);
}

}  // namespace
}  // namespace halfslope
