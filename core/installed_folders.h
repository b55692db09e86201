// Where files that come with the program lie.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace halfslope {

/// The folders to look in, best first: the one that the environment's `variable` names; `beside`, in the executable's
/// own folder, as in a build tree; `within` of where the executable's folder is installed (PREFIX/bin), so that an
/// installation can be moved; and `installed`, where it was meant to be. Not all of them exist.
std::vector<std::filesystem::path> installed_folders(const char* variable, const std::filesystem::path& beside,
                                                     const std::vector<std::filesystem::path>& within,
                                                     const std::filesystem::path& installed);

}  // namespace halfslope
