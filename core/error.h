// The one exception type for expected failure, and the exit codes that scripts depend on.
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace halfslope {

enum class ExitCode : int {
  kDone = 0,
  kCheckFailed = 1,  ///< a check or gate failed, or a run has invalid cells
  kUsage = 2,        ///< the command line is wrong
  kBadInput = 3,     ///< an experiment, scene, point file or image is wrong, or nothing was measured
  kIo = 4,           ///< a file could not be read or written
  kInterrupted = 130,
};

/// Expected failure. The message says where, what was found, what is allowed, and what to do.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

template <class... Args>
[[noreturn]] void fail(ExitCode code, fmt::format_string<Args...> format, Args&&... args) {
  throw Error(code, fmt::format(format, std::forward<Args>(args)...));
}

/// The candidate nearest to `name` by optimal string alignment distance, or empty if none is near enough to be a typing
/// error (more than a third of the longer name's letters differ).
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "; did you mean 'x'?" or the empty string: the tail of an error about an unknown name.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace halfslope
