// The layout of a d-dimensional integrand.
#pragma once

#include <cstddef>

#include "core/layout.h"

namespace halfslope {

/// Pairs of dimensions, and a single one at the end where `dims` is odd.
inline Layout pairs(int dims) {
  Layout layout;
  layout.groups.assign(static_cast<std::size_t>(dims) / 2, 2);
  if (dims % 2 == 1) layout.groups.push_back(1);
  return layout;
}

}  // namespace halfslope
