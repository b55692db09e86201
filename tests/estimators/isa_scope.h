// The instruction set of kernels, as long as a scope lasts.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "core/kernel_library.h"

namespace halfslope {

/// HALFSLOPE_ISA set to `isa`, and afterwards back to what it was.
class IsaScope {
 public:
  explicit IsaScope(Isa isa) {
    if (const char* before = std::getenv("HALFSLOPE_ISA")) before_ = before;
    ::setenv("HALFSLOPE_ISA", to_string(isa).c_str(), 1);
  }
  IsaScope(const IsaScope&) = delete;
  IsaScope& operator=(const IsaScope&) = delete;
  ~IsaScope() {
    if (before_) {
      ::setenv("HALFSLOPE_ISA", before_->c_str(), 1);
    } else {
      ::unsetenv("HALFSLOPE_ISA");
    }
  }

 private:
  std::optional<std::string> before_;
};

}  // namespace halfslope
