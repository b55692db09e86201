#include "samplers/line_reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/error.h"

namespace halfslope {

LineReader::LineReader(const std::filesystem::path& path, std::size_t longest)
    : name_(path.string()), longest_(longest), file_(std::fopen(path.c_str(), "rb")) {
  if (!file_) fail_with_errno(errno);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail(ExitCode::kBadInput, "{}: is a folder, not a file", name_);
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // the buffer is ours
  buffer_.resize(2 * longest + 2);                // a line, its end, and what is read beyond it
}

std::optional<std::string_view> LineReader::next() {
  std::size_t searched = 0;
  while (true) {
    const char* from = buffer_.data() + begin_;
    const std::size_t held = end_ - begin_;
    const auto* found = static_cast<const char*>(std::memchr(from + searched, '\n', held - searched));
    if (found || at_end_) {
      if (!found && held == 0) return std::nullopt;
      std::string_view line(from, found ? static_cast<std::size_t>(found - from) : held);
      begin_ += std::min(line.size() + 1, held);
      ++line_;
      bytes_ += line.size() + 1;
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.size() > longest_) fail_for_length();
      return line;
    }
    if (held > longest_ + 1) {
      ++line_;
      fail_for_length();
    }
    searched = held;
    read_more();
  }
}

std::string LineReader::place() const { return fmt::format("{}:{}", name_, line_); }

void LineReader::fail_with_errno(int error) const {
  const bool missing = error == ENOENT || error == ENOTDIR || error == ENAMETOOLONG;
  fail(missing ? ExitCode::kBadInput : ExitCode::kIo, "{}: cannot be read: {}", name_,
       std::generic_category().message(error));
}

void LineReader::fail_for_length() const {
  fail(ExitCode::kBadInput, "{}: the line is longer than {} bytes, the most that is allowed; a point takes a line",
       place(), longest_);
}

void LineReader::read_more() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
            buffer_.begin());
  end_ -= begin_;
  begin_ = 0;
  errno = 0;
  const std::size_t got = std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
  if (got < buffer_.size() - end_) {
    if (std::ferror(file_.get())) fail_with_errno(errno);
    at_end_ = true;
  }
  end_ += got;
}

}  // namespace halfslope
