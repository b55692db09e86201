#include "samplers/exact_counter.h"

#include <gtest/gtest.h>

#include <random>

#include "samplers/radical_inverse.h"

namespace halfslope {
namespace {

__extension__ using Wide = unsigned __int128;

std::uint64_t bits(std::uint32_t base, std::uint64_t index) {
  return static_cast<std::uint64_t>(radical_inverse(base, index) * 0x1p53);  // exact: it is a multiple of 2⁻⁵³
}

constexpr std::uint64_t kLast = (std::uint64_t{1} << 31) - 1;

TEST(RadicalCounter, CountsExactlyInSmallBasesFarAndWide) {
  for (const std::uint32_t base : {2u, 3u, 4u, 5u, 7u, 10u, 11u, 13u, 101u}) {
    RadicalCounter counter(base);
    for (std::uint64_t i = 0; i < 200000; ++i, counter.next())
      ASSERT_EQ(counter.bits(), bits(base, i)) << base << ' ' << i;
  }
}

TEST(RadicalCounter, CountsExactlyInEveryHaltonBase) {
  // From 0; across every power of the base, where most digits turn over; and up to the last index there is.
  for (const std::uint32_t base : primes()) {
    RadicalCounter counter(base);
    const auto run = [&](std::uint64_t begin, std::uint64_t count) {
      counter.seek(begin);
      for (std::uint64_t i = begin; i < begin + count; ++i, counter.next()) {
        ASSERT_EQ(counter.bits(), bits(base, i)) << base << ' ' << i;
      }
    };
    run(0, 20);
    for (std::uint64_t power = base; power <= kLast; power *= base) {
      for (const std::uint64_t times : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{base} - 1}) {
        if (times * power <= kLast - 5) run(times * power - 5 % power, 10);
      }
    }
    run(kLast - 9, 10);
  }
}

TEST(RadicalCounter, ManyStepsLoseNothing) {
  // Ten million steps end where one leap does.
  for (const std::uint32_t base : {2u, 3u, 7919u, 8161u}) {
    RadicalCounter counter(base);
    std::uint64_t begin = 123456789;
    counter.seek(begin);
    for (int i = 0; i < 10000000; ++i) counter.next();
    EXPECT_EQ(counter.bits(), bits(base, begin + 10000000)) << base;
  }
}

TEST(RadicalCounter, SeeksAnywhere) {
  std::mt19937_64 random(5);
  for (const std::uint32_t base : {2u, 3u, 5u, 29u, 1009u, 8161u, 65521u}) {
    RadicalCounter counter(base);
    for (int trial = 0; trial < 5000; ++trial) {
      const std::uint64_t index = random() >> (33 + random() % 31);
      counter.seek(index);
      ASSERT_EQ(counter.bits(), bits(base, index)) << base << ' ' << index;
      counter.next();
      ASSERT_EQ(counter.bits(), bits(base, index + 1)) << base << ' ' << index;
      counter.seek(index + 1);
      ASSERT_EQ(counter.bits(), bits(base, index + 1));
    }
  }
}

TEST(EvenCounter, IsTheFractionRoundedDown) {
  EvenCounter counter;
  std::mt19937_64 random(6);
  for (const std::uint64_t count :
       {1ull, 2ull, 3ull, 7ull, 10ull, 100ull, 4096ull, 99991ull, kLast + 0ull, kLast + 1ull}) {
    counter.reset(count);
    const auto exact = [&](std::uint64_t i) { return static_cast<std::uint64_t>((Wide{i} << 53) / count); };
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, 100000); ++i, counter.next()) {
      ASSERT_EQ(counter.bits(), exact(i)) << i << '/' << count;
    }
    for (int trial = 0; trial < 100; ++trial) {
      const std::uint64_t i = random() % count;
      counter.seek(i);
      ASSERT_EQ(counter.bits(), exact(i)) << i << '/' << count;
    }
    counter.seek(count - 1);
    EXPECT_EQ(counter.bits(), exact(count - 1)) << "the last of " << count;
    EXPECT_LT(counter.bits(), 1ull << 53);
    counter.reset(count);
    EXPECT_EQ(counter.bits(), 0u);
  }
}

}  // namespace
}  // namespace halfslope
