// Points of files through the commands.
#include <fstream>
#include <sstream>

#include "experiments/images.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/csv_table.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

// Christensen's published tables: mean absolute error over 100 sequences on the quarter disk, six decimals, at N = 4,
// 8, … 1024. Ours are the same to the last digit. At one of the 512 the exact value, 0.0133625, lies halfway between
// two numbers of six decimals; either is right.
TEST(FilePointsRun, PublishedErrorsComeOutToEveryDigit) {
  const std::string folder = HALFSLOPE_SOURCE_DIR "/../shared/data/christensen/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  for (const std::string kind : {"pmj02", "random"}) {
    std::ifstream published(folder + "errors_quarterdisk_" + kind + ".data");
    std::vector<double> errors;
    std::string samples;
    for (double n = 0, error = 0; published >> n >> error; errors.push_back(error))
      samples += (samples.empty() ? "" : ",") + std::to_string(static_cast<int>(n));
    ASSERT_EQ(errors.size(), 256u);
    const RunScope scope;
    scope.run({{"scene", "quarterdisk"},
               {"samplers", "file:" + folder + kind + "_1024samples_100sequences.data"},
               {"samples", samples},
               {"precision", "f64"}});
    const CsvTable table = scope.table("convergence.csv");
    ASSERT_EQ(table.size(), errors.size());
    for (std::size_t r = 0; r < errors.size(); ++r) {
      EXPECT_EQ(table.text(r, "replicates"), "100");
      EXPECT_LE(std::abs(table.number(r, "mae") - errors[r]), 0.5e-6 + 1e-15) << kind << ", N = " << 4 * (r + 1);
    }
  }
}

class FilePointsCommands : public CommandLine {
 protected:
  /// Sets of `count` points (s/64 + i/32, i/16), s = 0, 1, ….
  std::string points(const char* name, int sets, int count) const {
    std::ostringstream text;
    for (int s = 0; s < sets; ++s) {
      for (int i = 0; i < count; ++i) text << s / 64.0 + i / 32.0 << ' ' << i / 16.0 << '\n';
      text << "#\n";
    }
    return write(name, text.str());
  }
};

TEST_F(FilePointsCommands, SetsAreTheReplicatesWhateverIsAsked) {
  const std::string file = "file:" + points("p.txt", 17, 8);
  const Ended ended = run({"--samplers", file + ",independent", "--samples", "2,4,8", "--replicates", "40",
                           "--estimators", "light", "--precision", "f64", "--measures", "l2-star"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const CsvTable cells = CsvTable::read(folder_ / "out/convergence.csv");
  const CsvTable replicates = CsvTable::read(folder_ / "out/replicates.csv");
  const CsvTable measured = CsvTable::read(folder_ / "out/discrepancy.csv");
  ASSERT_EQ(cells.size(), 6u);
  ASSERT_EQ(replicates.size(), 3 * (17 + 40u));
  ASSERT_EQ(measured.size(), 3 * (17 + 40u));
  for (std::size_t r = 0; r < 3; ++r) {
    EXPECT_EQ(cells.text(r, "sampler"), file);
    EXPECT_EQ(cells.text(r, "replicates"), "17");
    EXPECT_EQ(cells.text(r, "status"), "ok");
    // f(x) = x on x_i = s/64 + i/32: the mean over prefixes of N and all s is 1/8 + (N − 1)/64.
    EXPECT_DOUBLE_EQ(cells.number(r, "mean"), 0.125 + (cells.number(r, "samples") - 1) / 64);
  }
  for (std::size_t r = 0; r < 17; ++r) EXPECT_EQ(replicates.number(r, "mean"), static_cast<double>(r + 1) / 64);
}

TEST_F(FilePointsCommands, OneSetIsDeterministic) {
  const Ended ended = run({"--samplers", "file:" + points("p.txt", 1, 8), "--samples", "2,8"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const CsvTable cells = CsvTable::read(folder_ / "out/convergence.csv");
  EXPECT_EQ(cells.text(0, "replicates"), "1");
  EXPECT_EQ(cells.text(0, "status"), "deterministic");
  EXPECT_EQ(cells.text(0, "rmse_lo"), "");
}

TEST_F(FilePointsCommands, ThePlanSaysWhatToKnowOfThem) {
  const Ended ended = run({"--samplers", "file:" + points("p.txt", 3, 8), "--samples", "4:16", "--dry-run"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("1 pixel x 3 replicates"),
                               HasSubstr("its 3 sets are its replicates, whatever `replicates` says"),
                               HasSubstr("the same points stand in every pixel, so pixels err alike"),
                               HasSubstr("N = 16 left out"), HasSubstr("nearest legal: 8")));
}

TEST_F(FilePointsCommands, AFilesFaultIsBadInputAndAFlagsFaultIsUsage) {
  const std::string bad = write("bad.txt", "0.5 0.5\n0.5 1.5\n"), missing = (folder_ / "none.txt").string();
  EXPECT_THAT(refusal({"--samplers", "file:" + bad}, 3), StartsWith("halfslope: " + bad + ":2: coordinate 2 is 1.5"));
  EXPECT_THAT(refusal({"--samplers", "file:" + missing}, 3), StartsWith("halfslope: " + missing + ": cannot be read"));
  EXPECT_THAT(refusal({"--samplers", "file:"}, 2), HasSubstr("--samplers: sampler 'file:': nothing stands after ':'"));
  EXPECT_THAT(refusal({"--samplers", "fiel:" + bad}, 2), HasSubstr("there is no sampler 'fiel:"));
  const std::string good = "file:" + points("p.txt", 3, 8);
  EXPECT_THAT(refusal({"--samplers", good, "--samples", "3,9"}, 2), HasSubstr("the nearest legal: 8"));
  EXPECT_THAT(refusal({"--samplers", good, "--scene", "genz-gaussian:d=3"}, 2), HasSubstr("has 2 dimensions"));
  for (const std::string command_name : {"points", "render"}) {
    std::vector<std::string> arguments = {command_name, "--sampler", "file:" + bad};
    if (command_name == "render") arguments = arguments + std::vector<std::string>{"--scene", "diffuse-sphere"};
    const Ended ended = command(arguments);
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_THAT(ended.err, StartsWith("halfslope: " + bad + ":2: "));
  }
  EXPECT_EQ(command({"figure", "points", "--samplers", "file:" + bad, "--out", (folder_ / "f.svg").string()}).code, 3);
}

TEST_F(FilePointsCommands, PrintedPointsReadBackToTheSameBytes) {
  const std::vector<std::string> count = {"--count", "100", "--dims", "5"};
  const Ended first = command(std::vector<std::string>{"points", "--sampler", "halton-owen"} + count);
  const std::string file = write("p.csv", first.out);
  const Ended second = command(std::vector<std::string>{"points", "--sampler", "file:" + file} + count);
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(second.out, first.out);
}

TEST_F(FilePointsCommands, OnlyReplicatesThatThereAreCanBeAskedFor) {
  const std::string file = points("p.txt", 3, 8);
  EXPECT_EQ(command({"points", "--sampler", "file:" + file, "--count", "2", "--replicate", "2"}).out,
            "x0,x1\n0.03125,0\n0.0625,0.0625\n");
  const Ended points = command({"points", "--sampler", "file:" + file, "--count", "2", "--replicate", "3"});
  EXPECT_EQ(points.code, 2);
  EXPECT_THAT(points.err, HasSubstr("has 3 replicates, from 0 on, found 3"));
  const Ended render = command({"render", "--scene", "diffuse-sphere", "--estimator", "light", "--sampler",
                                "file:" + file, "--samples", "8", "--replicate", "3", "--out", out()});
  EXPECT_EQ(render.code, 2);
  EXPECT_THAT(render.err, HasSubstr("has 3 replicates, from 0 on, found 3"));
}

TEST_F(FilePointsCommands, OtherPointsAreAnotherExperiment) {
  const std::string file = "file:" + points("p.txt", 16, 8);
  ASSERT_EQ(run({"--samplers", file, "--samples", "8"}).code, 0);
  EXPECT_EQ(run({"--samplers", file, "--samples", "8"}).code, 0);
  points("p.txt", 16, 9);
  const Ended other = run({"--samplers", file, "--samples", "8"});
  EXPECT_NE(other.code, 0);
  EXPECT_THAT(other.err, HasSubstr("--overwrite"));
  EXPECT_EQ(run({"--samplers", file, "--samples", "8", "--overwrite"}).code, 0);
}

TEST_F(FilePointsCommands, NamesMayHoldCommas) {
  const std::string file = "file:" + points("a,b.txt", 16, 8);
  const std::string list = "[\"" + file + "\", \"independent\"]";
  const std::string toml = write("x.toml", "scene = \"mis-toy\"\nsamples = [8]\nsamplers = " + list + "\n");
  ASSERT_EQ(command({"run", toml, "--quiet", "--out", out()}).code, 0);
  EXPECT_EQ(CsvTable::read(folder_ / "out/convergence.csv").text(0, "sampler"), file);
  std::string escaped = file;
  escaped.replace(escaped.find("a,b"), 3, "a\\,b");
  ASSERT_EQ(run({"--samplers", escaped + ",independent", "--samples", "8", "--overwrite"}).code, 0);
  const CsvTable cells = CsvTable::read(folder_ / "out/convergence.csv");
  EXPECT_EQ(cells.text(0, "sampler"), file);
  EXPECT_EQ(cells.text(cells.size() - 1, "sampler"), "independent");
}

TEST_F(FilePointsCommands, ImagesHaveAFolderForEachSampler) {
  std::filesystem::create_directory(folder_ / "a");
  const std::string one = "file:" + points("a/b", 16, 8), other = "file:" + points("a_b", 16, 8);
  const std::vector<std::string> picture = {
      "--scene", "diffuse-sphere", "--resolution", "8,6", "--estimators", "light", "--samples", "8", "--images", "8"};
  ASSERT_EQ(run(picture + std::vector<std::string>{"--samplers", one + ",independent"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/images/diffuse-sphere/f32/light" / path_component(one) / "8.exr"));
  std::filesystem::remove_all(out());
  EXPECT_THAT(refusal(picture + std::vector<std::string>{"--samplers", one + "," + other}, 2),
              HasSubstr("would have their images in one folder"));
}

TEST_F(FilePointsCommands, AFolderIsNamedAfterTheEndOfALongPath) {
  const std::string deep = "file:" + std::string(300, 'd') + "/points.txt",
                    other = "file:" + std::string(301, 'd') + "/points.txt";
  EXPECT_LE(path_component(deep).size(), 200u);
  EXPECT_THAT(path_component(deep), testing::EndsWith("d_points.txt"));
  EXPECT_NE(path_component(deep), path_component(other));
  EXPECT_EQ(path_component("file:a/b.txt"), "file:a_b.txt");
}

TEST_F(FilePointsCommands, FiguresShowTheLastPartOfThePath) {
  const std::string file = "file:" + points("p.txt", 3, 8), svg = (folder_ / "f.svg").string();
  const Ended ended = command({"figure", "points", "--samplers", file, "--samples", "8", "--out", svg});
  ASSERT_EQ(ended.code, 0) << ended.err;
  std::ostringstream text;
  text << std::ifstream(svg).rdbuf();
  EXPECT_THAT(text.str(), HasSubstr(">file:p.txt<"));
}

}  // namespace
}  // namespace halfslope
