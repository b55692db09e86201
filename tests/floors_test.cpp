// Who may include whom: core ← samplers, scenes, analysis ← estimators ← experiments, and nobody looks up or across.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

using ::testing::HasSubstr;

// The rooms that each room may include, itself among them.
const std::map<std::string, std::set<std::string>, std::less<>> kMayInclude = {
    {"core", {"core"}},
    {"samplers", {"core", "samplers"}},
    {"scenes", {"core", "scenes"}},
    {"analysis", {"core", "analysis"}},
    {"estimators", {"core", "samplers", "scenes", "analysis", "estimators"}},
    {"experiments", {"core", "samplers", "scenes", "analysis", "estimators", "experiments"}},
};

struct Include {
  std::string path;
  bool quoted;
};

std::optional<Include> include_of(std::string_view line) {
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  skip_blanks();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with("include")) return std::nullopt;
  line.remove_prefix(std::string_view("include").size());
  skip_blanks();
  if (line.empty() || (line[0] != '"' && line[0] != '<')) return std::nullopt;
  const bool quoted = line[0] == '"';
  return Include{std::string(line.substr(1, line.find(quoted ? '"' : '>', 1) - 1)), quoted};
}

// What is wrong with a line of a file in `room`, if anything.
std::optional<std::string> broken_floor(const std::string& room, std::string_view line) {
  const std::optional<Include> include = include_of(line);
  if (!include) return std::nullopt;
  const std::string target = include->path.substr(0, include->path.find('/'));
  const bool is_room = kMayInclude.contains(target) && include->path.find('/') != std::string::npos;
  if (!is_room && !include->quoted) return std::nullopt;  // the system's and the libraries' headers
  if (!is_room) return "\"" + include->path + "\" does not begin with a room's name";
  if (kMayInclude.at(room).contains(target)) return std::nullopt;
  return room + " must not include " + target + " (" + include->path + ")";
}

bool has_extension(const std::filesystem::path& path, std::initializer_list<const char*> extensions) {
  for (const char* extension : extensions)
    if (path.extension() == extension) return true;
  return false;
}

std::vector<std::filesystem::path> sources_of(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path root = std::filesystem::path(HALFSLOPE_SOURCE_DIR) / folder;
  if (!std::filesystem::exists(root)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
    if (entry.is_regular_file() && has_extension(entry.path(), {".h", ".cpp"})) files.push_back(entry.path());
  return files;
}

TEST(Floors, TheTreeKeepsThem) {
  for (const auto& [room, allowed] : kMayInclude) {
    const std::vector<std::filesystem::path> files = sources_of(room);
    EXPECT_FALSE(files.empty()) << "room " << room << " is empty: does this test look in the right place?";
    for (const std::filesystem::path& file : files) {
      std::ifstream stream(file);
      std::string line;
      for (int number = 1; std::getline(stream, line); ++number) {
        const std::optional<std::string> problem = broken_floor(room, line);
        EXPECT_FALSE(problem) << file.string() << ":" << number << ": " << *problem;
      }
    }
  }
}

TEST(Floors, HeadersAreReadOnce) {
  for (const char* folder :
       {"core", "samplers", "scenes", "analysis", "estimators", "experiments", "benchmarks", "tests"})
    for (const std::filesystem::path& file : sources_of(folder)) {
      if (file.extension() != ".h") continue;
      std::ostringstream text;
      text << std::ifstream(file).rdbuf();
      EXPECT_THAT(text.str(), HasSubstr("#pragma once\n")) << file.string();
    }
}

TEST(FloorsRule, LowerFloorsAndOneselfAreAllowed) {
  EXPECT_FALSE(broken_floor("core", "#include \"core/error.h\""));
  EXPECT_FALSE(broken_floor("samplers", "#include \"core/point_block.h\""));
  EXPECT_FALSE(broken_floor("estimators", "#include \"scenes/scene.h\""));
  EXPECT_FALSE(broken_floor("estimators", "#include \"analysis/moments.h\""));
  EXPECT_FALSE(broken_floor("experiments", "#include \"estimators/heuristics.h\""));
}

TEST(FloorsRule, UpwardsAndAcrossAreNot) {
  EXPECT_THAT(broken_floor("core", "#include \"analysis/moments.h\"").value(),
              HasSubstr("core must not include analysis"));
  EXPECT_TRUE(broken_floor("core", "#include \"experiments/spec.h\""));
  EXPECT_TRUE(broken_floor("samplers", "#include \"scenes/scene.h\""));
  EXPECT_TRUE(broken_floor("scenes", "#include \"samplers/sampler.h\""));
  EXPECT_TRUE(broken_floor("scenes", "#include \"analysis/moments.h\""));
  EXPECT_TRUE(broken_floor("analysis", "#include \"scenes/scene.h\""));
  EXPECT_TRUE(broken_floor("analysis", "#include \"estimators/terms.h\""));
  EXPECT_TRUE(broken_floor("estimators", "#include \"experiments/plan.h\""));
}

TEST(FloorsRule, NoSpellingGetsAround) {
  EXPECT_TRUE(broken_floor("core", "  #  include <analysis/moments.h>"));
  EXPECT_TRUE(broken_floor("core", "#include\"analysis/moments.h\"  // just this once"));
  EXPECT_TRUE(broken_floor("scenes", "#include \"../samplers/sampler.h\""));
  EXPECT_TRUE(broken_floor("scenes", "#include \"scene.h\""));
}

TEST(FloorsRule, LibrariesAndOtherLinesDoNotMatter) {
  EXPECT_FALSE(broken_floor("core", "#include <vector>"));
  EXPECT_FALSE(broken_floor("core", "#include <Random123/philox.h>"));
  EXPECT_FALSE(broken_floor("core", "// see analysis/moments.h"));
  EXPECT_FALSE(broken_floor("core", "#define X \"analysis/moments.h\""));
}

}  // namespace
