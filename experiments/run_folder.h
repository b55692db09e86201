// The folder of a run: made if need be, and ours alone while we are at work in it.
#pragma once

#include <filesystem>
#include <string_view>

#include "experiments/file_descriptor.h"

namespace halfslope {

/// Holds an exclusive lock on the folder's file `.lock` until it is destroyed. The kernel drops the lock with the
/// process, however that ends, so a lock never outlives a run.
class RunFolder {
 public:
  /// Makes the folder and its parents, and clears away the unfinished files of a killed run. Error(kIo) if it cannot be
  /// made or written to, or, at once and with nothing changed, if another run is at work in it.
  explicit RunFolder(const std::filesystem::path& folder);

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path path(std::string_view name) const { return folder_ / name; }

  /// Refuses a folder that holds an analysis of images, whose tables a run's would replace. Error(kBadInput).
  void refuse_images() const;
  /// Removes the tables and pictures of an earlier run or analysis, which would pass for the next one's. Nothing else
  /// is touched, and nothing at all where there is neither a journal nor a metrics.csv.
  void remove_results() const;

 private:
  std::filesystem::path folder_;
  FileDescriptor lock_;
};

}  // namespace halfslope
