// A file descriptor that closes itself, and the two system calls that need a loop.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

namespace halfslope {

class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }

  int get() const { return fd_; }

 private:
  int fd_ = -1;
};

/// open(2) for reading and writing, made if absent, closed on exec. Error(kIo) with the system's words.
FileDescriptor open_for_update(const std::filesystem::path& path);

/// Reads exactly bytes.size() bytes at the offset; Error(kIo) naming `path`, also where the file ends before.
void read_exactly(int fd, std::span<std::byte> bytes, std::uint64_t offset, const std::filesystem::path& path);

/// Writes all the bytes at the offset; Error(kIo) naming `path` and the system's reason (disk full, file too large, …).
void write_exactly(int fd, std::span<const std::byte> bytes, std::uint64_t offset, const std::filesystem::path& path);

}  // namespace halfslope
