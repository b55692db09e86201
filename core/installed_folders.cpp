#include "core/installed_folders.h"

#include <cstdlib>

namespace halfslope {

std::vector<std::filesystem::path> installed_folders(const char* variable, const std::filesystem::path& beside,
                                                     const std::vector<std::filesystem::path>& within,
                                                     const std::filesystem::path& installed) {
  std::vector<std::filesystem::path> folders;
  if (const char* asked = std::getenv(variable); asked && *asked) folders.emplace_back(asked);
  std::error_code ignored;
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", ignored);
  if (!executable.empty()) {
    const auto folder = executable.parent_path();
    folders.push_back(folder / beside);
    for (const auto& place : within) folders.push_back(folder.parent_path() / place);
  }
  folders.push_back(installed);
  return folders;
}

}  // namespace halfslope
