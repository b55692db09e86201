#include "experiments/progress.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <thread>
#include <vector>

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;

// What the action writes to stderr, in a child process whose stderr is `theirs`.
std::string stderr_of(int ours, int theirs, const std::function<void()>& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::setenv("TERM", "xterm", 1);
    ::dup2(theirs, STDERR_FILENO);
    action();
    ::_exit(0);
  }
  ::close(theirs);
  std::string text;
  char buffer[4096];
  for (ssize_t count; (count = ::read(ours, buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(count));
  ::close(ours);
  ::waitpid(child, nullptr, 0);
  return text;
}

std::string on_pipe(const std::function<void()>& action) {
  int ends[2];
  if (::pipe(ends) != 0) return "no pipe";
  return stderr_of(ends[0], ends[1], action);
}

std::string on_terminal(const std::function<void()>& action) {
  const int ours = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (ours < 0 || ::grantpt(ours) != 0 || ::unlockpt(ours) != 0) return "no pseudo-terminal";
  return stderr_of(ours, ::open(::ptsname(ours), O_RDWR | O_NOCTTY), action);
}

// Bare containers may have no /dev/pts.
class ProgressOnTerminal : public testing::Test {
 protected:
  void SetUp() override {
    const int ours = ::posix_openpt(O_RDWR | O_NOCTTY);
    const bool there = ours >= 0 && ::grantpt(ours) == 0 && ::unlockpt(ours) == 0;
    if (ours >= 0) ::close(ours);
    if (!there) GTEST_SKIP() << "this machine has no pseudo-terminals";
  }
};

void work_in_two_halves(bool quiet) {
  Progress progress("veach-mis", 2000, quiet);
  progress.advance(1000);
  ::usleep(150'000);
  progress.advance(1000);
  progress.finish();
  progress.finish();
}

TEST(Progress, OffATerminalThereIsOneLine) {
  EXPECT_THAT(on_pipe([] { work_in_two_halves(false); }),
              MatchesRegex("done: veach-mis, 2\\.00 k samples in 0:00, [0-9.]+ k samples/s\n"));
}

TEST_F(ProgressOnTerminal, OnATerminalThereIsABar) {
  ::unsetenv("NO_COLOR");
  const std::string text = on_terminal([] { work_in_two_halves(false); });
  EXPECT_THAT(text, HasSubstr(" 50 %"));
  EXPECT_THAT(text, HasSubstr("100 %"));
  EXPECT_THAT(text, HasSubstr(" elapsed, "));
  EXPECT_THAT(text, HasSubstr(" left, "));
  EXPECT_THAT(text, HasSubstr("\x1b[32m"));
  EXPECT_THAT(text, HasSubstr("done: veach-mis"));
}

TEST_F(ProgressOnTerminal, NoColorIsRespected) {
  const std::string text = on_terminal([] {
    ::setenv("NO_COLOR", "1", 1);
    work_in_two_halves(false);
  });
  EXPECT_THAT(text, HasSubstr(" 50 %"));
  EXPECT_THAT(text, Not(HasSubstr("\x1b[32m")));
}

TEST_F(ProgressOnTerminal, QuietIsSilent) {
  EXPECT_THAT(on_pipe([] { work_in_two_halves(true); }), IsEmpty());
  EXPECT_THAT(on_terminal([] { work_in_two_halves(true); }), IsEmpty());
}

TEST_F(ProgressOnTerminal, AnUnfinishedBarIsCleared) {
  const std::string text = on_terminal([] {
    Progress progress("x", 10, false);
    progress.advance(1);
  });
  EXPECT_TRUE(text.ends_with("\r\x1b[K")) << text;
}

TEST(Progress, ThreadsAddUp) {
  const std::string text = on_pipe([] {
    Progress progress("x", 400'000, false);
    {
      std::vector<std::jthread> threads;
      for (int thread = 0; thread < 4; ++thread)
        threads.emplace_back([&] {
          for (int i = 0; i < 100'000; ++i) progress.advance(1);
        });
    }
    progress.finish();
  });
  EXPECT_THAT(text, HasSubstr("400 k samples in"));
}

TEST(ProgressLine, SaysPercentTimesAndSpeed) {
  const ProgressState half{"veach-mis", 5e8, 1e9, 65};
  EXPECT_EQ(progress_line(half, 120, false),
            "veach-mis [############------------]  50 %  1:05 elapsed, 1:05 left, 7.69 M samples/s");
  EXPECT_THAT(progress_line({"x", 0, 1e9, 0}, 120, false), HasSubstr("  0 %  0:00 elapsed, ?:?? left, 0 samples/s"));
  EXPECT_THAT(progress_line({"x", 999'999, 1'000'000, 9}, 120, false), HasSubstr(" 99 %"));
  EXPECT_THAT(progress_line({"x", 0, 0, 0}, 120, false), HasSubstr("100 %"));
}

TEST(ProgressLine, NeverWraps) {
  for (int columns = 1; columns <= 120; ++columns)
    EXPECT_LT(progress_line({"a-rather-long-name", 1e8, 1e9, 65}, columns, false).size(),
              static_cast<std::size_t>(std::max(columns, 2)));
}

TEST(ProgressLine, TimesAndCounts) {
  EXPECT_EQ(clock_time(0), "0:00");
  EXPECT_EQ(clock_time(59.6), "1:00");
  EXPECT_EQ(clock_time(7384), "2:03:04");
  EXPECT_EQ(short_count(0), "0");
  EXPECT_EQ(short_count(999.4), "999");
  EXPECT_EQ(short_count(999.6), "1.00 k");
  EXPECT_EQ(short_count(43'100'000), "43.1 M");
  EXPECT_EQ(short_count(2.62e9), "2.62 G");
  EXPECT_EQ(short_count(9.996e6), "10.0 M");
  EXPECT_EQ(short_count(123e12), "123 T");
}

}  // namespace
}  // namespace halfslope
