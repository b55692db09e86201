// What a programmer's error does: it stops the program and prints what was found and what was promised.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace halfslope {

/// Aborts with the place, `what` and both values unless `found == promised`. On in every build type: a wrong call must
/// never become a number in a table. For a caller's mistakes only; what a user can cause is an Error (core/error.h).
template <class Found, class Promised>
void assert_equal(const Found& found, const Promised& promised, std::string_view what,
                  const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (found == promised) return;
  fmt::print(stderr, "{}:{}: assertion failed: {}: found {}, promised {}\n", file, line, what, found, promised);
  std::abort();
}

}  // namespace halfslope
