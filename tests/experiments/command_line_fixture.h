// Short runs of the program, and how they may fail.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "tests/experiments/program.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {

inline std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class CommandLine : public ::testing::Test {
 protected:
  ChildOptions options() const { return {.environment = {{"HALFSLOPE_CACHE", (folder_ / "cache").string()}}}; }
  std::string out() const { return (folder_ / "out").string(); }
  /// A run of some milliseconds that goes well, changed or spoilt by `more` flags.
  Ended run(const std::vector<std::string>& more) const { return run_with(options(), more); }
  Ended run_with(const ChildOptions& options, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run", "--quiet"};
    const auto add = [&](const std::string& flag, const std::string& value) {
      if (std::find(more.begin(), more.end(), flag) == more.end())
        arguments = arguments + std::vector<std::string>{flag, value};
    };
    add("--out", out());
    add("--scene", "mis-toy");
    add("--samplers", "independent");
    add("--samples", "16");
    add("--replicates", "16");
    return run_program(arguments + more, options);
  }
  Ended command(const std::vector<std::string>& arguments) const { return run_program(arguments, options()); }
  std::string write(const char* name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  /// The message of a run that must fail with `code`, having made no run folder.
  std::string refusal(const std::vector<std::string>& more, int code) const {
    const Ended ended = run(more);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_THAT(ended.out, ::testing::IsEmpty());
    EXPECT_THAT(ended.err, ::testing::StartsWith("halfslope: "));
    EXPECT_FALSE(std::filesystem::exists(out()));
    return ended.err;
  }
  std::string file_refusal(const std::string& toml) const {
    const std::string file = write("x.toml", toml);
    const Ended ended = command({"run", file, "--out", out()});
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_THAT(ended.err, ::testing::StartsWith("halfslope: " + file + ":"));
    EXPECT_FALSE(std::filesystem::exists(out()));
    return ended.err.substr(ended.err.find(".toml:") + 6);
  }

  const TemporaryFolder folder_;
};

}  // namespace halfslope
