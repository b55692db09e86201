#include "core/csv_reader.h"

#include <gmock/gmock.h>

#include "core/csv.h"
#include "core/error.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string refusal(const std::string& text) {
  try {
    const CsvReader table(text, "t.csv");
    for (std::size_t r = 0; r < table.size(); ++r) table.number(r, "b");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << text;
  return "";
}

TEST(CsvReader, ReadsWhatTheWriterWrites) {
  const std::vector<std::string> nasty = {"", ",", "\"", "\"\"", "\n", "\r\n", "a,\"b\"\n", "ä→", ",,,", "\",\"", "\r"};
  CsvWriter csv({"first", "second"});
  for (const std::string& a : nasty) {
    for (const std::string& b : nasty) csv.row(a, b);
  }
  const CsvReader table(csv.text(), "t.csv");
  ASSERT_EQ(table.size(), nasty.size() * nasty.size());
  for (std::size_t r = 0; r < table.size(); ++r) {
    EXPECT_EQ(table.text(r, "first"), nasty[r / nasty.size()]);
    EXPECT_EQ(table.text(r, "second"), nasty[r % nasty.size()]);
  }
}

TEST(CsvReader, NumbersAreExactAndMayBeMissing) {
  CsvWriter csv({"a", "b"});
  csv.row("x", 0.1);
  csv.row("y", std::optional<double>());
  csv.row("z", -1e-300);
  const CsvReader table(csv.text(), "t.csv");
  EXPECT_EQ(table.number(0, "b"), 0.1);
  EXPECT_EQ(table.number(1, "b"), std::nullopt);
  EXPECT_EQ(table.number(2, "b"), -1e-300);
  EXPECT_EQ(table.required_number(0, "b"), 0.1);
  EXPECT_THROW(table.required_number(1, "b"), Error);
}

// RFC 4180: lines end with CRLF, and the last line's end is optional.
TEST(CsvReader, LineEndsOfEveryKind) {
  for (const char* text : {"a,b\n1,2\n", "a,b\r\n1,2\r\n", "a,b\r\n1,2",
                           "\xef\xbb\xbf"
                           "a,b\n\n1,2\n\n"}) {
    const CsvReader table(text, "t.csv");
    ASSERT_EQ(table.size(), 1u) << text;
    EXPECT_EQ(table.columns(), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(table.number(0, "b"), 2) << text;
  }
  EXPECT_EQ(CsvReader("only\n\"\"\n\n", "t.csv").size(), 2u);  // in a single column a blank line is a cell
}

TEST(CsvReader, ErrorsNameFileAndLine) {
  EXPECT_THAT(refusal(""), StartsWith("t.csv: is empty"));
  EXPECT_THAT(refusal("a,b\n1,2\n1,2,3\n"), StartsWith("t.csv:3: found 3 cells, the header has 2"));
  EXPECT_THAT(refusal("a,b\n\"x\ny\",2\n1\n"),
              StartsWith("t.csv:4: found 1 cells"));  // a cell of two lines counts both
  EXPECT_THAT(refusal("a,b\n1,\"2\n3\n"), StartsWith("t.csv:2: a quoted cell does not end"));
  EXPECT_THAT(refusal("a,b\n1,\"2\"x\n"), StartsWith("t.csv:2: text after a closing quote"));
  EXPECT_THAT(refusal("a,b\n1,2\"\n"), StartsWith("t.csv:2: a quote inside"));
  for (const char* wrong : {"two", "1,5", "0x10", " 1", "1 ", "nan", "inf", "1e999"}) {
    EXPECT_THAT(refusal("a,b\n1,\"" + std::string(wrong) + "\"\n"),
                StartsWith("t.csv:2: column 'b': found '" + std::string(wrong) + "'; a finite number is allowed"));
  }
  EXPECT_THAT(refusal("a,c\n1,2\n"), StartsWith("t.csv:1: there is no column 'b'"));
  EXPECT_THROW(CsvReader::open("/nowhere/t.csv"), Error);
}

}  // namespace
}  // namespace halfslope
