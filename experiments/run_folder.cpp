#include "experiments/run_folder.h"

#include <sys/file.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.h"
#include "experiments/timing_tables.h"

namespace halfslope {
namespace {

// Removes what lies in the folder and anywhere below its images/ and is `unwanted`, as far as the system allows.
template <class Unwanted>
void remove_files(const std::filesystem::path& folder, Unwanted unwanted) {
  std::error_code ignored;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) files.push_back(entry.path());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "images", ignored))
    files.push_back(entry.path());
  for (const auto& file : files) {
    if (std::filesystem::is_regular_file(file, ignored) && unwanted(file)) std::filesystem::remove(file, ignored);
  }
}

// core/atomic_file.h names them so.
bool is_temporary(const std::filesystem::path& file) {
  return file.filename().string().starts_with(".halfslope-") && file.extension() == ".tmp";
}

bool is_table(const std::string& name) {
  constexpr std::array kTables = {"convergence.csv", "replicates.csv", "rates.csv",       "local_rates.csv",
                                  "regions.csv",     "tails.csv",      "comparisons.csv", "discrepancy.csv",
                                  "theory.csv",      "metrics.csv",    "manifest.json"};
  return std::find(kTables.begin(), kTables.end(), name) != kTables.end() ||
         std::find(kTimingFiles.begin(), kTimingFiles.end(), name) != kTimingFiles.end();
}

}  // namespace

RunFolder::RunFolder(const std::filesystem::path& folder) : folder_(folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder)) error = std::make_error_code(std::errc::not_a_directory);
  if (error)
    fail(ExitCode::kIo, "{}: the run folder cannot be made: {}; choose another with --out", folder.string(),
         error.message());
  lock_ = open_for_update(path(".lock"));
  if (::flock(lock_.get(), LOCK_EX | LOCK_NB) == 0) {
    remove_files(folder_, is_temporary);
    return;
  }
  if (errno == EWOULDBLOCK)
    fail(ExitCode::kIo, "another run is at work in {}; wait for it, or choose another folder with --out",
         folder.string());
  fail(ExitCode::kIo, "{}: cannot be locked: {}", path(".lock").string(), std::strerror(errno));
}

void RunFolder::refuse_images() const {
  if (std::filesystem::exists(path("metrics.csv")) && !std::filesystem::exists(path("journal"))) {
    fail(ExitCode::kBadInput, "{}: holds an analysis of images; start afresh with --overwrite, or --out another folder",
         folder_.string());
  }
}

void RunFolder::remove_results() const {
  if (!std::filesystem::exists(path("journal")) && !std::filesystem::exists(path("metrics.csv"))) return;
  remove_files(folder_, [&](const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    if (file.extension() == ".exr") return file.parent_path() != folder_ || name.starts_with("reference");
    return file.parent_path() == folder_ && is_table(name);
  });
}

}  // namespace halfslope
