// What the commands print.
#include "experiments/commands.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/measures.h"
#include "samplers/catalogue.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/csv_table.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::Not;

using Commands = CommandLine;

TEST_F(Commands, NamesNeedNotBeUtf8) {
  const std::string xml = write("sc\xe8ne.xml", R"(<scene version="3.0.0">
  <sensor type="radiancemeter"><point name="origin" x="0" y="0" z="1"/><vector name="direction" x="0" y="0" z="-1"/></sensor>
  <shape type="rectangle"/>
  <shape type="sphere"><point name="center" x="0" y="0" z="3"/><float name="radius" value="0.5"/>
    <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>
</scene>
)");
  const Ended ended = run({"--scene", xml, "--json"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(nlohmann::json::parse(ended.out).size(), 5u);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/manifest.json"));
}

TEST_F(Commands, EveryCommandHasHelp) {
  const Ended top = command({"--help"});
  EXPECT_EQ(top.code, 0);
  for (const std::string name : {"run", "list", "points", "render", "reference", "figure", "completion"}) {
    EXPECT_THAT(top.out, HasSubstr("\n  " + name + " "));
    const Ended help = command({name, "--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, AllOf(HasSubstr("Usage: halfslope " + name), HasSubstr("--help")));
    EXPECT_THAT(help.err, IsEmpty());
  }
  const Ended run_help = command({"run", "--help"});
  for (const char* flag : {"--name", "--scene", "--estimators", "--samplers", "--samples", "--replicates", "--seed",
                           "--resolution", "--pixels", "--images", "--precision", "--measures", "--out", "--threads",
                           "--quiet", "--dry-run", "--overwrite", "--json"})
    EXPECT_THAT(run_help.out, HasSubstr(flag));
  EXPECT_THAT(command({"--version"}).out, ContainsRegex("^[0-9]+\\.[0-9]+\\.[0-9]+\n$"));
}

TEST_F(Commands, ListsAreTablesAndJson) {
  const auto json = nlohmann::json::parse(command({"list", "--json"}).out);
  for (const char* kind : {"samplers", "estimators", "scenes", "measures", "figures", "statuses"}) {
    ASSERT_TRUE(json.contains(kind));
    const Ended table = command({"list", kind});
    for (const auto& entry : json[kind]) {
      EXPECT_THAT(table.out, HasSubstr("\n  " + entry["name"].get<std::string>() + " "));
      EXPECT_THAT(entry["description"].get<std::string>(), Not(IsEmpty()));
      EXPECT_EQ(entry["reference"].get<std::string>().empty(), std::string(kind) == "statuses");
    }
  }
  std::string samplers, measures;
  for (const std::string& name : SamplerCatalogue::built_in().names())
    samplers += name.substr(0, name.find(':')) + "\n";
  for (const std::string& name : measure_names()) measures += name + "\n";
  EXPECT_EQ(command({"list", "samplers", "--names"}).out, samplers);
  EXPECT_EQ(command({"list", "measures", "--names"}).out, measures);
  EXPECT_THAT(samplers, HasSubstr("independent\n"));
  EXPECT_THAT(measures, HasSubstr("star\nl2-star\n"));
}

TEST_F(Commands, JsonIsConvergenceCsv) {
  const Ended ended = run({"--json", "--precision", "f32,f64"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto json = nlohmann::json::parse(ended.out);
  const CsvTable table = CsvTable::read(folder_ / "out/convergence.csv");
  ASSERT_EQ(json.size(), table.size());
  for (std::size_t r = 0; r < table.size(); ++r) {
    ASSERT_EQ(json[r].size(), table.columns().size());
    for (const std::string& column : table.columns()) {
      ASSERT_TRUE(json[r].contains(column)) << column;
      const auto& value = json[r][column];
      if (value.is_null()) {
        EXPECT_EQ(table.text(r, column), "");
      } else if (value.is_string()) {
        EXPECT_EQ(table.text(r, column), value.get<std::string>());
      } else {
        EXPECT_EQ(table.number(r, column), value.get<double>()) << column;
      }
    }
  }
  const auto plan = nlohmann::json::parse(run({"--json", "--dry-run"}).out);
  EXPECT_EQ(plan["cells"], 5);
  EXPECT_EQ(plan["passes"], 3);
  const auto reference = nlohmann::json::parse(command({"reference", "--scene", "mis-toy", "--json"}).out);
  EXPECT_EQ(reference["integrals"][0]["value"], 0.5);
}

TEST_F(Commands, PointsAreRowsOfCoordinates) {
  for (const char* sampler : {"independent", "stratified", "n-rooks", "halton-owen"}) {
    const std::vector<std::string> arguments = {"points", "--sampler", sampler, "--count",     "600", "--dims",
                                                "3",      "--seed",    "7",     "--replicate", "5"};
    const CsvTable f64(command(arguments).out);
    const CsvTable f32(command(arguments + std::vector<std::string>{"--precision", "f32"}).out);
    EXPECT_EQ(f64.columns(), (CsvTable::Row{"x0", "x1", "x2"}));
    EXPECT_EQ(f64.size(), 600u);
    ASSERT_EQ(f32.size(), 600u);
    for (std::size_t i = 0; i < f64.size(); ++i) {
      for (const char* column : {"x0", "x1", "x2"}) {
        const double x = f64.number(i, column), top = f32.number(i, column);
        EXPECT_THAT(x, AllOf(Ge(0), Lt(1)));
        EXPECT_EQ(top, std::floor(x * 0x1p24) * 0x1p-24);  // the top 24 bits
      }
    }
    EXPECT_NE(command(arguments).out, command({"points", "--sampler", sampler, "--count", "600", "--dims", "3"}).out);
  }
}

// A shell's `halfslope points … | head -3`.
TEST_F(Commands, AReaderMayLeaveEarly) {
  const std::string shell = "set -o pipefail; " + kProgram + " points --sampler independent --count 1000000 | head -3";
  ChildOptions bash = options();
  bash.program = "/bin/bash";
  const Ended ended = run_program({"-c", shell}, bash);
  EXPECT_EQ(ended.code, 128 + SIGPIPE);  // the usual end of a writer whose reader left
  EXPECT_EQ(CsvTable(ended.out).size(), 2u);
  EXPECT_THAT(ended.err, IsEmpty());
}

TEST_F(Commands, CompletionIsAShellScript) {
  ChildOptions bash = options();
  bash.program = "/bin/bash";
  const std::string script =
      "source <(" + kProgram + " completion); halfslope() { " + kProgram + " \"$@\"; }; " +
      "COMP_WORDS=(halfslope points --sampler halton-o); COMP_CWORD=3; _halfslope; echo ${COMPREPLY[0]}; "
      "COMP_WORDS=(halfslope ren); COMP_CWORD=1; _halfslope; echo ${COMPREPLY[0]}; "
      "COMP_WORDS=(halfslope run --over); COMP_CWORD=2; _halfslope; echo ${COMPREPLY[0]}; "
      "COMP_WORDS=(halfslope run --measures l2); COMP_CWORD=3; _halfslope; echo ${COMPREPLY[0]}";
  const Ended ended = run_program({"-c", script}, bash);
  EXPECT_EQ(ended.out, "halton-owen\nrender\n--overwrite\nl2-star\n") << ended.err;
}

}  // namespace
}  // namespace halfslope
