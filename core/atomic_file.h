// Whole files: written so that a reader sees the old one or the new one, never a part; and read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace halfslope {

/// Makes `path` a file with exactly `bytes`: they go to a temporary in the same folder (".halfslope-PID-K.tmp"), which
/// is synced and renamed over `path`, and the folder is synced. The folder must exist. An existing file is replaced; a
/// folder, device or pipe is refused.
///
/// Throws Error(kIo) with the path and the system's reason if any step fails; `path` is then as it was (only a failed
/// sync of the folder leaves the new file in place) and the temporary is gone. A process killed outright leaves its
/// temporary behind.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// The content of a file. Throws Error(kBadInput) if there is none or it is a folder, Error(kIo) if it cannot be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace halfslope
