// The journal of a run: every finished unit of work, so that an interrupted run continues where it stopped.
//
// One append-only file. It begins with two lines, the magic "halfslope journal 3" and the header as JSON, and goes on
// with records, numbers little-endian:
//   u32 magic, u32 reserved = 0, u64 unit, u64 length, u64 checksum, then `length` bytes of payload.
// The checksum is XXH64 of the payload, seeded by the XXH64 of the 24 bytes before the checksum, so it vouches for
// both.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "experiments/file_descriptor.h"

namespace halfslope {

/// What the payloads are a function of. Records of one header never mix with those of another.
struct JournalHeader {
  std::string spec_hash;  ///< of the spec and of what else determines the units
  std::string version;    ///< of halfslope
  std::string isa_class;  ///< kernels of one class give the same bits
};

/// Payloads stay on disk; memory holds an index of 16 bytes and a key a unit. All functions but the constructor may be
/// called from several threads.
class Journal {
 public:
  /// Opens or makes `folder`/journal, whose folder the caller has locked. Records are read up to the first that is torn
  /// or whose checksum fails; the file is cut there, and those units are to be done again. Error(kBadInput) if the
  /// header is another's, saying what differs, unless `overwrite`, which empties the journal in any case. Error(kIo).
  Journal(const std::filesystem::path& folder, const JournalHeader& header, bool overwrite);
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  bool has(std::uint64_t unit) const;

  /// Appends a finished unit; a second one of the same number is ignored. Error(kIo) if it cannot be written whole, and
  /// then the file is as before. At most about a second of work is lost to a power cut; none to a killed process.
  void append(std::uint64_t unit, std::span<const std::byte> payload);

  /// The payload, or `size` bytes of it from `offset`. The unit must be there and the slice within it.
  std::vector<std::byte> read(std::uint64_t unit) const;
  std::vector<std::byte> read(std::uint64_t unit, std::uint64_t offset, std::uint64_t size) const;

  /// The number of units.
  std::size_t size() const;

  /// Waits until everything appended is on the disk. Error(kIo).
  void sync();

  /// Bytes that were cut off on opening because they were torn or damaged.
  std::uint64_t dropped_bytes() const { return dropped_bytes_; }

 private:
  struct Extent {
    std::uint64_t offset, length;
  };

  void start(const std::string& header);
  void scan();
  Extent find(std::uint64_t unit) const;

  std::filesystem::path path_;
  FileDescriptor file_;
  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, Extent> index_;
  std::uint64_t end_ = 0;  ///< where the next record goes
  std::uint64_t dropped_bytes_ = 0;
  std::chrono::steady_clock::time_point last_sync_;
};

}  // namespace halfslope
