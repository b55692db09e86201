#include "experiments/interrupt.h"

#include <unistd.h>

#include <atomic>

#include "core/error.h"

namespace halfslope {
namespace {

// A signal handler takes no arguments, so this is the one global.
std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

void on_signal(int) {
  if (signalled.exchange(true)) ::_exit(static_cast<int>(ExitCode::kInterrupted));
}

}  // namespace

InterruptGuard::InterruptGuard() {
  signalled = false;
  struct sigaction action {};
  ::sigemptyset(&action.sa_mask);
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // libraries that write files need not know of us
  ::sigaction(SIGINT, &action, &old_interrupt_);
  ::sigaction(SIGTERM, &action, &old_terminate_);
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGXFSZ, &action, &old_file_size_);
}

InterruptGuard::~InterruptGuard() {
  ::sigaction(SIGINT, &old_interrupt_, nullptr);
  ::sigaction(SIGTERM, &old_terminate_, nullptr);
  ::sigaction(SIGXFSZ, &old_file_size_, nullptr);
  signalled = false;
}

bool interrupted() { return signalled; }

}  // namespace halfslope
