// Whole files: written so that a reader sees the old one or the new one, never a part; and read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace halfslope {

/// A file in the making: bytes go to a temporary in the same folder (".halfslope-PID-K.tmp"), which commit() syncs and
/// renames over `path`, and then the folder is synced. The folder must exist. An existing file is replaced; a folder,
/// device or pipe is refused. Without commit(), `path` is as it was and the temporary is gone.
///
/// All functions throw Error(kIo) with the path and the system's reason if a step fails; `path` is then as it was (only
/// a failed sync of the folder leaves the new file in place). A process killed outright leaves its temporary behind.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail_with_errno() const;

  std::filesystem::path path_, folder_;
  std::string temporary_;  ///< empty once renamed
  int descriptor_ = -1;
};

/// Makes `path` a file with exactly `bytes`, by an AtomicFile.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// The content of a file. Throws Error(kBadInput) if there is none or it is a folder, Error(kIo) if it cannot be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace halfslope
