#include "experiments/file_descriptor.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace halfslope {

FileDescriptor open_for_update(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd < 0) fail(ExitCode::kIo, "{}: cannot be opened for writing: {}", path.string(), std::strerror(errno));
  return FileDescriptor(fd);
}

void read_exactly(int fd, std::span<std::byte> bytes, std::uint64_t offset, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t done = ::pread(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(ExitCode::kIo, "{}: cannot be read at byte {}: {}", path.string(), offset, std::strerror(errno));
    if (done == 0) fail(ExitCode::kIo, "{}: ends at byte {}; was it cut by another program?", path.string(), offset);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
    offset += static_cast<std::uint64_t>(done);
  }
}

void write_exactly(int fd, std::span<const std::byte> bytes, std::uint64_t offset, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t done = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0)
      fail(ExitCode::kIo, "{}: cannot be written at byte {}: {}", path.string(), offset, std::strerror(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(done));
    offset += static_cast<std::uint64_t>(done);
  }
}

}  // namespace halfslope
