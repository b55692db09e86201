#include "core/error.h"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

namespace halfslope {
namespace {

const std::vector<std::string> kNames = {"independent", "stratified", "n-rooks",   "halton",
                                         "halton-owen", "sobol",      "sobol-owen"};

TEST(NearestName, FindsTheNameBehindATypingError) {
  EXPECT_EQ(nearest_name("haltn", kNames), "halton");             // deletion
  EXPECT_EQ(nearest_name("halton-owne", kNames), "halton-owen");  // swap, one step and not two
  EXPECT_EQ(nearest_name("stratifieed", kNames), "stratified");   // insertion
  EXPECT_EQ(nearest_name("sobel", kNames), "sobol");              // substitution
  EXPECT_EQ(nearest_name("nrooks", kNames), "n-rooks");
  EXPECT_EQ(nearest_name("sobol", kNames), "sobol");
}

TEST(NearestName, ASwapCostsOne) {
  // Of 3 letters one may differ: a swap counted as two would be refused.
  EXPECT_EQ(nearest_name("acb", std::vector<std::string>{"abc"}), "abc");
  EXPECT_EQ(nearest_name("ca", std::vector<std::string>{"abc"}), "");  // alignment distance 3
}

TEST(NearestName, MoreThanAThirdOfTheLettersIsNoTypingError) {
  EXPECT_EQ(nearest_name("abcxyz", std::vector<std::string>{"abcdef"}), "");
  EXPECT_EQ(nearest_name("abcdyz", std::vector<std::string>{"abcdef"}), "abcdef");  // 2 of 6
  EXPECT_EQ(nearest_name("", kNames), "");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, TheFirstOfEquallyNearNamesWins) {
  EXPECT_EQ(nearest_name("aaac", std::vector<std::string>{"aaab", "aaad"}), "aaab");
}

TEST(NearestName, AVeryLongNameIsAnsweredAtOnce) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(nearest_name(std::string(10'000'000, 'x'), kNames), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(DidYouMean, IsATailForAMessageOrNothing) {
  EXPECT_EQ(did_you_mean("haltn", kNames), "; did you mean 'halton'?");
  EXPECT_EQ(did_you_mean("zzz", kNames), "");
}

TEST(Fail, CarriesCodeAndMessage) {
  try {
    fail(ExitCode::kUsage, "--samples: {} is not a number", "x");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_STREQ(error.what(), "--samples: x is not a number");
    return;
  }
  FAIL() << "nothing was thrown";
}

}  // namespace
}  // namespace halfslope
