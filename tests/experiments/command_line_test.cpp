// Bad input, command by command: the exit code, and a message that says where, what, and what to do instead.
#include "experiments/command_line.h"

#include "core/atomic_file.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/csv_table.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::StartsWith;

TEST_F(CommandLine, TheRunThatTheOthersSpoilGoesWell) {
  const Ended ended = run({});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out + ended.err, IsEmpty());
  EXPECT_EQ(CsvTable::read(folder_ / "out/convergence.csv").size(), 5u);  // light, bsdf, average, balance, power
}

TEST_F(CommandLine, AWrongFlagIsUsage) {
  EXPECT_THAT(refusal({"--estimators", "balanse"}, 2), HasSubstr("--estimators: scene 'mis-toy': there is no estimator "
                                                                 "'balanse' for this scene; did you mean 'balance'?"));
  EXPECT_THAT(refusal({"--estimators", "balance@light+bdsf"}, 2), HasSubstr("did you mean 'bsdf'?"));
  EXPECT_THAT(refusal({"--samplers", "independant"}, 2), HasSubstr("did you mean 'independent'?"));
  EXPECT_THAT(refusal({"--scene", "mis-toi"}, 2), HasSubstr("did you mean 'mis-toy'?"));
  EXPECT_THAT(refusal({"--scene", "aligned-phong-cap:n=10,alpah=1"}, 2), HasSubstr("did you mean 'alpha'?"));
  EXPECT_THAT(refusal({"--samples", "0"}, 2), HasSubstr("--samples: found '0'; allowed: a range of powers of two"));
  EXPECT_THAT(refusal({"--samples", "3:48"}, 2), HasSubstr("the nearest are 2 and 4"));
  EXPECT_THAT(refusal({"--replicates", "0"}, 2), HasSubstr("--replicates: found '0'; allowed: an integer from 1"));
  EXPECT_THAT(refusal({"--seed", "-1"}, 2), HasSubstr("--seed"));
  EXPECT_THAT(refusal({"--precision", "f16"}, 2), HasSubstr("allowed: f32, f64"));
  EXPECT_THAT(refusal({"--images", "8"}, 2), HasSubstr("8 is not among the samples"));
  EXPECT_THAT(refusal({"--threads", "0"}, 2), HasSubstr("--threads"));
  EXPECT_THAT(refusal({"--replicate", "3"}, 2), HasSubstr("--replicate"));
}

TEST_F(CommandLine, AnIllegalNNamesItsLegalNeighbours) {
  EXPECT_THAT(refusal({"--estimators", "balance", "--samples", "16,17"}, 2),
              HasSubstr("N = 17 does not divide; the nearest legal: 16 and 18"));
  EXPECT_THAT(refusal({"--estimators", "power:3@light*3+bsdf", "--samples", "2"}, 2),
              HasSubstr("takes 4 samples a round, so N = 2 does not divide; the nearest legal: 4\n"));
  EXPECT_THAT(
      refusal({"--estimators", "light", "--samples", "281474976710656"}, 2),
      HasSubstr("cannot make N = 281474976710656 in 1 dimensions for 'light'; the nearest legal: 2147483648\n"));
  // Inside a range it is skipped, and the plan says so.
  const Ended plan = run({"--estimators", "balance", "--samples", "1:4", "--dry-run"});
  EXPECT_EQ(plan.code, 0);
  EXPECT_THAT(plan.out,
              AllOf(HasSubstr("independent: N = 1 left out for balance: "), HasSubstr("N = 1 does not divide")));
  EXPECT_THAT(refusal({"--estimators", "balance", "--samples", "1:1"}, 2), HasSubstr("nothing to measure"));
}

TEST_F(CommandLine, AWrongFileIsBadInputWithItsPlace) {
  const std::string rest = "samplers = 'independent'\nsamples = 16\n";
  EXPECT_THAT(file_refusal("scene = 'mis-toy'\nsampels = 16\n"),
              StartsWith("2:1: key 'sampels' is not known; did you mean 'samples'?"));
  EXPECT_THAT(file_refusal("scene = 'mis-toi'\n" + rest), AllOf(StartsWith("1:9: "), HasSubstr("'mis-toy'?")));
  EXPECT_THAT(file_refusal("scene = 'mis-toy'\nestimators = ['light', 'balanse']\n" + rest),
              AllOf(StartsWith("2:14: "), HasSubstr("'balance'?")));
  EXPECT_THAT(file_refusal("scene = 'mis-toy'\nsamples = 16\nsamplers = 'independant'\n"),
              AllOf(StartsWith("3:12: "), HasSubstr("'independent'?")));
  EXPECT_THAT(file_refusal("replicates = 'many'\n"), AllOf(StartsWith("1:14: key 'replicates': found 'many'"),
                                                           HasSubstr("allowed: an integer from 1 to 2^31")));
  EXPECT_THAT(file_refusal("replicates = 0\n"), StartsWith("1:14: key 'replicates': found 0"));
  EXPECT_THAT(file_refusal("samples = [4, 0]\n"), StartsWith("1:15: key 'samples': found 0"));
  EXPECT_THAT(file_refusal("samples = 1.5\n"), StartsWith("1:11: key 'samples': found a floating-point number"));
  EXPECT_THAT(file_refusal("seed = = 1\n"), StartsWith("1:8: "));
  EXPECT_THAT(file_refusal("scene = 'mis-toy'\nestimators = 'balance'\nsamplers = 'independent'\nsamples = [4, 7]\n"),
              AllOf(StartsWith("4:11: "), HasSubstr("N = 7 does not divide; the nearest legal: 6 and 8")));
  EXPECT_THAT(file_refusal("scene = 'mis-toy'\nsamples = 16\n"), HasSubstr("key 'samplers' is missing"));
}

TEST_F(CommandLine, AMissingFileIsBadInput) {
  const std::string toml = (folder_ / "none.toml").string(), xml = (folder_ / "none.xml").string();
  const Ended ended = command({"run", toml});
  EXPECT_EQ(ended.code, 3);
  EXPECT_EQ(ended.err, "halfslope: " + toml + ": cannot be read: No such file or directory\n");
  EXPECT_EQ(refusal({"--scene", xml}, 3), "halfslope: " + xml + ": cannot be read: No such file or directory\n");
  for (const char* name : {"render", "reference"}) EXPECT_EQ(command({name, "--scene", xml}).code, 3);
}

TEST_F(CommandLine, AnElementThatIsNotSupportedIsNamedWithItsLine) {
  const std::string xml = write("scene.xml", R"(<scene version="3.0.0">
  <sensor type="radiancemeter"><point name="origin" x="0" y="0" z="1"/><vector name="direction" x="0" y="0" z="-1"/></sensor>
  <shape type="sphere"><emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>
  <shape type="heightfield"/>
</scene>
)");
  const std::string place = "halfslope: " + xml + ":4:";
  EXPECT_THAT(refusal({"--scene", xml}, 3), AllOf(StartsWith(place), HasSubstr("heightfield")));
  const std::string toml = write("x.toml", "scene = '" + xml + "'\nsamplers = 'independent'\nsamples = 16\n");
  const Ended ended = command({"run", toml, "--out", out()});
  EXPECT_EQ(ended.code, 3);
  EXPECT_THAT(ended.err, StartsWith(place));
  for (const char* name : {"render", "reference"}) {
    const Ended other = command({name, "--scene", xml});
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err, StartsWith(place));
  }
}

TEST_F(CommandLine, WrongUsageNamesTheNearestCommand) {
  for (const auto& [arguments, message] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, "A subcommand is required"},
           {{"rnu"}, "did you mean 'run'?"},
           {{"pionts", "--sampler", "independent"}, "did you mean 'points'?"},
           {{"run", "--frames", "3"}, "--frames"},
           {{"run"}, "--scene is missing"},
           {{"run", "--scene"}, "--scene"},
           {{"points"}, "--sampler is required"},
           {{"points", "--sampler", "haltn-owen"}, "did you mean 'halton-owen'?"},
           {{"points", "--sampler", "independent", "--count", "0"}, "the nearest legal: 1"},
           {{"points", "--sampler", "independent", "--count", "many"}, "--count"},
           {{"points", "--sampler", "n-rooks", "--dims", "0"}, "--dims: at least 1"},
           {{"points", "--sampler", "n-rooks", "--dims", "1025"}, "at most 1024 dimensions, found 1025"},
           {{"points", "--sampler", "n-rooks", "--precision", "f32,f64"}, "--precision"},
           {{"list", "sampler"}, "did you mean 'samplers'?"},
           {{"render", "--scene", "mis-toy", "--samples", "17"}, "the nearest legal: 16 and 18"},
           {{"render", "--scene", "mis-toy", "--samples", "0"}, "the nearest legal: 2"},
           {{"render", "--scene", "mis-toy", "--estimator", "powr"}, "did you mean 'power'?"},
           {{"render", "--scene", "mis-toy", "--resolution", "0,4"}, "--resolution"},
           {{"render", "--scene", "cornell-box", "--max_depth", "3"}, "--max_depth is for paths"},
           {{"render", "--scene", "cornell-box", "--exposure", "1", "-o", "x.exr"}, "--exposure is for a .png"},
           {{"reference", "--scene", "cornell-box", "--max_depth", "3"}, "--max_depth is for paths"},
           {{"reference", "--scene", "mis-toy", "--samples", "3"}, "--samples: at least 4"},
           {{"reference", "--scene", "mis-toy", "--relative-error", "-1"}, "--relative-error"},
           {{"reference", "--scene", "mis-toy", "--max-replicates", "4"}, "--max-replicates"}}) {
    const Ended ended = command(arguments);
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_THAT(ended.err, AllOf(StartsWith("halfslope: "), HasSubstr(message)));
    EXPECT_THAT(ended.out, IsEmpty());
  }
}

// A catalogue is made before the command line can catch anything: it must not need kernels.
TEST_F(CommandLine, AnUnknownInstructionSetIsUsage) {
  ChildOptions wrong = options();
  wrong.environment["HALFSLOPE_ISA"] = "avx51";
  const Ended ended = run_with(wrong, {});
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err,
            "halfslope: HALFSLOPE_ISA=avx51: allowed: scalar, baseline, avx2, avx512; did you mean 'avx512'?\n");
  EXPECT_EQ(run_program({"--help"}, wrong).code, 0);
}

TEST_F(CommandLine, KernelsThatAreNotThereSayWhereTheyWereSought) {
  // A copy of the program that lies apart from its kernels.
  std::filesystem::copy_file(kProgram, folder_ / "halfslope");
  ChildOptions apart = options();
  apart.program = (folder_ / "halfslope").string();
  const Ended ended = run_with(apart, {});
  if (ended.code == 0) GTEST_SKIP() << "an installed halfslope has kernels for the copy";
  EXPECT_EQ(ended.code, 4);
  EXPECT_THAT(ended.err,
              AllOf(HasSubstr("set HALFSLOPE_KERNELS to their folder"), HasSubstr((folder_ / "kernels").string())));
  apart.environment["HALFSLOPE_KERNELS"] = HALFSLOPE_BINARY_DIR "/kernels";
  EXPECT_EQ(run_with(apart, {}).code, 0);
}

// Permission bits do not bind root; that there is no folder below a device binds everyone.
TEST_F(CommandLine, AnUnwritableOutFolderIsAnIoError) {
  const std::string below_a_file = write("file", "x") + "/below";
  for (const std::string& folder : {std::string("/dev/null/x"), below_a_file}) {
    const Ended ended = run({"--out", folder});
    EXPECT_EQ(ended.code, 4);
    EXPECT_EQ(ended.err,
              "halfslope: " + folder + ": the run folder cannot be made: Not a directory; choose another with --out\n");
  }
  for (const auto& arguments : {std::vector<std::string>{"render", "--scene", "mis-toy", "--out", "/dev/null/x.exr"},
                                {"reference", "--scene", "mis-toy", "--out", "/dev/null/x.exr"}}) {
    const Ended ended = command(arguments);
    EXPECT_EQ(ended.code, 4) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("/dev/null/x.exr"));
  }
}

TEST_F(CommandLine, AFullDiskIsAnIoErrorAndTheRunGoesOnLater) {
  const std::vector<std::string> work = {"--samples", "4:64", "--replicates", "2048"};
  ASSERT_EQ(run(work + std::vector<std::string>{"--out", (folder_ / "whole").string()}).code, 0);
  for (const rlim_t limit : {100, 20000, 300000}) {  // in the journal's header, among its records, in a table
    ChildOptions full = options();
    full.largest_file = limit;
    const Ended ended = run_with(full, work);
    EXPECT_EQ(ended.code, 4) << ended.err;
    EXPECT_THAT(ended.err, AllOf(HasSubstr(out()), HasSubstr("File too large")));
    for (const auto& file : std::filesystem::directory_iterator(out()))
      EXPECT_NE(file.path().extension(), ".tmp") << file.path();
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/convergence.csv"));
  EXPECT_EQ(run(work).code, 0);
  for (const char* table : {"convergence.csv", "replicates.csv", "rates.csv"})
    EXPECT_EQ(read_file(folder_ / "out" / table), read_file(folder_ / "whole" / table)) << table;
}

TEST_F(CommandLine, StandardOutputThatCannotBeWrittenIsAnIoError) {
  ChildOptions full = options();
  full.out_path = "/dev/full";
  for (const auto& arguments : {std::vector<std::string>{"points", "--sampler", "independent", "--count", "3"},
                                {"points", "--sampler", "independent", "--count", "100000"},
                                {"list"},
                                {"completion"},
                                {"reference", "--scene", "mis-toy", "--quiet"},
                                {"--help"},
                                {"--version"}}) {
    const Ended ended = run_program(arguments, full);
    EXPECT_EQ(ended.code, 4) << arguments[0];
    EXPECT_THAT(ended.err, HasSubstr("standard output")) << arguments[0];
  }
  EXPECT_EQ(run_with(full, {"--json"}).code, 4);
}

// A closed stream's number must not go to the journal, which messages would then overwrite.
TEST_F(CommandLine, ClosedStreamsDoNoHarm) {
  const std::vector<std::string> arguments = {"run",        "--out",       out(),       "--scene", "mis-toy",
                                              "--samplers", "independent", "--samples", "16"};
  ASSERT_EQ(command(arguments).code, 0);
  const std::string whole = read_file(folder_ / "out/convergence.csv");
  for (const char* broken : {"closed", "/dev/full"}) {
    ChildOptions streams = options();
    streams.err_path = broken;
    EXPECT_EQ(run_program(arguments + std::vector<std::string>{"--overwrite"}, streams).code, 0);
    EXPECT_EQ(run_program({"rnu"}, streams).code, 2);
    EXPECT_EQ(run_program({"render", "--scene", "none.xml"}, streams).code, 3);
    streams.out_path = broken;
    EXPECT_EQ(run_program(arguments + std::vector<std::string>{"--overwrite"}, streams).code, 4);  // no summary
    EXPECT_EQ(command(arguments).code, 0);  // the journal is whole
    EXPECT_EQ(read_file(folder_ / "out/convergence.csv"), whole);
  }
}

TEST_F(CommandLine, ASecondRunInTheFolderIsBusyAtOnce) {
  const std::vector<std::string> seconds_of_work = {"--samples", "4:4096", "--replicates", "16384"};
  std::vector<std::string> arguments = {"run",     "--quiet", "--out",      out(),
                                        "--scene", "mis-toy", "--samplers", "independent"};
  Child first(arguments + seconds_of_work, options());
  while (!std::filesystem::exists(folder_ / "out/journal")) ASSERT_TRUE(first.running());
  for (const char* flag : {"--quiet", "--overwrite"}) {
    const Ended second = run({flag});
    ASSERT_TRUE(first.running()) << "the first run is too short to disturb";
    EXPECT_EQ(second.code, 4);
    EXPECT_EQ(second.err,
              "halfslope: another run is at work in " + out() + "; wait for it, or choose another folder with --out\n");
    EXPECT_THAT(second.seconds, Lt(2));
  }
  const Ended ended = first.wait();
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(command(arguments + seconds_of_work + std::vector<std::string>{"--out", (folder_ / "alone").string()}).code,
            2);  // --out twice
  arguments[3] = (folder_ / "alone").string();
  ASSERT_EQ(command(arguments + seconds_of_work).code, 0);
  EXPECT_EQ(read_file(folder_ / "out/convergence.csv"), read_file(folder_ / "alone/convergence.csv"));
}

TEST_F(CommandLine, AnotherExperimentInTheFolderIsRefusedUnlessOverwritten) {
  ASSERT_EQ(run({"--images", "16"}).code, 0);
  const auto before = read_file(folder_ / "out/convergence.csv");
  std::ofstream(folder_ / "out/notes.txt") << "mine";
  const Ended other = run({"--seed", "2"});
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, AllOf(HasSubstr(out() + " holds the results of another run; different: spec ("),
                               HasSubstr("start afresh with --overwrite, or --out another folder")));
  EXPECT_EQ(read_file(folder_ / "out/convergence.csv"), before);
  EXPECT_EQ(run({"--seed", "2", "--overwrite"}).code, 0);
  EXPECT_NE(read_file(folder_ / "out/convergence.csv"), before);
  // The first run's pictures would pass for the second's.
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/images/mis-toy/f32/light/independent/16.exr"));
  EXPECT_EQ(read_file(folder_ / "out/notes.txt"), "mine");
  // How a run is called and where it runs is not part of what it measures.
  EXPECT_EQ(run({"--seed", "2", "--name", "other", "--threads", "1"}).code, 0);
  // Another instruction set's last bits are others.
  ChildOptions baseline = options();
  baseline.environment["HALFSLOPE_ISA"] = "baseline";
  if (run_with(baseline, {"--dry-run"}).code == 0) {
    const Ended isa = run_with(baseline, {"--seed", "2"});
    EXPECT_EQ(isa.code, 3);
    EXPECT_THAT(isa.err, HasSubstr("ISA class (fma there, baseline here)"));
  }
}

TEST_F(CommandLine, WhatIsNoJournalIsNotOverwrittenUnasked) {
  std::filesystem::create_directories(out());
  std::ofstream(folder_ / "out/journal") << "Dear diary, today I rendered a teapot.";
  const Ended ended = run({});
  EXPECT_EQ(ended.code, 3);
  EXPECT_THAT(ended.err, HasSubstr("not a journal that halfslope"));
  EXPECT_THAT(read_file(folder_ / "out/journal"), StartsWith("Dear diary"));
}

}  // namespace
}  // namespace halfslope
