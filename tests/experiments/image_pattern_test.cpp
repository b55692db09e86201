#include "experiments/image_pattern.h"

#include <gmock/gmock.h>

#include <fstream>

#include "core/error.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ImagePatternTest : public testing::Test {
 protected:
  void touch(const std::string& path) const {
    const auto whole = folder_.path() / path;
    std::filesystem::create_directories(whole.parent_path());
    std::ofstream(whole) << "x";
  }
  ImageMatches find(const std::string& pattern) const {
    return ImagePattern((folder_.path() / pattern).string(), "--pattern").find();
  }
  const TemporaryFolder folder_;
};

/// The message of what throws, after checking its code.
template <class Action>
std::string refusal(ExitCode code, Action action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  return "nothing was thrown";
}
std::string usage(const std::string& pattern) {
  return refusal(ExitCode::kUsage, [&] { ImagePattern(pattern, "--pattern"); });
}

TEST_F(ImagePatternTest, FieldsAreReadFromFoldersAndNames) {
  touch("veach/mis_v2/halton/f16/64_0012.exr");
  touch("veach/mis_v2/halton/f16/64_7.exr");
  touch("veach/light/halton/f16/1024_7.exr");
  touch("veach/light/halton/f16/1024_7.png");
  touch("veach/light/halton/f16/deep/1024_7.exr");
  touch("veach/light/halton/f16/n64_7.exr");
  const ImageMatches found = find("{scene}/{estimator}/{sampler}/{precision}/{samples}_{seed}.exr");
  EXPECT_TRUE(found.problems.empty());
  ASSERT_EQ(found.files.size(), 3u);
  EXPECT_EQ(found.files[0].name, (CellName{"veach", "light", "halton", "f16", 1024}));
  EXPECT_EQ(found.files[0].seed, 7u);
  EXPECT_EQ(found.files[1].name, (CellName{"veach", "mis_v2", "halton", "f16", 64}));
  EXPECT_EQ(found.files[1].seed, 12u);
  EXPECT_EQ(found.files[2].seed, 7u);
}

TEST_F(ImagePatternTest, WhatThePatternLacksHasADefaultName) {
  touch("a-64spp.exr");
  const ImageMatches found = find("{sampler}-{samples}spp.exr");
  ASSERT_EQ(found.files.size(), 1u);
  EXPECT_EQ(found.files[0].name, (CellName{"image", "image", "a", "", 64}));
  EXPECT_FALSE(found.files[0].seed);
}

TEST_F(ImagePatternTest, ARepeatedFieldMustAgree) {
  touch("halton/halton_4.exr");
  touch("halton/sobol_4.exr");
  const ImageMatches found = find("{sampler}/{sampler}_{samples}.exr");
  ASSERT_EQ(found.files.size(), 1u);
  EXPECT_EQ(found.files[0].path.filename(), "halton_4.exr");
}

TEST_F(ImagePatternTest, ANameThatCanBePartedInTwoWaysIsNamed) {
  touch("path_tracer_halton_64.exr");
  touch("light_halton_64.exr");
  const ImageMatches found = find("{estimator}_{sampler}_{samples}.exr");
  ASSERT_EQ(found.files.size(), 1u);
  EXPECT_EQ(found.files[0].name.estimator, "light");
  ASSERT_EQ(found.problems.size(), 1u);
  EXPECT_THAT(found.problems[0].what, HasSubstr("path_tracer_halton_64.exr"));
  EXPECT_THAT(found.problems[0].text, AllOf(HasSubstr("estimator 'path'"), HasSubstr("estimator 'path_tracer'")));
}

TEST_F(ImagePatternTest, NumbersThatAreNoneAreNamed) {
  touch("0_1.exr");
  touch("4_99999999999999999999.exr");
  const ImageMatches found = find("{samples}_{seed}.exr");
  EXPECT_TRUE(found.files.empty());
  ASSERT_EQ(found.problems.size(), 2u);
  EXPECT_THAT(found.problems[0].text, HasSubstr("samples is 0"));
  EXPECT_THAT(found.problems[1].text, HasSubstr("2^64 - 1"));
}

TEST_F(ImagePatternTest, PatternsThatMakeNoSenseAreErrorsOfUsage) {
  EXPECT_THAT(usage("{sampler}{samples}.exr"), HasSubstr("nothing parts '{sampler}' from '{samples}'"));
  EXPECT_THAT(usage("{sampler}/{sed}_{samples}.exr"), HasSubstr("did you mean 'seed'?"));
  EXPECT_THAT(usage("{sampler}/{seed.exr"), HasSubstr("closes"));
  EXPECT_THAT(usage("{sampler}/{seed}.exr"), HasSubstr("no field {samples}"));
  EXPECT_THAT(usage(""), HasSubstr("--pattern: is empty"));
  EXPECT_THAT(usage("{samples}/"), HasSubstr("of files"));
}

TEST_F(ImagePatternTest, NoMatchNamesTheFolderAndTheNearestFiles) {
  touch("out/halton/64-1.exr");
  touch("out/halton/64-2.exr");
  touch("out/halton/notes.txt");
  const std::string message = refusal(ExitCode::kBadInput, [&] { find("out/{sampler}/{samples}_{seed}.exr"); });
  EXPECT_THAT(message, AllOf(HasSubstr((folder_ / "out").string() + "/halton'"), HasSubstr("'64-1.exr'"),
                             HasSubstr("'{samples}_{seed}.exr'")));
  EXPECT_THAT(refusal(ExitCode::kBadInput, [&] { find("ot/{samples}.exr"); }),
              AllOf(HasSubstr("a folder like 'ot'"), HasSubstr("'out'")));
}

TEST_F(ImagePatternTest, AScenesOwnReference) {
  EXPECT_EQ(with_scene("refs/{scene}/{scene}.exr", "veach", "--reference"), "refs/veach/veach.exr");
  EXPECT_EQ(with_scene("ref.exr", "veach", "--reference"), "ref.exr");
  EXPECT_THAT(refusal(ExitCode::kUsage, [] { with_scene("{sampler}.exr", "veach", "--reference"); }),
              HasSubstr("{scene}"));
}

}  // namespace
}  // namespace halfslope
