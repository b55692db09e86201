// Ctrl-C and `kill`: finish the units at hand, keep what is done, and leave with exit code 130.
#pragma once

#include <csignal>

namespace halfslope {

/// While one lives, SIGINT and SIGTERM only set the flag that interrupted() reads; a second signal ends the process at
/// once with exit code 130. A file that grows past its limit is an error of the write, not a signal (SIGXFSZ). The
/// destructor restores what was before. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard();

 private:
  struct sigaction old_interrupt_, old_terminate_, old_file_size_;
};

/// Whether a signal came while the InterruptGuard lives; false where there is none.
bool interrupted();

}  // namespace halfslope
