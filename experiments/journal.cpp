#include "experiments/journal.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/assertion.h"
#include "core/error.h"
#include "core/hash64.h"
#include "experiments/journal_header.h"

namespace halfslope {
namespace {

constexpr std::uint32_t kRecordMagic = 0x52534C48;  // "HLSR" as bytes on disk
constexpr std::size_t kLargestPreamble = 4096;

struct RecordHead {
  std::uint32_t magic = kRecordMagic, reserved = 0;
  std::uint64_t unit = 0, length = 0, checksum = 0;
};
static_assert(sizeof(RecordHead) == 32, "the head lies on disk as it lies in memory");

std::uint64_t seed_of(const RecordHead& head) {
  return hash64(std::as_bytes(std::span(&head, 1)).first(offsetof(RecordHead, checksum)));
}

std::uint64_t file_size(int fd, const std::filesystem::path& path) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) fail(ExitCode::kIo, "{}: {}", path.string(), std::strerror(errno));
  return static_cast<std::uint64_t>(status.st_size);
}

void cut(int fd, std::uint64_t size, const std::filesystem::path& path) {
  if (::ftruncate(fd, static_cast<off_t>(size)) != 0)
    fail(ExitCode::kIo, "{}: cannot be cut to {} bytes: {}", path.string(), size, std::strerror(errno));
}

void sync_file(int fd, const std::filesystem::path& path) {
  // EINVAL: a file system that has nothing to sync.
  if (::fdatasync(fd) != 0 && errno != EINVAL)
    fail(ExitCode::kIo, "{}: cannot be brought to the disk: {}", path.string(), std::strerror(errno));
}

void sync_folder(const std::filesystem::path& folder) {
  const FileDescriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.get() >= 0) ::fsync(descriptor.get());  // best effort: without it a power cut may lose the new name
}

// In pieces, so that a damaged length cannot make us ask for its memory.
std::uint64_t checksum_on_disk(int fd, const RecordHead& head, std::uint64_t offset,
                               const std::filesystem::path& path) {
  Hash64 hash(seed_of(head));
  std::vector<std::byte> piece(std::min<std::uint64_t>(head.length, 1 << 18));
  for (std::uint64_t done = 0; done < head.length; done += piece.size()) {
    piece.resize(std::min<std::uint64_t>(piece.size(), head.length - done));
    read_exactly(fd, piece, offset + done, path);
    hash.update(piece);
  }
  return hash.digest();
}

}  // namespace

Journal::Journal(const std::filesystem::path& folder, const JournalHeader& header, bool overwrite)
    : path_(folder / "journal"), file_(open_for_update(path_)), last_sync_(std::chrono::steady_clock::now()) {
  const std::string preamble = journal_preamble(header);
  std::string beginning(std::min<std::uint64_t>(file_size(file_.get(), path_), kLargestPreamble), '\0');
  read_exactly(file_.get(), std::as_writable_bytes(std::span(beginning)), 0, path_);
  const JournalStart found = read_journal_start(beginning);
  if (overwrite || found.kind == JournalStart::Kind::kUnborn) {
    start(preamble);
    return;
  }
  if (found.kind == JournalStart::Kind::kForeign)
    fail(ExitCode::kBadInput,
         "{}: not a journal that halfslope {} can read; start afresh with --overwrite, or --out another folder",
         path_.string(), header.version);
  const std::string difference = header_difference(found.header, header);
  if (!difference.empty())
    fail(ExitCode::kBadInput,
         "{} holds the results of another run; different: {}; start afresh with --overwrite, or --out another folder",
         folder.string(), difference);
  end_ = found.length;
  scan();
}

Journal::~Journal() { ::fdatasync(file_.get()); }

void Journal::start(const std::string& preamble) {
  cut(file_.get(), 0, path_);
  write_exactly(file_.get(), std::as_bytes(std::span(preamble)), 0, path_);
  sync_file(file_.get(), path_);
  sync_folder(path_.parent_path());
  end_ = preamble.size();
}

void Journal::scan() {
  const std::uint64_t size = file_size(file_.get(), path_);
  while (size - end_ >= sizeof(RecordHead)) {
    RecordHead head;
    read_exactly(file_.get(), std::as_writable_bytes(std::span(&head, 1)), end_, path_);
    const std::uint64_t payload = end_ + sizeof head;
    if (head.magic != kRecordMagic || head.length > size - payload) break;
    if (checksum_on_disk(file_.get(), head, payload, path_) != head.checksum) break;
    index_.try_emplace(head.unit, Extent{payload, head.length});
    end_ = payload + head.length;
  }
  dropped_bytes_ = size - end_;
  if (dropped_bytes_ > 0) cut(file_.get(), end_, path_);
}

bool Journal::has(std::uint64_t unit) const {
  const std::lock_guard lock(mutex_);
  return index_.contains(unit);
}

std::size_t Journal::size() const {
  const std::lock_guard lock(mutex_);
  return index_.size();
}

void Journal::append(std::uint64_t unit, std::span<const std::byte> payload) {
  RecordHead head;
  head.unit = unit;
  head.length = payload.size();
  head.checksum = hash64(payload, seed_of(head));
  bool due = false;
  {
    const std::lock_guard lock(mutex_);
    if (index_.contains(unit)) return;
    try {
      write_exactly(file_.get(), std::as_bytes(std::span(&head, 1)), end_, path_);
      write_exactly(file_.get(), payload, end_ + sizeof head, path_);
    } catch (const Error&) {
      // Half a record would be cut on the next opening anyway; the first error is the one to report.
      [[maybe_unused]] const int ignored = ::ftruncate(file_.get(), static_cast<off_t>(end_));
      throw;
    }
    index_.emplace(unit, Extent{end_ + sizeof head, payload.size()});
    end_ += sizeof head + payload.size();
    const auto now = std::chrono::steady_clock::now();
    due = now - last_sync_ >= std::chrono::seconds(1);
    if (due) last_sync_ = now;
  }
  if (due) sync_file(file_.get(), path_);  // outside the lock: other threads go on appending
}

Journal::Extent Journal::find(std::uint64_t unit) const {
  const std::lock_guard lock(mutex_);
  const auto found = index_.find(unit);
  assert_equal(found != index_.end(), true, fmt::format("unit {} is in {}", unit, path_.string()));
  return found->second;
}

std::vector<std::byte> Journal::read(std::uint64_t unit) const { return read(unit, 0, find(unit).length); }

std::vector<std::byte> Journal::read(std::uint64_t unit, std::uint64_t offset, std::uint64_t size) const {
  const Extent extent = find(unit);
  const bool within = offset <= extent.length && size <= extent.length - offset;
  assert_equal(within, true, fmt::format("bytes {} + {} lie in unit {} of {}", offset, size, unit, extent.length));
  std::vector<std::byte> bytes(size);
  read_exactly(file_.get(), bytes, extent.offset + offset, path_);
  return bytes;
}

void Journal::sync() { sync_file(file_.get(), path_); }

}  // namespace halfslope
