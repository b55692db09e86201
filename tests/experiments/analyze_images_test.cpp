// halfslope analyze images, as a child process on folders of EXRs.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "core/exr.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/csv_table.h"

namespace halfslope {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class AnalyzeImages : public CommandLine {
 protected:
  static constexpr int kWidth = 3, kHeight = 2;

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write_image(const std::string& name, const std::vector<float>& r, const std::vector<float>& g,
                   const std::vector<float>& b, int width = kWidth) const {
    fs::create_directories(fs::path(path(name)).parent_path());
    const int height = static_cast<int>(r.size()) / width;
    write_exr(path(name), {width, height, {{"R", r}, {"G", g}, {"B", b}}});
  }
  /// All values equal to `value`.
  void write_flat(const std::string& name, float value) const {
    const std::vector<float> channel(kWidth * kHeight, value);
    write_image(name, channel, channel, channel);
  }
  /// Three seeds of two samplers at two N, each seed with an error of its own against a reference of 1.
  void write_folder() const {
    write_flat("ref.exr", 1);
    for (const std::string sampler : {"a", "b"}) {
      for (const int samples : {4, 16}) {
        for (const int seed : {1, 2, 3}) {
          const float error =
              static_cast<float>(seed) / (sampler == "a" ? 4.f : 8.f) / std::sqrt(static_cast<float>(samples));
          write_flat(image(sampler, samples, seed), 1 + (seed == 2 ? -error : error));
        }
      }
    }
  }
  static std::string image(const std::string& sampler, int samples, int seed) {
    return "out/" + sampler + "/" + std::to_string(samples) + "_" + std::to_string(seed) + ".exr";
  }
  Ended analyze(const std::vector<std::string>& more, const ChildOptions& options = {}) const {
    return run_program(
        std::vector<std::string>{"analyze", "images", "--quiet", "--threads", "1", "--reference", path("ref.exr"),
                                 "--pattern", path("out/{sampler}/{samples}_{seed}.exr"), "--out", path("tables")} +
            more,
        options);
  }
  CsvTable table(const char* name) const { return CsvTable::read(folder_.path() / "tables" / name); }
  /// The row of convergence.csv of a sampler at N.
  std::size_t row(const CsvTable& table, const std::string& sampler, int samples) const {
    for (std::size_t r = 0; r < table.size(); ++r) {
      if (table.text(r, "sampler") == sampler && table.number(r, "samples") == samples) return r;
    }
    throw std::runtime_error("no such row");
  }
};

TEST_F(AnalyzeImages, NumbersAreThoseWorkedByHand) {
  write_folder();
  const Ended ended = analyze({});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const CsvTable cells = table("convergence.csv");
  ASSERT_EQ(cells.size(), 4u);
  // Errors 1/8, −2/8, 3/8 of every value at N = 4: mean 1/12, MSE 14/192; a quarter of it at N = 16, half for b.
  const std::size_t r = row(cells, "a", 4);
  EXPECT_EQ(cells.text(r, "scene"), "image");
  EXPECT_EQ(cells.text(r, "estimator"), "image");
  EXPECT_EQ(cells.text(r, "precision"), "f32");
  EXPECT_EQ(cells.number(r, "replicates"), 3);
  EXPECT_EQ(cells.number(r, "pixels"), 6);
  EXPECT_NEAR(cells.number(r, "bias"), 1.0 / 12, 1e-15);
  EXPECT_NEAR(cells.number(r, "rmse"), std::sqrt(14.0 / 192), 1e-15);
  EXPECT_NEAR(cells.number(r, "mae"), 0.25, 1e-15);
  EXPECT_NEAR(cells.number(r, "variance"), (14.0 / 192 - 1.0 / 144) * 3 / 2, 1e-15);
  EXPECT_NEAR(cells.number(row(cells, "b", 16), "rmse"), std::sqrt(14.0 / 192) / 4, 1e-15);
  EXPECT_EQ(cells.text(r, "status"), "few-replicates");
  const CsvTable replicates = table("replicates.csv");
  ASSERT_EQ(replicates.size(), 12u);
  EXPECT_EQ(replicates.text(0, "replicate"), "1");  // seeds as the names have them
  EXPECT_NEAR(replicates.number(2, "mse"), 9.0 / 64, 1e-15);
  const CsvTable rates = table("rates.csv");
  ASSERT_EQ(rates.size(), 2u);
  EXPECT_NEAR(rates.number(0, "rate"), -0.5, 1e-14);
  const CsvTable metrics = table("metrics.csv");
  EXPECT_EQ(metrics.text(0, "metric"), "mse");
  EXPECT_EQ(metrics.text(0, "version"), "1");
  EXPECT_NEAR(metrics.number(0, "value"), 14.0 / 192, 1e-15);
  EXPECT_EQ(run_program({"figure", "convergence", "--quiet", "--run", path("tables"), "--out", path("f.svg")}).code, 0);
}

TEST_F(AnalyzeImages, EachBadFileIsNamedAndTheRestIsAnalysed) {
  write_folder();
  fs::remove(path(image("a", 4, 2)));                                           // a missing seed
  write_image(image("a", 16, 1), {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}, 2);  // a wrong size
  const std::vector<float> flat(6, 1.f);
  std::vector<float> broken = flat;
  broken[4] = std::numeric_limits<float>::quiet_NaN();
  write_image(image("b", 4, 3), flat, broken, flat);                                      // a NaN pixel
  fs::resize_file(path(image("b", 16, 2)), fs::file_size(path(image("b", 16, 2))) - 20);  // truncated
  const Ended ended = analyze({});
  EXPECT_EQ(ended.code, 3);
  EXPECT_THAT(ended.err,
              HasSubstr(image("a", 4, 2) + ": is missing: N = 4 of estimator image, sampler a lacks seed 2"));
  EXPECT_THAT(ended.err, HasSubstr(image("a", 16, 1) + ": has 2 x 2 pixels, and the reference 3 x 2"));
  EXPECT_THAT(ended.err,
              HasSubstr(image("b", 4, 3) + ": 1 of 18 values are not finite (1 NaN, 0 infinite), the first at "
                                           "pixel (1, 1), channel G"));
  EXPECT_THAT(ended.err, HasSubstr(image("b", 16, 2) + ": cannot be read as an image"));
  EXPECT_THAT(ended.err, Not(HasSubstr(image("b", 16, 1))));

  const CsvTable cells = table("convergence.csv");
  EXPECT_EQ(cells.number(row(cells, "a", 4), "replicates"), 2);
  EXPECT_NEAR(cells.number(row(cells, "a", 4), "rmse"), std::sqrt((1.0 + 9) / 64 / 2), 1e-15);
  EXPECT_EQ(cells.number(row(cells, "a", 16), "replicates"), 2);
  const std::size_t invalid = row(cells, "b", 4);
  EXPECT_EQ(cells.number(invalid, "replicates"), 3);  // counted, not dropped
  EXPECT_EQ(cells.number(invalid, "nonfinite"), 1);
  EXPECT_EQ(cells.text(invalid, "rmse"), "");
  EXPECT_THAT(cells.text(invalid, "status"), HasSubstr("invalid"));
  EXPECT_EQ(cells.number(row(cells, "b", 16), "replicates"), 2);
  const std::string manifest = read_file(path("tables/manifest.json"));
  EXPECT_THAT(manifest,
              AllOf(HasSubstr("\"first_seed\": 3"), HasSubstr("\"first_pixel\": 4"), HasSubstr("is missing")));

  const Ended again = analyze({"--keep-going"});
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.err.substr(0, 300), ended.err.substr(0, 300));  // named all the same
}

// Of seeds 1, 2, 3 both N have 1 and 3 alone: the ratio of their errors is 2 at those, whatever seed 2 is.
TEST_F(AnalyzeImages, TheReferenceAmongTheImagesIsNotMeasuredAgainstItself) {
  write_folder();
  write_flat("out/a/64_1.exr", 1);
  const Ended ended = run_program({"analyze", "images", "--reference", path("out/a/64_1.exr"), "--pattern",
                                   path("out/{sampler}/{samples}_{seed}.exr"), "--out", path("tables")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("out/a/64_1.exr: is the reference, so not measured"));
  EXPECT_EQ(table("convergence.csv").size(), 4u);
  write_flat("only/4.exr", 1);
  const Ended itself = run_program({"analyze", "images", "--reference", path("only/4.exr"), "--pattern",
                                    path("only/{samples}.exr"), "--out", path("none")});
  EXPECT_EQ(itself.code, 3);
  EXPECT_THAT(itself.err, HasSubstr("only/4.exr: is the reference, so not measured"));
  const Ended twice = run_program({"analyze", "images", "--reference-halves", path("ref.exr"), path("ref.exr"),
                                   "--pattern", path("out/{sampler}/{samples}_{seed}.exr"), "--out", path("tables")});
  EXPECT_EQ(twice.code, 3);
  EXPECT_THAT(twice.err, HasSubstr("two independent images are needed"));
}

TEST_F(AnalyzeImages, ARunDoesNotReplaceAnAnalysisUnasked) {
  write_folder();
  ASSERT_EQ(analyze({}).code, 0);
  std::vector<std::string> run = {"run", "--scene",    "bilinear",    "--samples", "4",     "--replicates",
                                  "2",   "--samplers", "independent", "--quiet",   "--out", path("tables")};
  const Ended refused = run_program(run);
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("holds an analysis of images"));
  EXPECT_EQ(table("convergence.csv").size(), 4u);
  run.push_back("--overwrite");
  EXPECT_EQ(run_program(run).code, 0);
  EXPECT_FALSE(fs::exists(path("tables/metrics.csv")));
}

TEST_F(AnalyzeImages, RatesPairTheSeedsInCommon) {
  write_folder();
  write_flat(image("a", 16, 2), 100);
  fs::remove(path(image("a", 4, 2)));
  EXPECT_EQ(analyze({}).code, 3);
  const CsvTable rates = table("rates.csv");
  EXPECT_EQ(rates.text(0, "sampler"), "a");
  EXPECT_NEAR(rates.number(0, "rate"), -0.5, 1e-14);
  EXPECT_GT(table("convergence.csv").number(1, "rmse"), 50);
}

TEST_F(AnalyzeImages, TheReferencesVarianceIsSubtractedWhereItIsKnownAndElseSaidToBeUnknown) {
  write_folder();
  const std::string unknown = run_program({"analyze", "images", "--reference", path("ref.exr"), "--pattern",
                                           path("out/{sampler}/{samples}_{seed}.exr"), "--out", path("tables")})
                                  .out;
  EXPECT_THAT(unknown, HasSubstr("its own variance is not known and taken as 0"));
  EXPECT_EQ(table("convergence.csv").text(0, "reference_se"), "");
  EXPECT_EQ(table("convergence.csv").text(0, "reference_mse"), "");
  const std::vector<float> one(6, 1.f), variance(6, 0.0078125f);
  write_exr(path("ref.exr"), {3,
                              2,
                              {{"R", one},
                               {"G", one},
                               {"B", one},
                               {"variance.R", variance},
                               {"variance.G", variance},
                               {"variance.B", variance}}});
  ASSERT_EQ(analyze({}).code, 0);
  const CsvTable cells = table("convergence.csv");
  EXPECT_EQ(cells.number(row(cells, "a", 4), "reference_mse"), 0.0078125);
  EXPECT_NEAR(cells.number(row(cells, "a", 4), "rmse"), std::sqrt(14.0 / 192 - 0.0078125), 1e-15);
}

// Halves 1 ± 1/4: the reference is 1 with variance 1/16, and each image's (Î − A)(Î − B) is e² − 1/16.
TEST_F(AnalyzeImages, HalvesGiveAReferenceItsVarianceAndTheProductOfErrors) {
  write_folder();
  fs::rename(path("ref.exr"), path("old.exr"));
  write_flat("a.exr", 1.25f);
  write_flat("b.exr", 0.75f);
  const Ended ended = run_program({"analyze", "images", "--quiet", "--reference-halves", path("a.exr"), path("b.exr"),
                                   "--pattern", path("out/{sampler}/{samples}_{seed}.exr"), "--out", path("tables")});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const CsvTable cells = table("convergence.csv"), metrics = table("metrics.csv");
  EXPECT_EQ(cells.number(0, "reference"), 1);
  EXPECT_EQ(cells.number(0, "reference_mse"), 0.0625);
  bool found = false;
  for (std::size_t r = 0; r < metrics.size(); ++r) {
    if (metrics.text(r, "metric") != "half-buffer-mse" || metrics.text(r, "sampler") != "a") continue;
    const double mse = 14.0 / 192 / (metrics.number(r, "samples") / 4);
    EXPECT_NEAR(metrics.number(r, "value"), mse - 0.0625, 1e-15);
    found = true;
  }
  EXPECT_TRUE(found);
}

TEST_F(AnalyzeImages, EachSceneHasItsOwnReferenceAndOneThatIsMissingSparesTheOthers) {
  for (const std::string scene : {"one", "two"}) {
    for (const int seed : {1, 2}) write_flat("in/" + scene + "/4_" + std::to_string(seed) + ".exr", 3);
  }
  write_flat("refs/one.exr", 2);
  const auto command = [&] {
    return run_program({"analyze", "images", "--quiet", "--reference", path("refs/{scene}.exr"), "--pattern",
                        path("in/{scene}/{samples}_{seed}.exr"), "--out", path("tables")});
  };
  const Ended ended = command();
  EXPECT_EQ(ended.code, 3);
  EXPECT_THAT(ended.err, HasSubstr("refs/two.exr: cannot be read"));
  EXPECT_EQ(table("convergence.csv").size(), 1u);
  write_flat("refs/two.exr", 3);
  EXPECT_EQ(command().code, 0);
  const CsvTable cells = table("convergence.csv");
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells.number(0, "rmse"), 1);
  EXPECT_EQ(cells.number(1, "rmse"), 0);
  EXPECT_THAT(cells.text(1, "status"), HasSubstr("exact"));
}

TEST_F(AnalyzeImages, ALayerIsChosenByItsName) {
  const std::vector<float> one(6, 1.f), two(6, 2.f);
  write_exr(path("ref.exr"), {3, 2, {{"Y", one}}});
  fs::create_directories(path("out/a"));
  for (const char* name : {"out/a/4_1.exr", "out/a/4_2.exr"})
    write_exr(path(name), {3, 2, {{"albedo.Y", one}, {"beauty.Y", two}, {"Z", one}}});
  EXPECT_THAT(analyze({}).err, AllOf(HasSubstr("choose a layer with --layer: albedo, beauty")));
  EXPECT_THAT(analyze({"--layer", "beuty"}).err, HasSubstr("did you mean 'beauty'?"));
  ASSERT_EQ(analyze({"--layer", "beauty"}).code, 0);
  EXPECT_EQ(table("convergence.csv").number(0, "rmse"), 1);
}

TEST_F(AnalyzeImages, WhatCannotBeAskedIsRefused) {
  write_folder();
  EXPECT_EQ(run_program({"analyze"}).code, 2);
  EXPECT_EQ(run_program({"analyze", "images", "--pattern", path("{samples}.exr")}).code, 2);
  EXPECT_EQ(run_program({"analyze", "images", "--reference", "{scene}.exr", "--pattern", "{samples}.exr"}).code, 2);
  EXPECT_EQ(analyze({"--pattern", path("nowhere/{samples}.exr")}).code, 2);  // given twice
  fs::create_directories(path("tables"));
  write("tables/journal", "x");
  const Ended ended = analyze({});
  EXPECT_EQ(ended.code, 3);
  EXPECT_THAT(ended.err, HasSubstr("holds the results of a run"));
}

// Broken and odd files, as an image and as the reference, in 256 MiB of address space: nothing crashes.
TEST_F(AnalyzeImages, HostileFilesNeverCrashNorTakeMuchMemory) {
  const fs::path hostile = fs::path(HALFSLOPE_SOURCE_DIR) / "tests/data/hostile_exr";
  fs::create_directories(path("out/a"));
  int files = 0, read = 0;
  for (const auto& entry : fs::directory_iterator(hostile)) {
    const std::string name = entry.path().filename().string();
    fs::copy_file(hostile / "00_valid_4x4.exr", path("ref.exr"), fs::copy_options::overwrite_existing);
    fs::copy_file(entry.path(), path("out/a/4_1.exr"), fs::copy_options::overwrite_existing);
    const Ended as_image = analyze({}, {.address_space = 256 << 20});
    EXPECT_TRUE(as_image.code == 0 || as_image.code == 3) << name << " " << as_image.code << as_image.err;
    EXPECT_EQ(as_image.err.empty(), as_image.code == 0) << name << as_image.err;
    EXPECT_THAT(as_image.err, Not(HasSubstr("memory;"))) << name;
    fs::copy_file(hostile / "00_valid_4x4.exr", path("out/a/4_1.exr"), fs::copy_options::overwrite_existing);
    fs::copy_file(entry.path(), path("ref.exr"), fs::copy_options::overwrite_existing);
    const Ended as_reference = analyze({}, {.address_space = 256 << 20});
    EXPECT_TRUE(as_reference.code == 0 || as_reference.code == 3) << name << " " << as_reference.code;
    EXPECT_THAT(as_reference.err, Not(HasSubstr("memory;"))) << name;
    ++files;
    read += as_image.code == 0;
  }
  EXPECT_GE(files, 17);
  EXPECT_GE(read, 2);  // the whole one, and denormals
}

TEST_F(AnalyzeImages, AHalfThatOverflowedIsNamedAsOne) {
  const fs::path hostile = fs::path(HALFSLOPE_SOURCE_DIR) / "tests/data/hostile_exr";
  fs::create_directories(path("out/a"));
  fs::copy_file(hostile / "00_valid_4x4.exr", path("ref.exr"));
  fs::copy_file(hostile / "16_inf_half_overflow.exr", path("out/a/4_1.exr"));
  fs::copy_file(hostile / "00_valid_4x4.exr", path("out/a/16_1.exr"));
  const Ended ended = analyze({});
  EXPECT_EQ(ended.code, 3);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("infinite: its numbers are halves, which end at 65504"),
                               HasSubstr("first at pixel (0, 0), channel R")));
  EXPECT_EQ(table("convergence.csv").size(), 2u);
}

// The same replicates as EXRs: what differs is the rounding to binary32 of images and reference, 2^-24 of each value.
// An error e of values up to ~10 then moves by 1e-6, and so do the root mean squares of errors of some 0.5.
TEST_F(AnalyzeImages, ImagesOfARunGiveTheTablesOfTheRun) {
  const std::vector<std::string> scene = {"--scene", "veach-mis", "--resolution", "12,8"};
  ASSERT_EQ(run(scene + std::vector<std::string>{"--estimators", "light,balance", "--samplers", "halton-owen",
                                                 "--samples", "4,16", "--replicates", "4", "--images", "16"})
                .code,
            0);
  for (const std::string estimator : {"light", "balance"}) {
    fs::create_directories(path("in/veach-mis/" + estimator));
    for (const std::string samples : {"4", "16"}) {
      for (const std::string k : {"0", "1", "2", "3"}) {
        ASSERT_EQ(command(std::vector<std::string>{
                              "render", "--quiet", "--estimator", estimator, "--samples", samples, "--replicate", k,
                              "--out", path("in/veach-mis/" + estimator + "/" + samples + "_" + k + ".exr")} +
                          scene)
                      .code,
                  0);
      }
    }
  }
  const Ended ended = run_program({"analyze", "images", "--quiet", "--reference", out() + "/reference.exr", "--pattern",
                                   path("in/{scene}/{estimator}/{samples}_{seed}.exr"), "--out", path("tables")});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const CsvTable ours = CsvTable::read(fs::path(out()) / "convergence.csv"), theirs = table("convergence.csv");
  ASSERT_EQ(ours.size(), 4u);
  ASSERT_EQ(theirs.size(), 4u);
  int compared = 0;
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t t = 0; t < 4; ++t) {
      if (ours.text(r, "estimator") != theirs.text(t, "estimator") ||
          ours.text(r, "samples") != theirs.text(t, "samples"))
        continue;
      for (const char* column :
           {"mean", "reference", "reference_mse", "bias", "variance", "rmse", "mae", "relmse", "kurtosis"})
        EXPECT_NEAR(ours.number(r, column), theirs.number(t, column), 4e-6 * (1 + std::abs(ours.number(r, column))))
            << column;
      EXPECT_EQ(ours.text(r, "status"), theirs.text(t, "status"));
      ++compared;
    }
  }
  EXPECT_EQ(compared, 4);
}

}  // namespace
}  // namespace halfslope
