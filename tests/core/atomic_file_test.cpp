#include "core/atomic_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"

namespace halfslope {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  AtomicFileTest() {
    std::string pattern = (fs::temp_directory_path() / "halfslope-atomic-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~AtomicFileTest() override { fs::remove_all(folder_); }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path().filename().string());
    return found;
  }
  fs::path folder_;
};

ExitCode code_of(const auto& action, std::string* message = nullptr) {
  try {
    action();
  } catch (const Error& error) {
    if (message) *message = error.what();
    return error.code();
  }
  return ExitCode::kDone;
}

TEST_F(AtomicFileTest, WhatIsWrittenIsRead) {
  std::string every_byte;
  for (int i = 0; i < 70000; ++i) every_byte += static_cast<char>(i * 31 % 256);
  for (const std::string& bytes : {std::string(), std::string("a\0b\r\n", 5), every_byte}) {
    write_file_atomically(folder_ / "file", bytes);
    EXPECT_EQ(read_file(folder_ / "file"), bytes);
  }
  EXPECT_THAT(names(), testing::ElementsAre("file"));
}

TEST_F(AtomicFileTest, TheNewFileHasTheUsersOwnPermissions) {
  const mode_t mask = ::umask(027);
  write_file_atomically(folder_ / "file", "x");
  ::umask(mask);
  EXPECT_EQ(fs::status(folder_ / "file").permissions(), fs::perms(0640));
}

TEST_F(AtomicFileTest, AFailedWriteLeavesTheOldFileAndNoTemporary) {
  write_file_atomically(folder_ / "file", "old");
  // A file-size limit makes write() fail half-way, as a full disk does, for root too.
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{4096, limit.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  const ExitCode code = code_of([&] { write_file_atomically(folder_ / "file", std::string(10000, 'n')); }, &message);
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(code, ExitCode::kIo);
  EXPECT_THAT(message,
              testing::AllOf(testing::HasSubstr((folder_ / "file").string()), testing::HasSubstr("File too large")));
  EXPECT_EQ(read_file(folder_ / "file"), "old");
  EXPECT_THAT(names(), testing::ElementsAre("file"));
}

TEST_F(AtomicFileTest, AMissingFolderAFolderAndADeviceAreRefused) {
  std::string message;
  EXPECT_EQ(code_of([&] { write_file_atomically(folder_ / "none" / "file", "x"); }, &message), ExitCode::kIo);
  EXPECT_THAT(message, testing::HasSubstr("No such file or directory"));
  EXPECT_EQ(code_of([&] { write_file_atomically(folder_, "x"); }), ExitCode::kIo);
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(code_of([&] { write_file_atomically(folder_ / "pipe", "x"); }), ExitCode::kIo);
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
}

TEST_F(AtomicFileTest, WritersOfOneFileNeverMixTheirBytes) {
  std::vector<std::string> contents;
  for (char c = 'a'; c < 'e'; ++c) contents.emplace_back(50000, c);
  {
    std::vector<std::jthread> writers;
    for (const std::string& content : contents) {
      writers.emplace_back([&] {
        for (int i = 0; i < 10; ++i) write_file_atomically(folder_ / "file", content);
      });
    }
    for (int i = 0; i < 100; ++i) {
      if (!fs::exists(folder_ / "file")) continue;
      EXPECT_THAT(contents, testing::Contains(read_file(folder_ / "file")));
    }
  }
  EXPECT_THAT(names(), testing::ElementsAre("file"));
}

TEST_F(AtomicFileTest, ReadingTellsMissingFromUnreadable) {
  std::string message;
  EXPECT_EQ(code_of([&] { read_file(folder_ / "none"); }, &message), ExitCode::kBadInput);
  EXPECT_THAT(message, testing::HasSubstr((folder_ / "none").string()));
  EXPECT_EQ(code_of([&] { read_file(folder_); }), ExitCode::kBadInput);
  std::ofstream(folder_ / "file") << "x";
  EXPECT_EQ(code_of([&] { read_file(folder_ / "file" / "below"); }), ExitCode::kBadInput);
  fs::create_symlink("loop", folder_ / "loop");  // unreadable for root too
  EXPECT_EQ(code_of([&] { read_file(folder_ / "loop"); }), ExitCode::kIo);
}

}  // namespace
}  // namespace halfslope
