#include "experiments/run_folder.h"

#include <sys/file.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace halfslope {

RunFolder::RunFolder(const std::filesystem::path& folder) : folder_(folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder)) error = std::make_error_code(std::errc::not_a_directory);
  if (error)
    fail(ExitCode::kIo, "{}: the run folder cannot be made: {}; choose another with --out", folder.string(),
         error.message());
  lock_ = open_for_update(path(".lock"));
  if (::flock(lock_.get(), LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK)
    fail(ExitCode::kIo, "another run is at work in {}; wait for it, or choose another folder with --out",
         folder.string());
  fail(ExitCode::kIo, "{}: cannot be locked: {}", path(".lock").string(), std::strerror(errno));
}

}  // namespace halfslope
