#include "experiments/run_folder.h"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>

#include "core/error.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string io_error(const std::filesystem::path& folder) {
  try {
    const RunFolder run(folder);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kIo);
    return error.what();
  }
  ADD_FAILURE() << folder << " could be opened";
  return "";
}

TEST(RunFolder, MakesTheFolderAndItsParents) {
  const TemporaryFolder temporary;
  const RunFolder run(temporary / "a/b/c");
  EXPECT_TRUE(std::filesystem::is_directory(temporary / "a/b/c"));
  EXPECT_EQ(run.path("journal"), temporary / "a/b/c/journal");
}

TEST(RunFolder, ASecondRunIsBusyAtOnceAndHarmless) {
  const TemporaryFolder temporary;
  {
    const RunFolder first(temporary.path());
    std::ofstream(first.path("kept")) << "x";
    EXPECT_THAT(io_error(temporary.path()), StartsWith("another run is at work in " + temporary.path().string()));
    EXPECT_THAT(io_error(temporary.path()), StartsWith("another run is at work"));
    EXPECT_EQ(std::filesystem::file_size(temporary / "kept"), 1u);
  }
  EXPECT_NO_THROW(RunFolder{temporary.path()});
}

TEST(RunFolder, AKilledRunLeavesNoLock) {
  const TemporaryFolder temporary;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const RunFolder run(temporary.path());
    [[maybe_unused]] const ssize_t told = ::write(ready[1], "x", 1);
    while (true) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_THAT(io_error(temporary.path()), StartsWith("another run is at work"));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_NO_THROW(RunFolder{temporary.path()});
  ::close(ready[0]);
  ::close(ready[1]);
}

TEST(RunFolder, WhatCannotBeAFolderSaysWhy) {
  const TemporaryFolder temporary;
  std::ofstream(temporary / "file") << "x";
  EXPECT_THAT(io_error(temporary / "file"), HasSubstr("Not a directory"));
  EXPECT_THAT(io_error(temporary / "file/below"), HasSubstr("Not a directory"));
  // Not even root can make a folder there.
  EXPECT_THAT(io_error("/proc/halfslope-test/run"), HasSubstr("No such file or directory"));
  EXPECT_THAT(io_error("/proc/self/fdinfo"), HasSubstr("cannot be opened for writing"));
}

}  // namespace
}  // namespace halfslope
