// halfslope scenes check: what is said of scenes, right and wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/experiments/command_line_fixture.h"

namespace halfslope {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class ScenesCommand : public CommandLine {
 protected:
  Ended check(const std::vector<std::string>& more) const {
    return command(std::vector<std::string>{"scenes", "check"} + more);
  }
  std::string write_scene(const char* name, const std::string& body) const {
    return write(name, "<scene version='3.0.0'>\n" + body + "\n</scene>");
  }
};

const std::string kRoom =
    "<integrator type='path'><integer name='max_depth' value='5'/></integrator>\n"
    "<sensor type='perspective'><float name='near_clip' value='1'/></sensor>\n"
    "<shape type='cube'><bsdf type='twosided'><bsdf type='diffuse'/></bsdf></shape>\n"
    "<shape type='disk' id='lamp'><emitter type='area'><float name='radiance' value='3'/></emitter></shape>\n";

TEST_F(ScenesCommand, SaysWhatAShippedSceneHolds) {
  const Ended ended = check({"veach-mis", "--json"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.err, IsEmpty());
  const json scene = json::parse(ended.out).at(0);
  EXPECT_EQ(scene["shapes"], json({{"sphere", 5}, {"rectangle", 6}}));
  EXPECT_EQ(scene["materials"], json({{"black", 5}, {"diffuse", 2}, {"roughconductor", 4}}));
  EXPECT_EQ(scene["lights"].size(), 5u);
  // π times the area times the radiance: a sphere of radius 0.1 and radiance 100.
  EXPECT_NEAR(scene["lights"][1]["power"][0], 4 * std::numbers::pi * std::numbers::pi * 0.01 * 100, 1e-9);
  EXPECT_EQ(scene["max_depth"], 2);
  EXPECT_THAT(
      scene["work"].get<std::vector<std::string>>(),
      AllOf(Contains(HasSubstr("grey scene: one channel")), Contains(HasSubstr("direct lighting's own kernels"))));
}

TEST_F(ScenesCommand, SaysWhatAFileHoldsAndWhatNobodyReads) {
  const Ended ended = check({write_scene("room.xml", kRoom)});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("1 disk, 1 mesh"), HasSubstr("12"), HasSubstr("1 black, 1 diffuse, 1 twosided"),
                    HasSubstr("area 'lamp', 29.6088 W"),  // 3π²
                    HasSubstr("near_clip of sensor 'perspective'"), HasSubstr("gaussian, radius 2 pixels"),
                    HasSubstr("one light: no light choice"), HasSubstr("'shape1' is a mesh")));
}

TEST_F(ScenesCommand, PowersOfLightsWithoutAShape) {
  const std::string file = write_scene(
      "lights.xml",
      "<sensor type='radiancemeter'/><shape type='sphere'/><emitter type='point'><float name='intensity' value='2'/>"
      "</emitter><emitter type='spot'><float name='cutoff_angle' value='90'/><float name='beam_width' value='90'/>"
      "</emitter><emitter type='directional'/><emitter type='constant'/>");
  const Ended ended = check({file, "--json"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const json lights = json::parse(ended.out).at(0)["lights"];
  EXPECT_NEAR(lights[0]["power"][0], 8 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(lights[1]["power"][0], 2 * std::numbers::pi, 1e-12);  // a half sphere
  EXPECT_EQ(lights[2]["power"][0], 1);
  EXPECT_EQ(lights[2]["unit"], "W/m^2");
  EXPECT_NEAR(lights[3]["power"][0], 4 * std::numbers::pi, 1e-12);
}

TEST_F(ScenesCommand, EveryProblemOfEveryFile) {
  const std::string good = write_scene("good.xml", kRoom),
                    bad = write_scene("bad.xml", "<sensor type='perspektive'/>\n<shape type='spere'/>");
  const Ended ended = check({bad, good, (folder_ / "none.xml").string()});
  EXPECT_EQ(ended.code, 3);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("halfslope: " + bad + ":2: unknown sensor 'perspektive'"),
                               HasSubstr("halfslope: " + bad + ":3: unknown shape 'spere'"),
                               HasSubstr("halfslope: " + (folder_ / "none.xml").string())));
  EXPECT_THAT(ended.out, StartsWith(good));
  const Ended as_json = check({bad, good, "--json"});
  EXPECT_EQ(as_json.code, 3);
  const json scenes = json::parse(as_json.out);
  EXPECT_EQ(scenes[0]["problems"].size(), 2u);
  EXPECT_FALSE(scenes[0].contains("shapes"));
  EXPECT_TRUE(scenes[1]["problems"].empty());
}

TEST_F(ScenesCommand, ParametersStandBehindTheName) {
  const std::string file =
      write_scene("size.xml", "<default name='size' value='1'/>" + kRoom +
                                  "<shape type='sphere'><float name='radius' value='$size'/></shape>");
  EXPECT_EQ(check({file + ":size=2"}).code, 0);
  const Ended unknown = check({file + ":siz=2"});
  EXPECT_EQ(unknown.code, 3);
  EXPECT_THAT(unknown.err, HasSubstr("unknown parameter 'siz', allowed: size; did you mean 'size'?"));
  EXPECT_EQ(check({file + ":size"}).code, 3);
  EXPECT_EQ(check({file + ":size=1,size=2"}).code, 3);
}

TEST_F(ScenesCommand, WithoutFilesIsUsage) {
  EXPECT_EQ(check({}).code, 2);
  EXPECT_EQ(command({"scenes"}).code, 2);
  EXPECT_THAT(command({"completion"}).out, HasSubstr("check --json"));
}

}  // namespace
}  // namespace halfslope
