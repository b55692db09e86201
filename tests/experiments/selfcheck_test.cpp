#include <nlohmann/json.hpp>

#include "tests/experiments/command_line_fixture.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(CommandLine, SelfcheckPrintsTheCoverageOfEveryMethod) {
  const Ended ended = command({"selfcheck", "coverage", "--study", "intervals", "--runs", "50", "--json", "--quiet"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.err, IsEmpty());
  const auto rows = nlohmann::json::parse(ended.out);
  for (const char* method : {"bootstrap-t", "chi2", "delta", "bca", "reciprocal-t", "t"}) {
    const auto found =
        std::count_if(rows.begin(), rows.end(), [&](const auto& row) { return row["method"] == method; });
    EXPECT_GE(found, 3) << method;
  }
  for (const auto& row : rows) {
    EXPECT_GE(row["coverage"].get<double>(), 0);
    EXPECT_LE(row["coverage"].get<double>(), 1);
    EXPECT_EQ(row["promise_kept"], true);
  }
}

TEST_F(CommandLine, SelfcheckRefusesWhatItDoesNotKnow) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{{"selfcheck"},
                                                                     {"selfcheck", "speed"},
                                                                     {"selfcheck", "coverage", "--study", "interval"},
                                                                     {"selfcheck", "coverage", "--runs", "0"}}) {
    const Ended ended = command(arguments);
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_THAT(ended.out, IsEmpty());
  }
  EXPECT_THAT(command({"selfcheck", "coverage", "--study", "interval"}).err, HasSubstr("did you mean 'intervals'?"));
}

}  // namespace
}  // namespace halfslope
