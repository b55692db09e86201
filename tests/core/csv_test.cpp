#include "core/csv.h"

#include <gtest/gtest.h>

#include <vector>

namespace halfslope {
namespace {

/// An independent reader of RFC 4180, with LF or CRLF line ends.
std::vector<std::vector<std::string>> parse(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    std::string& cell = rows.back().back();
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      cell += c;
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\n') {
      rows.push_back({""});
    } else {
      cell += c;
    }
  }
  rows.pop_back();
  return rows;
}

TEST(CsvWriter, WritesHeaderAndRows) {
  CsvWriter csv({"scene", "samples", "rmse", "lo"});
  csv.row("plates", std::uint64_t{16}, 0.1, std::optional<double>());
  csv.cell("plates").cell(-1).cell(std::optional(1e-30)).empty_cell().end_row();
  EXPECT_EQ(csv.text(), "scene,samples,rmse,lo\nplates,16,0.1,\nplates,-1,1e-30,\n");
}

TEST(CsvWriter, QuotesExactlyWhatNeedsIt) {
  CsvWriter csv({"a", "b"});
  csv.row("power:3@light*3+bsdf", "cap:n=1,alpha=2");
  csv.row("say \"x\"", "two\nlines");
  csv.row("cr\r", " spaces ");
  EXPECT_EQ(csv.text(),
            "a,b\npower:3@light*3+bsdf,\"cap:n=1,alpha=2\"\n\"say \"\"x\"\"\",\"two\nlines\"\n\"cr\r\", spaces \n");
}

TEST(CsvWriter, AnyTextComesBackThroughAReader) {
  const std::vector<std::string> nasty = {"", ",", "\"", "\"\"", "\n", "\r\n", "a,\"b\"\n", "ä→", ",,,", "\",\""};
  CsvWriter csv({"first", "second"});
  std::vector<std::vector<std::string>> rows = {{"first", "second"}};
  for (const std::string& a : nasty) {
    for (const std::string& b : nasty) {
      csv.row(a, b);
      rows.push_back({a, b});
    }
  }
  EXPECT_EQ(parse(csv.text()), rows);
}

TEST(CsvWriter, ALoneEmptyCellIsNotABlankLine) {
  CsvWriter csv({"only"});
  csv.cell("").end_row();
  csv.cell(std::optional<double>()).end_row();
  EXPECT_EQ(csv.text(), "only\n\"\"\n\"\"\n");
}

TEST(CsvWriterDeathTest, ARowOfTheWrongLengthAbortsWithBothCounts) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  CsvWriter csv({"a", "b"});
  EXPECT_DEATH(csv.row("x"), "found 1, promised 2");
  EXPECT_DEATH(csv.cell("x").text(), "found 1, promised 0");
}

}  // namespace
}  // namespace halfslope
