#include "core/numbers.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <clocale>
#include <cmath>
#include <limits>
#include <random>

namespace halfslope {
namespace {

TEST(FormatNumber, IsTheShortestTextThatReadsBack) {
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(format_number(1.0), "1");
  EXPECT_EQ(format_number(-0.0), "-0");
  EXPECT_EQ(format_number(1e300), "1e+300");
  EXPECT_EQ(format_number(5e-324), "5e-324");
  EXPECT_EQ(format_number(9007199254740993.0), "9007199254740992");
}

TEST(FormatNumber, EveryBinary64ReadsBackExactly) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const std::string text = format_number(value);
    double back = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), back);
    ASSERT_EQ(result.ptr, text.data() + text.size());
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(value)) << text;
  }
}

TEST(FormatNumber, NonFiniteValuesHaveOneNameEach) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(format_number(infinity), "inf");
  EXPECT_EQ(format_number(-infinity), "-inf");
  EXPECT_EQ(format_number(nan), "nan");
  EXPECT_EQ(format_number(-nan), "nan");
}

TEST(FormatNumber, IntegersAreExactToTheirEnds) {
  EXPECT_EQ(format_number(-3), "-3");
  EXPECT_EQ(format_number(std::uint8_t{200}), "200");
  EXPECT_EQ(format_number(std::numeric_limits<std::int64_t>::min()), "-9223372036854775808");
  EXPECT_EQ(format_number(std::numeric_limits<std::uint64_t>::max()), "18446744073709551615");
}

TEST(FormatNumber, ALocaleWithADecimalCommaChangesNothing) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) std::setlocale(LC_ALL, name);
  EXPECT_EQ(format_number(1234567.5), "1234567.5");
  std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace halfslope
