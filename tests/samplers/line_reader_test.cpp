#include "samplers/line_reader.h"

#include <gmock/gmock.h>

#include <fstream>
#include <random>

#include "core/error.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

TEST(LineReader, GivesTheLinesOfAnyFileWhereverItsBufferEnds) {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  for (const std::size_t longest : {1u, 5u, 16u, 100u}) {
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<std::string> lines(random() % 40);
      std::string text;
      for (std::string& line : lines) {
        line.assign(random() % (longest + 1), static_cast<char>('a' + random() % 26));
        text += line + (random() % 4 == 0 && line.size() < longest ? "\r\n" : "\n");
      }
      if (!lines.empty() && !lines.back().empty() && trial % 2 == 0) text.erase(text.find_last_not_of("\r\n") + 1);
      std::ofstream(folder / "lines", std::ios::binary) << text;
      LineReader reader(folder / "lines", longest);
      for (std::size_t k = 0; k < lines.size(); ++k) {
        const auto line = reader.next();
        ASSERT_TRUE(line) << longest << ' ' << k;
        ASSERT_EQ(*line, lines[k]);
        ASSERT_EQ(reader.line(), k + 1);
      }
      ASSERT_FALSE(reader.next());
      ASSERT_FALSE(reader.next());
    }
  }
}

TEST(LineReader, ALineAboveTheLimitIsRefusedWithItsNumber) {
  const TemporaryFolder folder;
  for (const std::size_t length : {17u, 18u, 33u, 34u, 35u, 1000u}) {
    std::ofstream(folder / "lines") << std::string(16, 'a') << '\n' << std::string(length, 'b') << '\n';
    LineReader reader(folder / "lines", 16);
    EXPECT_EQ(reader.next()->size(), 16u);
    try {
      reader.next();
      FAIL() << length;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_THAT(error.what(), testing::HasSubstr("lines:2: the line is longer than 16 bytes")) << length;
    }
  }
}

TEST(LineReader, ReadsPipes) {
  const TemporaryFolder folder;
  std::ofstream(folder / "lines") << "a\nb\n";
  const std::string command = "cat " + (folder / "lines").string();
  std::FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  LineReader reader("/dev/fd/" + std::to_string(::fileno(pipe)), 16);
  EXPECT_EQ(reader.next(), "a");
  EXPECT_EQ(reader.next(), "b");
  EXPECT_EQ(reader.next(), std::nullopt);
  ::pclose(pipe);
}

}  // namespace
}  // namespace halfslope
