#include "experiments/journal.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

#include "core/error.h"
#include "experiments/interrupt.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const JournalHeader kHeader = {"0123456789abcdef", "0.1.0", "fma"};
constexpr std::size_t kHeadSize = 32;

std::vector<std::byte> payload(std::uint64_t unit, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(unit * 31 + i * 7 + (i >> 8));
  return bytes;
}

std::string contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void replace(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

std::string refusal(const std::filesystem::path& folder, const JournalHeader& header) {
  try {
    const Journal journal(folder, header, false);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  ADD_FAILURE() << "the journal was accepted";
  return "";
}

// Units 10, 20 and 30 of 100, 0 and 41 bytes; the file's content.
std::string three_units(const std::filesystem::path& folder) {
  {
    Journal journal(folder, kHeader, true);
    journal.append(10, payload(10, 100));
    journal.append(20, payload(20, 0));
    journal.append(30, payload(30, 41));
  }
  return contents(folder / "journal");
}

TEST(Journal, GivesBackWhatWasAppended) {
  const TemporaryFolder folder;
  Journal journal(folder.path(), kHeader, false);
  EXPECT_EQ(journal.size(), 0u);
  EXPECT_FALSE(journal.has(7));
  journal.append(7, payload(7, 1000));
  journal.append(std::uint64_t{1} << 63, payload(8, 5));
  EXPECT_TRUE(journal.has(7));
  EXPECT_EQ(journal.size(), 2u);
  EXPECT_EQ(journal.read(7), payload(7, 1000));
  EXPECT_EQ(journal.read(std::uint64_t{1} << 63), payload(8, 5));
  const std::vector<std::byte> all = payload(7, 1000);
  EXPECT_EQ(journal.read(7, 13, 40), std::vector<std::byte>(all.begin() + 13, all.begin() + 53));
  EXPECT_TRUE(journal.read(7, 1000, 0).empty());
}

TEST(Journal, SurvivesReopening) {
  const TemporaryFolder folder;
  three_units(folder.path());
  Journal journal(folder.path(), kHeader, false);
  EXPECT_EQ(journal.size(), 3u);
  EXPECT_EQ(journal.dropped_bytes(), 0u);
  EXPECT_EQ(journal.read(10), payload(10, 100));
  EXPECT_EQ(journal.read(20), payload(20, 0));
  EXPECT_EQ(journal.read(30), payload(30, 41));
  journal.append(40, payload(40, 9));
  EXPECT_EQ(Journal(folder.path(), kHeader, false).size(), 4u);
}

TEST(Journal, FirstOfTwoEqualUnitsWins) {
  const TemporaryFolder folder;
  Journal journal(folder.path(), kHeader, false);
  journal.append(1, payload(1, 10));
  const std::string before = contents(folder / "journal");
  journal.append(1, payload(2, 10));
  EXPECT_EQ(journal.read(1), payload(1, 10));
  EXPECT_EQ(contents(folder / "journal"), before);
}

TEST(Journal, ATailTornAnywhereIsCutAndCanBeDoneAgain) {
  const TemporaryFolder folder;
  const std::string whole = three_units(folder.path());
  const std::size_t last = whole.size() - kHeadSize - 41;
  for (std::size_t size = last; size < whole.size(); ++size) {
    replace(folder / "journal", whole.substr(0, size));
    Journal journal(folder.path(), kHeader, false);
    ASSERT_EQ(journal.size(), 2u) << "cut at " << size;
    ASSERT_FALSE(journal.has(30));
    ASSERT_EQ(journal.dropped_bytes(), size - last);
    journal.append(30, payload(30, 41));
    ASSERT_EQ(contents(folder / "journal"), whole);
  }
}

TEST(Journal, AFlippedByteAnywhereInARecordIsFound) {
  const TemporaryFolder folder;
  const std::string whole = three_units(folder.path());
  const std::size_t last = whole.size() - kHeadSize - 41;
  for (std::size_t at = last; at < whole.size(); ++at) {
    for (char mask : {'\x01', '\x80'}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ mask);
      replace(folder / "journal", damaged);
      const Journal journal(folder.path(), kHeader, false);
      ASSERT_EQ(journal.size(), 2u) << "flipped at " << at;
      ASSERT_EQ(std::filesystem::file_size(folder / "journal"), last);
    }
  }
}

TEST(Journal, DamageInTheMiddleLosesOnlyWhatFollows) {
  const TemporaryFolder folder;
  std::string damaged = three_units(folder.path());
  damaged[damaged.size() - 41 - 2 * kHeadSize - 1] ^= 1;  // the last byte of unit 10
  replace(folder / "journal", damaged);
  EXPECT_EQ(Journal(folder.path(), kHeader, false).size(), 0u);
}

TEST(Journal, ATornPreambleIsAFreshStart) {
  const TemporaryFolder folder;
  { Journal journal(folder.path(), kHeader, false); }
  const std::string whole = contents(folder / "journal");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    replace(folder / "journal", whole.substr(0, size));
    ASSERT_EQ(Journal(folder.path(), kHeader, false).size(), 0u) << "cut at " << size;
    ASSERT_EQ(contents(folder / "journal"), whole);
  }
}

TEST(Journal, AnothersHeaderIsRefusedSayingWhatDiffers) {
  const TemporaryFolder folder;
  const std::string before = three_units(folder.path());
  JournalHeader other = kHeader;
  other.spec_hash = "fedcba9876543210";
  const std::string spec = refusal(folder.path(), other);
  EXPECT_THAT(spec, HasSubstr("different: spec (0123456789abcdef there, fedcba9876543210 here); "));
  EXPECT_THAT(spec, HasSubstr("--overwrite"));
  EXPECT_THAT(spec, HasSubstr("--out"));
  other = kHeader;
  other.version = "0.2.0";
  other.isa_class = "baseline";
  const std::string two = refusal(folder.path(), other);
  EXPECT_THAT(two, HasSubstr("version (0.1.0 there, 0.2.0 here), ISA class (fma there, baseline here)"));
  EXPECT_THAT(two, Not(HasSubstr("spec (")));
  EXPECT_EQ(contents(folder / "journal"), before);
}

TEST(Journal, AnotherFileOfThatNameIsRefused) {
  const TemporaryFolder folder;
  replace(folder / "journal", "Dear diary,\nto-day I measured nothing.\n");
  EXPECT_THAT(refusal(folder.path(), kHeader), HasSubstr("--overwrite"));
  EXPECT_EQ(contents(folder / "journal"), "Dear diary,\nto-day I measured nothing.\n");
}

TEST(Journal, OverwriteStartsAfresh) {
  const TemporaryFolder folder;
  three_units(folder.path());
  JournalHeader other = kHeader;
  other.spec_hash = "fedcba9876543210";
  EXPECT_EQ(Journal(folder.path(), other, true).size(), 0u);
  EXPECT_EQ(Journal(folder.path(), other, false).size(), 0u);
}

TEST(Journal, FourThreadsAppendAtOnce) {
  const TemporaryFolder folder;
  constexpr std::uint64_t kThreads = 4, kUnits = 200;
  const auto size_of = [](std::uint64_t unit) { return static_cast<std::size_t>(unit * 37 % 500); };
  {
    Journal journal(folder.path(), kHeader, false);
    std::vector<std::jthread> threads;
    for (std::uint64_t thread = 0; thread < kThreads; ++thread)
      threads.emplace_back([&, thread] {
        for (std::uint64_t unit = thread; unit < kUnits; unit += kThreads) {
          journal.append(unit, payload(unit, size_of(unit)));
          journal.append(unit / 2, payload(unit / 2, size_of(unit / 2)));  // some units come from two threads
          EXPECT_EQ(journal.read(unit), payload(unit, size_of(unit)));
        }
      });
  }
  const Journal journal(folder.path(), kHeader, false);
  EXPECT_EQ(journal.size(), kUnits);
  EXPECT_EQ(journal.dropped_bytes(), 0u);
  for (std::uint64_t unit = 0; unit < kUnits; ++unit) EXPECT_EQ(journal.read(unit), payload(unit, size_of(unit)));
}

TEST(Journal, AFullDiskIsAnErrorAndLosesNothing) {
  const TemporaryFolder folder;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const InterruptGuard guard;  // the limit shows as a failed write, not as a signal
    const rlimit limit{10000, 10000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    Journal journal(folder.path(), kHeader, false);
    for (std::uint64_t unit = 0; unit < 3; ++unit) journal.append(unit, payload(unit, 3000));
    int code = 0;
    try {
      journal.append(3, payload(3, 3000));
    } catch (const Error& error) {
      code = static_cast<int>(error.code());
    }
    ::_exit(journal.has(3) ? 99 : code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), static_cast<int>(ExitCode::kIo));
  const Journal journal(folder.path(), kHeader, false);
  EXPECT_EQ(journal.dropped_bytes(), 0u);
  ASSERT_EQ(journal.size(), 3u);
  EXPECT_EQ(journal.read(2), payload(2, 3000));
}

TEST(JournalDeathTest, AskingForWhatIsNotThereIsAProgrammersError) {
  const TemporaryFolder folder;
  Journal journal(folder.path(), kHeader, false);
  journal.append(1, payload(1, 10));
  EXPECT_DEATH(journal.read(2), "unit 2 is in ");
  EXPECT_DEATH(journal.read(1, 5, 6), "bytes 5 \\+ 6 lie in unit 1 of 10");
}

}  // namespace
}  // namespace halfslope
