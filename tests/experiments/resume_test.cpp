// A run that is stopped, at whatever moment, and run again ends with the bytes of one that never was.
#include <gmock/gmock.h>

#include <fstream>
#include <random>
#include <thread>

#include "tests/experiments/csv_table.h"
#include "tests/experiments/program.h"
#include "tests/experiments/run_files.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;

using Files = std::map<std::string, std::string>;

class Resume : public ::testing::Test {
 protected:
  /// Some seconds of work: a reference, units, tables, pictures.
  std::vector<std::string> arguments(const std::string& out) const {
    return run_of(out, {"--resolution", "24,16", "--samples", "16:256", "--images", "16,64", "--replicates", "96"});
  }
  /// Some tenths of a second, in several units.
  std::vector<std::string> little(const std::string& out) const {
    return run_of(out, {"--resolution", "20,14", "--samples", "4,16", "--images", "16", "--replicates", "16"});
  }
  ChildOptions options(const std::string& cache) const {
    return {.environment = {{"HALFSLOPE_CACHE", (folder_ / cache.c_str()).string()}}};
  }
  /// The files of a run that nothing interrupts.
  Files whole(const std::vector<std::string>& command) {
    const Ended ended = run_program(command, options("cache-whole"));
    EXPECT_EQ(ended.code, 0) << ended.err;
    seconds_ = ended.seconds;
    return run_files(folder_ / "whole");
  }
  bool exists(const std::string& path) const { return std::filesystem::exists(folder_ / path.c_str()); }
  std::uintmax_t size(const std::string& path) const {
    std::error_code missing;
    const auto bytes = std::filesystem::file_size(folder_ / path.c_str(), missing);
    return missing ? 0 : bytes;
  }
  std::vector<std::string> run_of(const std::string& out, const std::vector<std::string>& more) const {
    std::vector<std::string> command = {
        "run", "--scene", "veach-mis", "--samplers", "n-rooks,halton-owen", "--out", (folder_ / out.c_str()).string()};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  static constexpr std::uintmax_t kHeader = 150;  ///< at least the bytes of a journal without units

  double seconds_ = 0;
  const TemporaryFolder folder_;
};

/// Waits until `condition` holds or the child has ended; whether it held while the child ran.
template <class Condition>
bool wait_until(Child& child, Condition condition) {
  while (child.running()) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return false;
}

class ResumeKilled : public Resume {
 protected:
  /// Runs into `out` until the condition holds, and kills; false if the run was done before.
  template <class Condition>
  bool kill_when(const std::string& out, Condition condition) {
    Child child(arguments(out), options("cache"));
    const bool alive = wait_until(child, condition);
    if (alive) child.signal(SIGKILL);
    const Ended ended = child.wait();
    EXPECT_THAT(ended.code, AnyOf(alive ? 128 + SIGKILL : 0, 0)) << ended.err;
    return ended.code != 0;
  }
  void finish(const std::string& out, const Files& expected) {
    const Ended ended = run_program(arguments(out), options("cache"));
    EXPECT_EQ(ended.code, 0) << ended.err;
    expect_same_files(expected, run_files(folder_ / out.c_str()), out);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / out.c_str()))
      EXPECT_NE(entry.path().extension(), ".tmp") << entry.path() << " was left behind";
  }
};

// Three moments that are known to lie in the reference, among the units and in the pictures, and seven at random.
TEST_F(ResumeKilled, AtTenMomentsItEndsWithTheSameBytes) {
  const Files expected = whole(arguments("whole"));
  ASSERT_TRUE(kill_when("tables", [&] { return exists("tables/images"); }));
  finish("tables", expected);
  std::filesystem::remove_all(folder_ / "cache");

  std::string out = "out";
  ASSERT_TRUE(kill_when(out, [&] { return exists("cache") && !std::filesystem::is_empty(folder_ / "cache"); }));
  ASSERT_TRUE(kill_when(out, [&] { return size(out + "/journal") > kHeader; }));
  std::mt19937 random(20260801);
  for (int kills = 0, attempt = 0; kills < 7; ++attempt) {
    ASSERT_LT(attempt, 40);
    const std::chrono::duration<double> delay(std::uniform_real_distribution(0.0, 0.4 * seconds_)(random));
    const auto moment = std::chrono::steady_clock::now() + delay;
    if (kill_when(out, [&] { return std::chrono::steady_clock::now() > moment; })) {
      ++kills;
      continue;
    }
    finish(out, expected);  // it was done before its moment came: the next kills are for a new one
    out = "out-" + std::to_string(attempt);
    std::filesystem::remove_all(folder_ / "cache");
  }
  finish(out, expected);
  // A finished run is not done again.
  const std::string journal = read_file(folder_ / out.c_str() / "journal");
  finish(out, expected);
  EXPECT_EQ(read_file(folder_ / out.c_str() / "journal"), journal);
}

TEST_F(Resume, AnInterruptKeepsWhatIsDone) {
  const Files expected = whole(arguments("whole"));
  std::uintmax_t done = 0;
  for (const int signal : {SIGINT, SIGTERM}) {
    Child child(arguments("out"), options("cache"));
    ASSERT_TRUE(wait_until(child, [&] { return size("out/journal") > std::max(kHeader, done); }));
    child.signal(signal);
    const Ended ended = child.wait();
    EXPECT_EQ(ended.code, 130);
    EXPECT_THAT(ended.err, HasSubstr("units are done: run the same command again to go on"));
    EXPECT_THAT(ended.out, IsEmpty());
    EXPECT_FALSE(exists("out/convergence.csv"));
    done = size("out/journal");
  }
  // In the reference, where nothing is done yet.
  Child child(arguments("other"), options("other-cache"));
  ASSERT_TRUE(wait_until(child, [&] { return exists("other/journal"); }));
  child.signal(SIGINT);
  EXPECT_EQ(child.wait().code, 130);
  for (const char* out : {"out", "other"}) {
    const Ended ended = run_program(arguments(out), options("cache"));
    EXPECT_EQ(ended.code, 0) << ended.err;
    expect_same_files(expected, run_files(folder_ / out), out);
  }
}

TEST_F(Resume, ADamagedJournalIsMended) {
  const Files expected = whole(little("whole"));
  const std::string journal = read_file(folder_ / "whole/journal");
  std::string flipped = journal, grown = journal + "not a record";
  flipped[journal.size() * 2 / 3] = static_cast<char>(flipped[journal.size() * 2 / 3] ^ 1);
  for (const std::string& damaged :
       {journal.substr(0, journal.size() / 2), flipped, grown, journal.substr(0, 30), std::string()}) {
    std::filesystem::remove_all(folder_ / "out");
    std::filesystem::create_directories(folder_ / "out");
    std::ofstream(folder_ / "out/journal", std::ios::binary) << damaged;
    const Ended ended = run_program(little("out"), options("cache-whole"));
    EXPECT_EQ(ended.code, 0) << ended.err;
    const bool torn = damaged.size() > kHeader;
    EXPECT_EQ(ended.err.find("bytes at the journal's end were damaged") != std::string::npos, torn) << ended.err;
    expect_same_files(expected, run_files(folder_ / "out"), std::to_string(damaged.size()) + " bytes of journal");
  }
}

}  // namespace
}  // namespace halfslope
