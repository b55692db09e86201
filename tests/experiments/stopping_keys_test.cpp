#include "experiments/stopping_keys.h"

#include <gmock/gmock.h>

#include <functional>

#include "core/error.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kSmallest = "scene = 'veach-mis'\nsamplers = 'independent'\nsamples = 16\n";

Spec spec_with(const std::map<std::string, std::string>& flags) {
  Spec spec = parse_spec_toml(kSmallest, "x.toml");
  for (const auto& [key, value] : flags) apply_flag(spec, key, value);
  return spec;
}

std::string refusal(const std::function<void()>& attempt, ExitCode code) {
  try {
    attempt();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
  return "nothing was refused";
}

TEST(ParseTarget, IsAShareOfTheRmse) {
  for (const char* text : {"rmse ±5%", "rmse ± 5 %", "rmse +-5%", "rmse 5%", "rmse  5.0 % "})
    EXPECT_EQ(parse_target(text), 0.05) << text;
  EXPECT_EQ(parse_target("rmse ±0.5%"), 0.005);
  for (const char* text : {"", "rmse", "5%", "rmse 5", "rmse 0%", "rmse -5%", "rmse 100%", "rmse ±%", "rmse 5% or so",
                           "mae 5%", "rmse nan%", "rmse 1e0%", "rmse +-±5%", "rmse inf%"})
    EXPECT_EQ(parse_target(text), std::nullopt) << text;
  EXPECT_EQ(target_text(0.05), "rmse ±5%");
  EXPECT_EQ(parse_target(target_text(0.005)), 0.005);
}

TEST(ParseBudget, IsATime) {
  EXPECT_EQ(parse_budget("60 s"), 60);
  EXPECT_EQ(parse_budget("60s"), 60);
  EXPECT_EQ(parse_budget("1.5 min"), 90);
  EXPECT_EQ(parse_budget("1000 h"), 3.6e6);
  for (const char* text : {"", "60", "s", "0 s", "-1 s", "1 day", "1001 h", "60 s 5", "inf s", "nan h", "1 m"})
    EXPECT_EQ(parse_budget(text), std::nullopt) << text;
  EXPECT_EQ(budget_text(90), "90 s");
}

TEST(StoppingKeys, AreReadFromFilesAndFlags) {
  const Spec file = parse_spec_toml(kSmallest + "target = 'rmse ±5%'", "x.toml");
  EXPECT_EQ(file.target, 0.05);
  EXPECT_TRUE(file.in_stages());
  EXPECT_EQ(spec_with({{"budget", "2 min"}}).budget, 120);
  EXPECT_FALSE(spec_with({}).in_stages());
  Spec taken_back = file;
  apply_flag(taken_back, "target", "none");
  EXPECT_FALSE(taken_back.in_stages());
  EXPECT_EQ(
      refusal([] { parse_spec_toml("\ntarget = '5%'", "x.toml"); }, ExitCode::kBadInput),
      "x.toml:2:10: key 'target': found '5%'; allowed: 'rmse ±5%' with a number above 0 and below 100, or 'none'");
  EXPECT_THAT(refusal([] { parse_spec_toml("budget = 60", "x.toml"); }, ExitCode::kBadInput),
              StartsWith("x.toml:1:10: key 'budget': found 60; allowed: a time above 0 as in '60 s'"));
  EXPECT_THAT(refusal(
                  [] {
                    spec_with({{"budget", "soon"}});
                  },
                  ExitCode::kUsage),
              StartsWith("--budget: found 'soon'; allowed: "));
}

TEST(StoppingKeys, ExcludeEachOther) {
  EXPECT_THAT(refusal(
                  [] {
                    validate(spec_with({{"budget", "60 s"}, {"target", "rmse 5%"}}));
                  },
                  ExitCode::kUsage),
              HasSubstr("--target: a target and a budget (--budget) exclude each other"));
  EXPECT_THAT(refusal([] { validate(parse_spec_toml(kSmallest + "budget = '1 h'\ntarget = 'rmse 5%'", "x.toml")); },
                      ExitCode::kBadInput),
              HasSubstr("x.toml:5:10: a target and a budget (x.toml:4:10) exclude each other"));
  validate(spec_with({{"budget", "60 s"}, {"target", "none"}}));
}

// The stages and their replicates are what there is to measure; how much of it is measured is not part of the hash, so
// that a sharper target goes on where a blunter one ended.
TEST(StoppingKeys, TheHashKnowsTheStagesAlone) {
  const auto hash = [](const std::map<std::string, std::string>& flags) { return spec_hash(spec_with(flags)); };
  const std::string target = hash({{"target", "rmse 5%"}}), budget = hash({{"budget", "1 s"}});
  EXPECT_EQ(target, hash({{"target", "rmse 2%"}}));
  EXPECT_EQ(target, hash({{"target", "rmse 2%"}, {"replicates", "4096"}}));
  EXPECT_NE(target, hash({{"target", "rmse 5%"}, {"replicates", "1024"}}));
  EXPECT_EQ(budget, hash({{"budget", "1 h"}}));
  EXPECT_NE(budget, target);  // their stages are not the same
  EXPECT_NE(target, hash({{"replicates", "4096"}}));
  EXPECT_EQ(hash({{"target", "none"}}), hash({}));
}

TEST(StoppingKeys, ReplicatesAreThenTheMost) {
  EXPECT_EQ(spec_with({{"target", "rmse 5%"}}).most_replicates, 4096);
  EXPECT_EQ(spec_with({{"target", "rmse 5%"}, {"replicates", "300"}}).most_replicates, 300);
  EXPECT_EQ(spec_with({}).replicates, 64);
}

}  // namespace
}  // namespace halfslope
