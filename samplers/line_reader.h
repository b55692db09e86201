// Lines of a file in bounded memory.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halfslope {

/// Reads a file, or what else can be opened like one, a line at a time. Errors: kBadInput if there is none or it is a
/// folder, or for a line of more than `longest` bytes, found out without reading on; kIo if it cannot be read.
class LineReader {
 public:
  LineReader(const std::filesystem::path& path, std::size_t longest);
  /// The next line without its end, LF or CRLF; null after the last. Valid until the next call.
  std::optional<std::string_view> next();
  /// The number of the last line, from 1.
  std::uint64_t line() const { return line_; }
  /// Bytes of the lines so far.
  std::uint64_t bytes() const { return bytes_; }
  /// "FILE:LINE", of the last line.
  std::string place() const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail_with_errno(int error) const;
  [[noreturn]] void fail_for_length() const;
  void read_more();

  std::string name_;
  std::size_t longest_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< the bytes of the buffer that are still to come
  bool at_end_ = false;
  std::uint64_t line_ = 0, bytes_ = 0;
};

}  // namespace halfslope
