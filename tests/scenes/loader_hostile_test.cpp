// Files made to exhaust memory, stack or patience: each an error with its place, in under a second and 256 MiB.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>

#include "core/error.h"
#include "scenes/loader.h"
#include "tests/scenes/scene_folder.h"

namespace halfslope {
namespace {

std::string repeated(const std::string& text, int count) {
  std::string all;
  all.reserve(text.size() * static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

std::string scene(const std::string& line_3) {
  return "<scene version='3.0.0'>\n<sensor type='radiancemeter'/>\n" + line_3 + "\n<shape type='sphere'/>\n</scene>";
}

constexpr rlim_t kMostMemory = rlim_t{256} << 20;

void bound_memory() {
#if !defined(__SANITIZE_ADDRESS__)  // whose shadow is larger than that
  const rlimit bound{kMostMemory, kMostMemory};
  if (::setrlimit(RLIMIT_AS, &bound) != 0) std::perror("setrlimit");
#endif
}

/// The exit code that the command line would end with, the error said on stderr; 101 for more than a second.
int load_in_bounds(const std::filesystem::path& file) {
  bound_memory();
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t start_of_work = std::clock();
  int code = 0;
  try {
    load_scene(file);
  } catch (const Error& error) {
    std::fprintf(stderr, "%.2000s\n", error.what());
    code = static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 100;
  }
#if !defined(__SANITIZE_ADDRESS__)
  // Of the processor, since the machine may have other work.
  const bool slow = std::clock() - start_of_work > CLOCKS_PER_SEC;
  if (slow || std::chrono::steady_clock::now() - start > std::chrono::seconds(10)) code = 101;
#endif
  return code;
}

[[noreturn]] void end_with_loading(const std::string& text) {
  int code = 0;
  {
    const SceneFolder folder;
    code = load_in_bounds(folder.write("wrong.xml", text));
  }
  ::_exit(code);
}

struct Hostile {
  const char* name;
  std::function<std::string()> text;
  const char* message;  ///< an extended regular expression
};

void PrintTo(const Hostile& hostile, std::ostream* out) { *out << hostile.name; }

class LoaderHostile : public testing::TestWithParam<Hostile> {};

TEST_P(LoaderHostile, EndsWithAnErrorInTimeAndMemory) {
  // A process of its own, whose memory is not that of the tests before it.
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(end_with_loading(GetParam().text()), testing::ExitedWithCode(3), GetParam().message);
}

const std::vector<Hostile> kHostile = {
    {"EntityExpansion",
     [] {
       std::string entities = "<!ENTITY l0 \"lol\">\n";
       for (int i = 1; i < 10; ++i) {
         entities += fmt::format("<!ENTITY l{} \"{}\">\n", i, repeated(fmt::format("&l{};", i - 1), 10));
       }
       return "<!DOCTYPE scene [\n" + entities + "]>\n" + scene("<default name='a' value='&l9;'/>");
     },
     "wrong.xml:1: a DOCTYPE with definitions or from elsewhere, allowed: none"},
    {"ExternalEntity", [] { return "<!DOCTYPE scene SYSTEM \"/etc/passwd\">" + scene(""); },
     "wrong.xml:1: a DOCTYPE with definitions or from elsewhere, allowed: none"},
    {"UndefinedEntity", [] { return scene("<shape type='sphere'><float name='radius' value='&l9;'/></shape>"); },
     "wrong.xml:3: attribute 'value' of <float> is '&l9;', allowed: 1 finite number"},
    {"Depth200000", [] { return scene(repeated("<a>", 200'000) + repeated("</a>", 200'000)); },
     "wrong.xml:3: elements are nested more than 64 deep"},
    {"DepthOfAMillion", [] { return scene(repeated("<a>", 1'000'000) + repeated("</a>", 1'000'000)); },
     "wrong.xml:3: more than 1000000 elements and attributes"},
    {"UnclosedMillion", [] { return "<scene version='3.0.0'>\n" + repeated("<a>", 900'000); },
     "wrong.xml:2:2700000: malformed XML"},
    {"ElementsNearTheBound", [] { return scene(repeated("<a/>", 990'000)); },
     "wrong.xml:3: unknown element in <scene>"},
    {"ShapesNearTheBound", [] { return scene(repeated("<shape type='spere'/>", 400'000)); },
     "wrong.xml:3: unknown shape 'spere'"},
    {"AttributesNearTheBound", [] { return scene("<shape type='sphere' " + repeated("a='1' ", 990'000) + "/>"); },
     "wrong.xml:3: unknown attribute of <shape> 'a'"},
    {"PropertiesNearTheBound",
     [] {
       std::string all;
       for (int i = 0; i < 300'000; ++i) all += "<float name='p" + std::to_string(i) + "' value='1'/>";
       return scene("<shape type='sphere'>" + all + "</shape>");
     },
     "wrong.xml:3: unknown property of shape 'sphere' 'p0'"},
    {"IdsNearTheBound",
     [] {
       std::string all;
       for (int i = 0; i < 200'000; ++i) all += "<bsdf id='material" + std::to_string(i) + "' type='diffuse'/>";
       return scene(all + "<shape type='sphere'><ref id='materal'/></shape>");
     },
     "wrong.xml:3: unknown bsdf id 'materal', allowed: material0, .* and [0-9]+ more"},
    {"Doublings",
     [] {
       std::string all = "<default name='a0' value='xxxxxxxx'/>\n";
       for (int i = 1; i <= 40; ++i)
         all +=
             fmt::format("<default name='a{0}_' value='$a{1}$a{1}'/>\n", i, i == 1 ? "0" : std::to_string(i - 1) + "_");
       return scene(all);
     },
     "wrong.xml:2[0-9]: what the parameters of the scene stand for is longer than 4 MiB"},
    {"LongNames",
     [] {
       std::string all;
       for (int i = 1; i <= 255; ++i)
         all += "<default name='" + std::string(static_cast<std::size_t>(i), 'a') + "' value=''/>";
       return scene(all + "<default name='end' value='" + repeated("$aaaa", 200'000) + "$ab$unknown'/>");
     },
     "wrong.xml:3: unknown parameter .\\$unknown', allowed: "},
    {"LongNumber",
     [] {
       return scene("<shape type='sphere'><float name='radius' value='" + std::string(5'000'000, '9') + "'/></shape>");
     },
     "wrong.xml:3: attribute 'value' of <float> is '9+', allowed: 1 finite number"},
    {"LongType", [] { return scene("<shape type='" + std::string(5'000'000, 's') + "'/>"); },
     "wrong.xml:3: unknown shape 's+', allowed: "},
    {"LargeFile", [] { return scene("<!--" + std::string(30'000'000, 'x') + "-->"); },
     "wrong.xml:1: the scene's files are larger than 24 MiB together"},
    {"DeviceAsMesh", [] { return scene("<shape type='ply'><string name='filename' value='/dev/zero.ply'/></shape>"); },
     "wrong.xml:3: there is no file '/dev/zero.ply'"},
    {"DeviceAsInclude", [] { return scene("<include filename='/dev/zero'/>"); },
     "wrong.xml:3: '/dev/zero' is no regular file, allowed: a file"},
    {"LongFileName", [] { return scene("<include filename='" + std::string(1'000'000, 'x') + "'/>"); },
     "wrong.xml:3: the name of a file has 1000000 letters, allowed: 1 to 4095"},
};
INSTANTIATE_TEST_SUITE_P(Files, LoaderHostile, testing::ValuesIn(kHostile),
                         [](const auto& hostile) { return hostile.param.name; });

}  // namespace
}  // namespace halfslope
