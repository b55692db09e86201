// A downstream program (tests/consumer) whose sampler and scenes halfslope does not know, one of them not a number.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "tests/experiments/csv_table.h"
#include "tests/experiments/program.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class Consumer : public ::testing::Test {
 protected:
  Ended run(const char* out, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run",       "--quiet",     "--out",        (folder_ / out).string(),
                                          "--samples", "4,8,64,1024", "--replicates", "24"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return consumer(arguments);
  }
  Ended consumer(const std::vector<std::string>& arguments) const {
    return run_program(arguments, {.environment = {{"HALFSLOPE_CACHE", (folder_ / "cache").string()}},
                                   .program = HALFSLOPE_BINARY_DIR "/consumer"});
  }
  CsvTable table(const char* out, const char* file) const { return CsvTable::read(folder_ / out / file); }

  const TemporaryFolder folder_;
};

/// Rows of the scene, or of all but it.
std::vector<CsvTable::Row> rows_of(const CsvTable& table, const std::string& scene, bool others = false) {
  std::vector<CsvTable::Row> rows;
  for (std::size_t r = 0; r < table.size(); ++r) {
    if ((table.text(r, "scene") == scene) != others) rows.push_back(table.row(r));
  }
  return rows;
}

TEST_F(Consumer, ItsNamesAreListedAndOffered) {
  EXPECT_THAT(consumer({"list"}).out, HasSubstr("additive recurrence in two dimensions"));
  EXPECT_THAT(consumer({"list", "scenes", "--names"}).out, HasSubstr("\ntorn-ridge\n"));
  EXPECT_THAT(consumer({"points", "--sampler", "r22"}).err, HasSubstr("did you mean 'r2'?"));
  EXPECT_THAT(run("out", {"--scene", "rigde", "--samplers", "r2"}).err, HasSubstr("did you mean 'ridge'?"));
}

TEST_F(Consumer, ItsHeuristicIsThePowerHeuristicWithOneHalf) {
  const Ended ended =
      run("out", {"--scene", "aligned-phong-cap:n=10,alpha=0.2,one-ridge", "--samplers", "independent", "--estimators",
                  "root,power:0.5,root@light*3+bsdf,power:0.5@light*3+bsdf,mean", "--precision", "f64"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const CsvTable cells = table("out", "convergence.csv");
  ASSERT_EQ(cells.size(), 4u * 4 + 4);
  for (std::size_t r = 0; r < 16; ++r) {
    if (!cells.text(r, "estimator").starts_with("root")) continue;
    EXPECT_NEAR(cells.number(r, "rmse") / cells.number(r + 4, "rmse"), 1, 1e-12);
  }
}

/// The examples of CONTRIBUTING.md are this program's own files.
TEST_F(Consumer, TheWorkedExamplesAreCompiled) {
  const std::string page = read_file(HALFSLOPE_SOURCE_DIR "/CONTRIBUTING.md");
  for (const std::string file : {"r2_sampler.h", "root_heuristic.h", "ridge_scene.h"}) {
    const std::string text = read_file(HALFSLOPE_SOURCE_DIR "/tests/consumer/" + file);
    EXPECT_THAT(page, HasSubstr("```cpp\n" + text + "```\n")) << file;
    EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 30) << file;
  }
}

TEST_F(Consumer, ItsSamplerConvergesOnItsScene) {
  const Ended ended = run("out", {"--scene", "ridge", "--samplers", "independent,r2", "--precision", "f64"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const CsvTable cells = table("out", "convergence.csv"), rates = table("out", "rates.csv");
  ASSERT_EQ(cells.size(), 8u);
  for (std::size_t r = 0; r < cells.size(); ++r) {
    EXPECT_EQ(cells.text(r, "pixels"), "4");
    EXPECT_EQ(cells.number(r, "reference"), 1.0 / 3);
    // Five standard errors: false alarm below 1e-6 each for independent points, whose 4 × 24 estimates are independent.
    EXPECT_LT(std::fabs(cells.number(r, "bias")), 5 * cells.number(r, "bias_se"));
  }
  // Var|x − y| = 1/6 − 1/9 = 1/18. Pixels and replicates give 96 estimates; 5 standard errors of their variance.
  EXPECT_NEAR(cells.number(0, "variance"), 1.0 / 18 / 4, 5 * (1.0 / 18 / 4) * std::sqrt(2.0 / 92));
  EXPECT_LT(cells.number(7, "rmse"), cells.number(3, "rmse") / 4);
  EXPECT_LT(rates.number(1, "rate"), -0.65);  // its discrepancy falls like 1/N but for logarithms
  EXPECT_THAT(rates.text(1, "theory"), IsEmpty());
}

TEST_F(Consumer, WhatIsNotANumberInvalidatesItsCellsAndNoOthers) {
  const std::string samplers = "halton-owen,r2";
  const Ended torn =
      run("torn", {"--scene", "ridge,torn-ridge,mis-toy", "--samplers", samplers, "--estimators", "mean"});
  EXPECT_EQ(torn.code, 1);
  EXPECT_EQ(table("torn", "convergence.csv").size(), 16u);
  const Ended ended = run("out", {"--scene", "ridge,torn-ridge,quarterdisk", "--samplers", samplers, "--seed", "9"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("of 24 cells are invalid"));
  EXPECT_THAT(ended.err, HasSubstr((folder_ / "out/manifest.json").string()));
  ASSERT_EQ(run("whole", {"--scene", "ridge,quarterdisk", "--samplers", samplers, "--seed", "9"}).code, 0);
  for (const char* file : {"convergence.csv", "replicates.csv", "rates.csv"}) {
    const CsvTable with = table("out", file), without = table("whole", file);
    EXPECT_EQ(rows_of(with, "torn-ridge", true), rows_of(without, "torn-ridge", true)) << file;
  }

  // Which estimates are torn, by the points themselves: in pixels 1 to 3, from the first x < 0.001 on.
  std::map<std::pair<std::string, std::string>, nlohmann::json> expected;
  for (const std::string sampler : {"halton-owen", "r2"}) {
    for (std::uint64_t k = 0; k < 24; ++k) {
      for (std::uint64_t p = 1; p < 4; ++p) {
        const CsvTable points(consumer({"points", "--sampler", sampler, "--count", "1024", "--seed", "9", "--precision",
                                        "f32", "--replicate", std::to_string(k), "--pixel", std::to_string(p)})
                                  .out);
        std::size_t first = 0;
        while (first < points.size() && points.number(first, "x0") >= 0.001) ++first;
        for (const std::size_t n : {4u, 8u, 64u, 1024u}) {
          if (first >= n) continue;
          nlohmann::json& cell = expected[{sampler, std::to_string(n)}];
          if (cell.is_null()) {
            cell = {{"cell", "torn-ridge,mean," + sampler + ",f32," + std::to_string(n)},
                    {"nonfinite", 0},
                    {"first_replicate", k},
                    {"first_pixel", p},
                    {"seed", 9}};
          }
          cell["nonfinite"] = cell["nonfinite"].get<int>() + 1;
        }
      }
    }
  }
  ASSERT_GT(expected.size(), 2u);
  ASSERT_LT(expected.size(), 8u);
  const auto manifest = nlohmann::json::parse(read_file(folder_ / "out/manifest.json"));
  EXPECT_EQ(manifest["invalid"].size(), expected.size());
  const CsvTable cells = table("out", "convergence.csv");
  for (std::size_t r = 0; r < cells.size(); ++r) {
    if (cells.text(r, "scene") != "torn-ridge") continue;
    const auto cell = expected.find({cells.text(r, "sampler"), cells.text(r, "samples")});
    if (cell == expected.end()) {
      EXPECT_EQ(cells.text(r, "nonfinite"), "0");
      EXPECT_EQ(cells.text(r, "status"), "ok");
      EXPECT_GT(cells.number(r, "rmse"), 0);
      continue;
    }
    EXPECT_THAT(manifest["invalid"], ::testing::Contains(cell->second));
    EXPECT_EQ(cells.text(r, "nonfinite"), cell->second["nonfinite"].dump());
    EXPECT_THAT(cells.text(r, "status"), StartsWith("invalid"));
    // Neither dropped nor zeroed: there is no mean, and no error.
    for (const char* column : {"mean", "bias", "bias_se", "variance", "rmse", "rmse_lo", "rmse_hi", "mae", "relmse"})
      EXPECT_THAT(cells.text(r, column), IsEmpty()) << column;
  }
  const CsvTable rates = table("out", "rates.csv");
  for (std::size_t r = 0; r < rates.size(); ++r) {
    if (rates.text(r, "scene") != "torn-ridge") continue;
    EXPECT_THAT(rates.text(r, "status"), StartsWith("invalid"));
    EXPECT_THAT(rates.text(r, "rate"), IsEmpty());
  }
}

TEST_F(Consumer, AReferenceThatIsNotANumberInvalidatesItsScene) {
  const Ended ended = run("out", {"--scene", "lost-ridge,ridge", "--samplers", "r2"});
  EXPECT_EQ(ended.code, 1) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("4 of 8 cells are invalid"));
  const CsvTable cells = table("out", "convergence.csv");
  for (std::size_t r = 0; r < cells.size(); ++r) {
    const bool lost = cells.text(r, "scene") == "lost-ridge";
    EXPECT_EQ(cells.text(r, "status").starts_with("invalid"), lost);
    EXPECT_EQ(cells.text(r, "reference").empty(), lost);
    EXPECT_EQ(cells.text(r, "rmse").empty(), lost);
  }
  const auto manifest = nlohmann::json::parse(read_file(folder_ / "out/manifest.json"));
  EXPECT_EQ(manifest["references"][0]["first_nonfinite_pixel"], 1);
  EXPECT_FALSE(manifest["references"][1].contains("first_nonfinite_pixel"));
  const Ended reference = consumer({"reference", "--scene", "lost-ridge", "--samples", "1024"});
  EXPECT_EQ(reference.code, 1);
  EXPECT_THAT(reference.err, HasSubstr("scene 'lost-ridge': the reference is not finite, first at pixel 1"));
}

}  // namespace
}  // namespace halfslope
