// What a run leaves behind that must be the same bytes every time.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "core/atomic_file.h"

namespace halfslope {

/// Every .csv and .exr of a run folder, by its path in it.
inline std::map<std::string, std::string> run_files(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".csv" || extension == ".exr")
      files[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
  }
  return files;
}

/// Says which files differ, without their bytes.
inline void expect_same_files(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b,
                              const std::string& what) {
  EXPECT_EQ(a.size(), b.size()) << what;
  for (const auto& [name, bytes] : a) {
    const auto found = b.find(name);
    EXPECT_TRUE(found != b.end() && found->second == bytes) << what << ": " << name << " is not the same";
  }
}

}  // namespace halfslope
