// The bytes of a run are a function of its experiment alone: not of threads, instruction sets of one class, caches, or
// of what else is measured beside.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/exr.h"
#include "core/kernel_library.h"
#include "experiments/plan.h"
#include "tests/experiments/csv_table.h"
#include "tests/experiments/program.h"
#include "tests/experiments/run_files.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using Files = std::map<std::string, std::string>;
using Flags = std::map<std::string, std::string>;  ///< "--seed" → "1"; an empty value is a flag without one

/// A rendered scene of two tiles and an analytic one, every built-in sampler and heuristic, both precisions, images.
const Flags kMixed = {{"--scene", "veach-mis,aligned-phong-cap:n=100,alpha=0.3"},
                      {"--resolution", "20,14"},
                      {"--samplers", "independent,stratified,n-rooks,halton-owen"},
                      {"--samples", "4,16"},
                      {"--images", "16"},
                      {"--replicates", "24"},
                      {"--precision", "f32,f64"}};
/// A picture small enough to run in a tenth of a second.
const Flags kPicture = {{"--scene", "veach-mis"},
                        {"--resolution", "24,16"},
                        {"--estimators", "light,bsdf,average,balance,power"},
                        {"--samplers", "independent,stratified,n-rooks,halton-owen"},
                        {"--samples", "4:16"},
                        {"--replicates", "16"}};

Flags with(Flags flags, const Flags& others) {
  for (const auto& [name, value] : others) flags[name] = value;
  return flags;
}

class Determinism : public ::testing::Test {
 protected:
  Files run(const std::string& out, const Flags& flags, std::map<std::string, std::string> environment = {}) {
    environment.try_emplace("HALFSLOPE_CACHE", (folder_ / "cache").string());
    std::vector<std::string> arguments = {"run", "--quiet", "--out", (folder_ / out.c_str()).string()};
    for (const auto& [name, value] : flags) {
      arguments.push_back(name);
      if (!value.empty()) arguments.push_back(value);
    }
    const Ended ended = run_program(arguments, {.environment = environment});
    EXPECT_EQ(ended.code, 0) << ended.err;
    return run_files(folder_ / out.c_str());
  }
  CsvTable table(const std::string& out, const char* file) { return CsvTable::read(folder_ / out.c_str() / file); }

  const TemporaryFolder folder_;
};

TEST_F(Determinism, ThreadsChangeNothing) {
  const Files one = run("1", with(kMixed, {{"--threads", "1"}}));
  EXPECT_EQ(one.size(), 7 + 1 + 5u * 4 * 2 * 2);  // tables, reference.exr, a picture for each cell at N = 16
  for (const std::string threads : {"2", "7"}) {
    // A reference of its own too: the cache would hide a difference.
    const Files more = run(threads, with(kMixed, {{"--threads", threads}}),
                           {{"HALFSLOPE_CACHE", (folder_ / "cache").string() + threads}});
    expect_same_files(one, more, threads + " threads");
  }
  // Replicates beyond one unit's are merged.
  const Flags batches = {
      {"--scene", "mis-toy"}, {"--samplers", "independent"}, {"--samples", "4:16"}, {"--replicates", "6000"}};
  const Files alone = run("b1", with(batches, {{"--threads", "1"}}));
  EXPECT_EQ(alone.size(), 6u);
  expect_same_files(alone, run("b2", with(batches, {{"--threads", "2"}})), "batches on 2 threads");
}

TEST_F(Determinism, Avx2AndAvx512AreTheSameBits) {
  const auto isas = supported_isas();
  if (std::find(isas.begin(), isas.end(), Isa::kAvx512) == isas.end()) GTEST_SKIP() << "no AVX-512 here";
  for (const char* scenes : {"veach-mis,aligned-phong-cap:n=100,alpha=0.3,mis-toy", "quartergaussian,quarterdisk"}) {
    std::vector<Files> files;
    for (const std::string isa : {"avx2", "avx512"}) {
      files.push_back(run(isa + std::string(scenes).substr(0, 5), with(kMixed, {{"--scene", scenes}}),
                          {{"HALFSLOPE_ISA", isa}, {"HALFSLOPE_CACHE", (folder_ / "cache").string() + isa}}));
    }
    expect_same_files(files[0], files[1], scenes);
  }
}

TEST_F(Determinism, RowsStandInTheOrderOfTheExperiment) {
  run("out", {{"--scene", "mis-toy,aligned-phong-cap:n=1,alpha=1"},
              {"--precision", "f64,f32"},
              {"--estimators", "power,light,balance"},
              {"--samplers", "n-rooks,independent"},
              {"--samples", "8,2,4"},
              {"--replicates", "3"}});
  const CsvTable cells = table("out", "convergence.csv"), replicates = table("out", "replicates.csv");
  std::size_t r = 0;
  for (const char* scene : {"mis-toy", "aligned-phong-cap:n=1,alpha=1"}) {
    for (const char* precision : {"f64", "f32"}) {
      for (const char* estimator : {"power", "light", "balance"}) {
        for (const char* sampler : {"n-rooks", "independent"}) {
          for (const char* samples : {"2", "4", "8"}) {
            const CsvTable::Row key = {scene, estimator, sampler, precision, samples};
            for (std::size_t k = 0; k < 3; ++k) {
              CsvTable::Row expected = key;
              expected.push_back(std::to_string(k));
              const CsvTable::Row& row = replicates.row(3 * r + k);
              EXPECT_EQ(CsvTable::Row(row.begin(), row.begin() + 6), expected);
            }
            const CsvTable::Row& row = cells.row(r++);
            EXPECT_EQ(CsvTable::Row(row.begin(), row.begin() + 5), key);
          }
        }
      }
    }
  }
  EXPECT_EQ(cells.size(), r);
  EXPECT_EQ(replicates.size(), 3 * r);
}

TEST_F(Determinism, WhatIsMeasuredBesideChangesNoRow) {
  run("all", kPicture);
  const Flags fewer = with(kPicture, {{"--estimators", "power,bsdf"}, {"--samplers", "halton-owen,n-rooks"}});
  run("fewer", fewer);
  // Pictures, another precision, and heuristics that share their samples are no part of a cell's numbers either.
  run("more",
      with(fewer, {{"--estimators", "power,bsdf,power:3,average"}, {"--images", "4,16"}, {"--precision", "f32,f64"}}));
  for (const auto& [file, size] : {std::pair("convergence.csv", 12u), std::pair("replicates.csv", 192u),
                                   std::pair("rates.csv", 4u), std::pair("regions.csv", 0u)}) {
    const CsvTable all = table("all", file), some = table("fewer", file), more = table("more", file);
    const auto rows = [](const CsvTable& t) {
      std::set<CsvTable::Row> set;
      for (std::size_t r = 0; r < t.size(); ++r) set.insert(t.row(r));
      return set;
    };
    const auto in_all = rows(all), in_more = rows(more);
    EXPECT_TRUE(size > 0 ? some.size() == size : some.size() > 0) << file << " has " << some.size() << " rows";
    for (std::size_t r = 0; r < some.size(); ++r) {
      EXPECT_TRUE(in_all.contains(some.row(r))) << file << ", row " << r << " differs from the full run's";
      EXPECT_TRUE(in_more.contains(some.row(r))) << file << ", row " << r << " differs from the larger run's";
    }
  }
}

TEST_F(Determinism, TheCacheOfReferencesChangesNothing) {
  const Flags flags = with(kPicture, {{"--estimators", "balance"}, {"--samplers", "independent"}});
  const Files fresh = run("fresh", flags);
  const auto entries = std::filesystem::directory_iterator(folder_ / "cache");
  ASSERT_NE(entries, std::filesystem::directory_iterator());
  expect_same_files(fresh, run("cached", flags), "a cached reference");
  expect_same_files(fresh, run("none", flags, {{"HALFSLOPE_CACHE", ""}}), "no cache");
  expect_same_files(fresh, run("bad", flags, {{"HALFSLOPE_CACHE", "/dev/null/x"}}), "a cache that cannot be");
  // Damage in each of its files, at the beginning, amidst and at the end.
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache")) {
    std::string bytes = read_file(entry.path());
    bytes[std::array{std::size_t{3}, bytes.size() / 2, bytes.size() - 1}[static_cast<std::size_t>(files++ % 3)]] ^= 4;
    write_file_atomically(entry.path(), bytes);
  }
  expect_same_files(fresh, run("damaged", flags), "a damaged cache");
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache"))
    std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) / 2);
  expect_same_files(fresh, run("torn", flags), "a torn cache");
}

// The pixels that `pixels = 50` chooses are measured as in the full image: their estimates are those of `render`, which
// renders every pixel.
TEST_F(Determinism, AChoiceOfPixelsIsPartOfTheImage) {
  const Flags flags = with(kPicture, {{"--estimators", "balance"},
                                      {"--samplers", "stratified"},
                                      {"--samples", "16"},
                                      {"--replicates", "3"},
                                      {"--pixels", "50"},
                                      {"--seed", "11"}});
  const Files files = run("a", flags);
  expect_same_files(files, run("b", with(flags, {{"--threads", "1"}})), "once more");
  Spec spec;
  for (const auto& [flag, value] : flags) apply_flag(spec, flag.substr(2), value);
  const Plan plan = make_plan(spec, Catalogue::built_in());
  const std::vector<int>& pixels = plan.scenes[0].pixels;
  ASSERT_EQ(pixels.size(), 50u);
  const CsvTable replicates = table("a", "replicates.csv");
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string image = (folder_ / "image.exr").string();
    const Ended ended = run_program({"render", "--quiet", "--scene", "veach-mis", "--resolution", "24x16",
                                     "--estimator", "balance", "--sampler", "stratified", "--samples", "16", "--seed",
                                     "11", "--replicate", std::to_string(k), "--out", image});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const ExrImage rendered = read_exr(image);
    ASSERT_EQ(rendered.channels.size(), 3u);
    double sum = 0;
    for (const int pixel : pixels) {
      for (const auto& channel : rendered.channels) sum += channel.values[static_cast<std::size_t>(pixel)];
    }
    // Binary32 pixels: 6e-8 of a sum of positive numbers.
    EXPECT_NEAR(replicates.number(k, "mean"), sum / 150, 1e-7 * sum / 150);
  }
}

// A processor without AVX-512, and one without AVX, by emulation: the dispatch must choose what they can run.
class Emulated : public Determinism {
 protected:
  Ended run_on(const std::string& processor, const std::string& out) {
    return run_program(
        {"run", "--quiet", "--out", (folder_ / out.c_str()).string(), "--scene",
         "quarterdisk,quartergaussian,aligned-phong-cap:n=100,alpha=0.3", "--samplers", "independent,halton-owen",
         "--samples", "64", "--replicates", "16"},
        {.environment = {{"HALFSLOPE_ISA", ""}},
         .launcher = processor.empty() ? std::vector<std::string>{}
                                       : std::vector<std::string>{"/usr/bin/qemu-x86_64", "-cpu", processor}});
  }
  bool isa_is(const std::string& out, const std::string& isa) {
    const std::string manifest = read_file(folder_ / out.c_str() / "manifest.json");
    return manifest.find("\"isa\": \"" + isa + "\"") != std::string::npos;
  }
};

TEST_F(Emulated, OlderProcessorsRunTheirOwnKernels) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the emulator has no room for AddressSanitizer's shadow memory";
#endif
  if (!std::filesystem::exists("/usr/bin/qemu-x86_64")) GTEST_SKIP() << "no qemu-x86_64 (Debian: qemu-user)";
  ASSERT_EQ(run_on("", "native").code, 0);
  const Ended haswell = run_on("Haswell", "haswell"), nehalem = run_on("Nehalem", "nehalem");
  ASSERT_EQ(haswell.code, 0) << haswell.err;
  ASSERT_EQ(nehalem.code, 0) << nehalem.err;
  EXPECT_TRUE(isa_is("haswell", "avx2"));
  EXPECT_TRUE(isa_is("nehalem", "baseline"));
  if (isa_is("native", "avx2") || isa_is("native", "avx512"))
    expect_same_files(run_files(folder_ / "native"), run_files(folder_ / "haswell"), "an emulated Haswell");
  // Without fused multiply-adds the last bits differ, and no more.
  const CsvTable native = table("native", "convergence.csv"), old = table("nehalem", "convergence.csv");
  ASSERT_EQ(native.size(), old.size());
  for (std::size_t r = 0; r < native.size(); ++r) {
    for (const char* column : {"mean", "rmse", "variance", "mae"})
      EXPECT_NEAR(old.number(r, column), native.number(r, column), 1e-4 * native.number(r, column)) << column;
  }
}

}  // namespace
}  // namespace halfslope
