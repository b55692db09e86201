#include "core/kernel_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/error.h"

namespace halfslope {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// HALFSLOPE_ISA for one test, put back after it.
class KernelLibrary : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* before = std::getenv("HALFSLOPE_ISA")) before_ = before;
  }
  void TearDown() override {
    before_.empty() ? unsetenv("HALFSLOPE_ISA") : setenv("HALFSLOPE_ISA", before_.c_str(), 1);
  }

 private:
  std::string before_;
};

TEST_F(KernelLibrary, UnknownIsaIsAUsageErrorThatNamesWhatIsAllowed) {
  for (const char* name : {"avx1024", "AVX2", "avx51", " ", "best"}) {
    setenv("HALFSLOPE_ISA", name, 1);
    try {
      active_isa();
      ADD_FAILURE() << name << " was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kUsage);
      EXPECT_THAT(error.what(), AllOf(HasSubstr(name), HasSubstr("scalar"), HasSubstr("baseline"), HasSubstr("avx2"),
                                      HasSubstr("avx512")));
    }
  }
  setenv("HALFSLOPE_ISA", "avx51", 1);
  EXPECT_THAT([] { active_isa(); }, testing::ThrowsMessage<Error>(HasSubstr("did you mean 'avx512'?")));
}

TEST_F(KernelLibrary, AsksForAnIsaByNameAndElseTakesTheBest) {
  const std::vector<Isa> isas = supported_isas();
  EXPECT_THAT(isas, testing::Contains(Isa::kBaseline));
  for (const Isa isa : isas) {
    setenv("HALFSLOPE_ISA", to_string(isa).c_str(), 1);
    EXPECT_EQ(active_isa(), isa);
  }
  for (const Isa isa : {Isa::kScalar, Isa::kBaseline, Isa::kAvx2, Isa::kAvx512}) {
    if (std::find(isas.begin(), isas.end(), isa) != isas.end()) continue;
    setenv("HALFSLOPE_ISA", to_string(isa).c_str(), 1);
    EXPECT_THROW(active_isa(), Error);
  }
  unsetenv("HALFSLOPE_ISA");
  EXPECT_EQ(active_isa(), isas.back());
  setenv("HALFSLOPE_ISA", "", 1);
  EXPECT_EQ(active_isa(), isas.back());
}

TEST_F(KernelLibrary, ClassesAreThoseWhoseBitsAgree) {
  // packet_test.cpp holds avx2 and avx512 against each other bit for bit; scalar kernels call the C library's exp.
  EXPECT_EQ(isa_class(Isa::kBaseline), "baseline");
  EXPECT_EQ(isa_class(Isa::kAvx2), isa_class(Isa::kAvx512));
  EXPECT_NE(isa_class(Isa::kAvx2), isa_class(Isa::kBaseline));
  EXPECT_NE(isa_class(Isa::kAvx2), isa_class(Isa::kScalar));
}

TEST_F(KernelLibrary, AMissingEntryIsAnErrorThatNamesIt) {
  for (const Isa isa : supported_isas()) {
    try {
      kernel_table(isa, "halfslope_no_such_kernels");
      ADD_FAILURE() << "found in " << to_string(isa);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kIo);
      EXPECT_THAT(error.what(), AllOf(HasSubstr(to_string(isa)), HasSubstr("halfslope_no_such_kernels")));
    }
  }
}

// In a process of its own, where no library is open yet.
TEST(KernelLibraryDeathTest, ABrokenLibraryIsAnErrorThatNamesIt) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto folder = std::filesystem::temp_directory_path() / "halfslope-broken-kernels";
  EXPECT_EXIT(
      {
        std::filesystem::create_directories(folder);
        const auto file = folder / "halfslope-kernels-baseline.so";
        std::ofstream(file) << "not a library";
        setenv("HALFSLOPE_KERNELS", folder.c_str(), 1);
        try {
          kernel_table(Isa::kBaseline, "halfslope_sampler_kernels");
        } catch (const Error& error) {
          std::fprintf(stderr, "%s\n", error.what());
          std::_Exit(static_cast<int>(error.code()));
        }
        std::_Exit(0);
      },
      testing::ExitedWithCode(static_cast<int>(ExitCode::kIo)), "halfslope-kernels-baseline.so: cannot be opened");
  std::filesystem::remove_all(folder);
}

std::set<std::string> exported_symbols(const std::filesystem::path& library) {
  const std::string command = "nm -D --defined-only '" + library.string() + "'";
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  EXPECT_EQ(pclose(pipe), 0) << command;
  std::set<std::string> symbols;
  std::istringstream lines(text);
  for (std::string address, kind, symbol; lines >> address >> kind >> symbol;) symbols.insert(symbol);
  return symbols;
}

TEST(KernelLibraries, ExportTheirEntriesAndNothingElse) {
  // A libstdc++ template that leaked would make the host run this library's copy of it, whatever the processor.
  std::set<std::string> first;
  for (const char* isa : {"scalar", "baseline", "avx2", "avx512"}) {
    const auto library =
        std::filesystem::path(HALFSLOPE_BINARY_DIR) / "kernels" / ("halfslope-kernels-" + std::string(isa) + ".so");
    ASSERT_TRUE(std::filesystem::exists(library)) << library;
    const std::set<std::string> symbols = exported_symbols(library);
    EXPECT_THAT(symbols, testing::Each(testing::MatchesRegex("halfslope_[a-z]+_kernels"))) << library;
    EXPECT_THAT(symbols, testing::Contains("halfslope_sampler_kernels")) << library;
    if (first.empty()) first = symbols;
    EXPECT_EQ(symbols, first) << library;
  }
}

}  // namespace
}  // namespace halfslope
