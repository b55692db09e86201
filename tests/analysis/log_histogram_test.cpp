#include "analysis/log_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"

namespace halfslope {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTolerance = 0.00543;  // 2^(1/128) − 1 = 0.0054299

std::vector<std::byte> bytes_of(const LogHistogram& histogram) {
  std::vector<std::byte> bytes;
  histogram.append_to(bytes);
  return bytes;
}

LogHistogram histogram_of(std::span<const double> values) {
  LogHistogram histogram;
  histogram.add(values);
  return histogram;
}

/// Positive finite numbers, evenly over the exponents, subnormals among them.
std::vector<double> numbers_of_all_sizes(int count) {
  std::mt19937_64 random(11);
  std::vector<double> values;
  while (static_cast<int>(values.size()) < count) {
    const double value = std::abs(std::bit_cast<double>(random()));
    if (std::isfinite(value) && value > 0) values.push_back(value);
  }
  for (int i = 0; i < 200; ++i) values.push_back(std::ldexp(1 + i / 200.0, -1074 + i / 4));
  return values;
}

TEST(LogBins, AreTheFloorOf64Log2) {
  for (const double value : numbers_of_all_sizes(200000)) {
    const double exact = 64 * std::log2(value);
    const int found = log_bins::bin_of(std::bit_cast<std::uint64_t>(value));
    if (std::abs(exact - std::round(exact)) < 1e-9) continue;  // at an end, log2's rounding decides
    ASSERT_EQ(found, static_cast<int>(std::floor(exact))) << value;
  }
}

TEST(LogBins, StartAtPowersOfTwoAndNeverDecrease) {
  for (int exponent = -1074; exponent < 1024; ++exponent) {
    EXPECT_EQ(log_bins::bin_of(std::bit_cast<std::uint64_t>(std::ldexp(1.0, exponent))), 64 * exponent);
  }
  int last = 0;
  for (double value = 1; value < 2; value += 0x1p-20) {
    const int found = log_bins::bin_of(std::bit_cast<std::uint64_t>(value));
    ASSERT_TRUE(found == last || found == last + 1) << value;
    last = found;
  }
  EXPECT_EQ(last, 63);
  EXPECT_EQ(log_bins::bin_of(std::bit_cast<std::uint64_t>(std::numeric_limits<double>::max())), log_bins::kMaxBin);
}

TEST(LogHistogram, AnyNumberAloneIsItsOwnMedian) {
  for (const double value : numbers_of_all_sizes(5000)) {
    const double median = histogram_of(std::vector<double>{-value}).median();
    ASSERT_LE(std::abs(median - value), kTolerance * value) << value;
  }
}

TEST(LogHistogram, QuantilesAreThoseOfTheSortedValues) {
  std::mt19937_64 random(5);
  std::lognormal_distribution<double> errors(-8, 3);
  std::vector<double> values(9999);
  for (double& value : values) value = errors(random) * (random() % 2 ? 1 : -1);
  std::fill_n(values.begin(), 1000, 0.0);
  const LogHistogram histogram = histogram_of(values);
  for (double& value : values) value = std::abs(value);
  std::ranges::sort(values);
  for (const double q : {0.0, 0.05, 0.1, 0.100015, 0.3, 0.5, 0.9, 0.999, 1.0}) {
    const double rank = std::max(1.0, std::ceil(q * 9999));
    const double exact = values[static_cast<std::size_t>(rank) - 1];
    EXPECT_LE(std::abs(histogram.quantile(q) - exact), kTolerance * exact) << q;
  }
  EXPECT_EQ(histogram.count(), 9999u);
  EXPECT_EQ(histogram.zeros(), 1000u);
}

TEST(LogHistogram, NonFiniteValuesComeLast) {
  const LogHistogram histogram = histogram_of(std::vector<double>{NAN, 1, -kInfinity, 0, kInfinity});
  EXPECT_EQ(histogram.count(), 5u);
  EXPECT_EQ(histogram.nonfinite(), 3u);
  EXPECT_EQ(histogram.zeros(), 1u);
  EXPECT_EQ(histogram.quantile(0.2), 0);
  EXPECT_NEAR(histogram.quantile(0.4), 1, kTolerance);
  EXPECT_EQ(histogram.median(), kInfinity);
  EXPECT_TRUE(std::isnan(LogHistogram().median()));
}

TEST(LogHistogram, MergingIsAddingInAnyOrder) {
  std::vector<double> values = numbers_of_all_sizes(3000);
  values.insert(values.end(), {0, 0, kInfinity, NAN});
  const std::vector<std::byte> whole = bytes_of(histogram_of(values));
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 5; ++trial) {
    std::ranges::shuffle(values, random);
    const std::size_t cut = random() % values.size();
    LogHistogram left = histogram_of(std::span(values).first(cut));
    left.merge(histogram_of(std::span(values).subspan(cut)));
    EXPECT_EQ(bytes_of(left), whole);
  }
  LogHistogram twice = histogram_of(values), both = twice;
  twice.merge(twice);
  both.merge(histogram_of(values));
  EXPECT_EQ(bytes_of(twice), bytes_of(both));
  EXPECT_EQ(twice.count(), 2 * values.size());
}

TEST(LogHistogram, ComesBackFromItsBytesWithTheCursorBehindThem) {
  LogHistogram some = histogram_of(numbers_of_all_sizes(500));
  for (int i = 0; i < 12; ++i) some.merge(some);  // counts of more than a byte
  std::vector<std::byte> bytes;
  some.append_to(bytes);
  LogHistogram().append_to(bytes);
  bytes.push_back(std::byte{42});
  std::span<const std::byte> cursor = bytes;
  LogHistogram back = LogHistogram::read(cursor);
  EXPECT_EQ(bytes_of(back), bytes_of(some));
  back.add(1e300);  // and it still works
  EXPECT_EQ(back.count(), some.count() + 1);
  EXPECT_EQ(LogHistogram::read(cursor).count(), 0u);
  ASSERT_EQ(cursor.size(), 1u);
  EXPECT_EQ(cursor[0], std::byte{42});
}

TEST(LogHistogram, BrokenBytesAreRefused) {
  const auto refused = [](std::span<const std::byte> bytes) {
    try {
      LogHistogram::read(bytes);
    } catch (const Error& error) {
      return error.code() == ExitCode::kBadInput;
    }
    return false;
  };
  const std::vector<std::byte> bytes = bytes_of(histogram_of(numbers_of_all_sizes(50)));
  for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_TRUE(refused(std::span(bytes).first(size))) << size;
  const auto made_of = [](std::initializer_list<int> values) {
    std::vector<std::byte> made;
    for (const int value : values) made.push_back(static_cast<std::byte>(value));
    return made;
  };
  EXPECT_TRUE(refused(made_of({0, 0, 2, 5, 1, 0, 1})));              // the same bin twice
  EXPECT_TRUE(refused(made_of({0, 0, 1, 5, 0})));                    // an empty bin
  EXPECT_TRUE(refused(made_of({0, 0, 1, 255, 255, 127, 1})));        // beyond the last bin
  EXPECT_TRUE(refused(std::vector<std::byte>(12, std::byte{255})));  // a number without end
  EXPECT_FALSE(refused(made_of({0, 0, 1, 5, 1})));
}

}  // namespace
}  // namespace halfslope
