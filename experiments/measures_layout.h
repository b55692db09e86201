#pragma once

#include "core/layout.h"

namespace halfslope {

/// The points that are measured: one pair of dimensions.
inline const Layout kPair = {{2}};

}  // namespace halfslope
